// Assignments of texts and of whole places, as handlers and machine code call them: with the
// parameters of native functions (stdlib/native/natives.h). `to` and `from` are references to
// strings or, of move_bytes, offsets in data memory; they may overlap.
#pragma once

#include <cstdint>

namespace vm {

uint64_t copy_string(uint8_t* memory, uint64_t to, uint64_t from, uint64_t, uint64_t, uint64_t);
uint64_t copy_wstring(uint8_t* memory, uint64_t to, uint64_t from, uint64_t, uint64_t, uint64_t);
uint64_t move_bytes(uint8_t* memory, uint64_t to, uint64_t from, uint64_t count, uint64_t,
                    uint64_t);

}  // namespace vm
