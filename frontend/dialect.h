// The dialects of Structured Text that the compiler knows; the table is dialects.def.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace frontend {

enum class Dialect : uint8_t {
#define DIALECT(id, name, what) id,
#include "frontend/dialects.def"
};

struct DialectRow {
  std::string_view name;  // "codesys"
  std::string_view what;
};
std::span<const DialectRow> dialect_rows();  // by Dialect
std::optional<Dialect> dialect_from_name(std::string_view name);
// "unknown dialect `x`; known are iec, codesys, twincat"
std::string unknown_dialect(std::string_view name);

// What a dialect changes. `iec` and `others`: "" when the example is accepted, otherwise the code
// of its message.
struct DialectRule {
  std::string_view what;
  std::string_view example;  // inside of a function block
  std::string_view iec;
  std::string_view others;
};
std::span<const DialectRule> dialect_rules();

}  // namespace frontend
