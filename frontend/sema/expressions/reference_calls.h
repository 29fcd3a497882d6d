// The calls that make references and ask about them; they know types and places, which no
// function of a library can.
#pragma once

#include <cstdint>
#include <string_view>

namespace frontend {

enum class ReferenceCall : uint8_t {
  kNone,
  kAdr,      // ADR(x): POINTER TO the type of x, good for every pointer
  kRef,      // REF(x): REF_TO the type of x
  kSizeof,   // SIZEOF(x), SIZEOF(Type): bytes
  kIsValid,  // __ISVALIDREF(r): refers to something that is there
  kNew,      // __NEW(T), __NEW(T(arguments)): POINTER TO T, or NULL
  kDelete,   // __DELETE(p)
  kQuery,    // __QUERYINTERFACE(x, i), __QUERYPOINTER(x, p): i ?= x, and whether it fits
};

// Without case.
ReferenceCall reference_call_of_name(std::string_view name);

}  // namespace frontend
