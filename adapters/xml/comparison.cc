#include "adapters/xml/comparison.h"

#include <algorithm>

#include "base/name_case.h"

namespace xml {
namespace {

struct Comparison {
  const char* box;
  const char* sign;
};
constexpr Comparison kComparisons[] = {{"GT", ">"},  {"GE", ">="}, {"EQ", "="},
                                       {"LE", "<="}, {"LT", "<"},  {"NE", "<>"}};

const Comparison* comparison_of(std::string_view box) {
  for (const Comparison& each : kComparisons) {
    if (base::same_name(each.box, box)) return &each;
  }
  return nullptr;
}

}  // namespace

std::string_view comparison_sign(std::string_view box) {
  const Comparison* const how = comparison_of(box);
  return how == nullptr ? std::string_view() : how->sign;
}

std::string comparison_text(std::string_view box, std::span<const std::string> operands) {
  const Comparison* const how = comparison_of(box);
  const bool plain = std::ranges::none_of(operands, [](const std::string& operand) {
    return operand.find_first_of(" (") != operand.npos;
  });
  if (plain && operands.size() == 2) return operands[0] + ' ' + how->sign + ' ' + operands[1];
  std::string out = how->box;
  for (const std::string& operand : operands) {
    out += (&operand == operands.data() ? "(" : ", ") + operand;
  }
  return out + ')';
}

}  // namespace xml
