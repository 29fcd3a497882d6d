// Which constants AArch64 instructions have room for.
#pragma once

#include <cstdint>
#include <optional>

namespace vm::native::arm64 {

// ADD, SUB and CMP: 12 bits, or 12 bits times 4096, with either sign.
bool is_sum_immediate(int64_t value);

// AND, ORR, EOR and TST of 4 or 8 bytes: the fields N, immr and imms (13 bits). What repeats in
// 2, 4, ... 64 bits as a run of ones.
std::optional<uint32_t> logical_immediate(uint64_t bits, uint8_t width);

// The same for a constant of `width` bytes that meets values whose upper bits do not matter.
std::optional<uint32_t> logical_immediate_of(uint64_t bits, uint8_t width);

// FMOV: n/16 * 2^r with 16 <= n <= 31 and -3 <= r <= 4, as imm8.
std::optional<uint8_t> float_immediate(uint64_t bits, uint8_t width);

int64_t sign_extended(uint64_t bits, uint8_t width);

}  // namespace vm::native::arm64
