#include "frontend/dialect.h"

namespace frontend {

namespace {

constexpr DialectRow kDialects[] = {
#define DIALECT(id, name, what) {name, what},
#include "frontend/dialects.def"
};

constexpr DialectRule kRules[] = {
#define DIALECT_RULE(what, example, iec, others) {what, example, iec, others},
#include "frontend/dialects.def"
};

}  // namespace

std::span<const DialectRow> dialect_rows() { return kDialects; }
std::span<const DialectRule> dialect_rules() { return kRules; }

std::optional<Dialect> dialect_from_name(std::string_view name) {
  for (uint8_t i = 0; i < std::size(kDialects); ++i) {
    if (kDialects[i].name == name) return static_cast<Dialect>(i);
  }
  return std::nullopt;
}

std::string unknown_dialect(std::string_view name) {
  std::string text = "unknown dialect `" + std::string(name) + "`; known are ";
  for (const DialectRow& row : kDialects) {
    if (&row != kDialects) text += ", ";
    text += row.name;
  }
  return text;
}

}  // namespace frontend
