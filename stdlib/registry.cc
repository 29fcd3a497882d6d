#include "stdlib/registry.h"

#include <algorithm>
#include <array>

#include "base/name_case.h"

namespace stdlib {

std::string_view operand_type(const FunctionRow& row, uint32_t number) {
  std::string_view rest = row.signature.substr(0, row.signature.find_first_of("=-") - 1);
  for (; number != 0 && !rest.empty(); --number) {
    const size_t comma = rest.find(", ");
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 2);
  }
  return rest.substr(0, rest.find(", "));
}

std::string_view result_type(const FunctionRow& row) {
  const size_t arrow = row.signature.find("-> ");
  return arrow == std::string_view::npos ? std::string_view() : row.signature.substr(arrow + 3);
}

std::span<const AliasRow> alias_rows() {
#define ALIAS(block, name, parameter) AliasRow{block, name, parameter},
  static constexpr AliasRow kRows[] = {
#include "stdlib/registry.def"
  };
  return kRows;
}

std::string_view other_name(std::string_view function, std::string_view name) {
  struct Row {
    std::string_view function, name, parameter;
  };
#define OTHER_NAME(function, name, parameter) {function, name, parameter},
  static constexpr Row kRows[] = {
#include "stdlib/registry.def"
  };
  for (const Row& row : kRows) {
    if (row.function == function && base::same_name(row.name, name)) return row.parameter;
  }
  return {};
}

std::string parameter_at(std::string_view function, uint32_t position) {
  const auto rows = function_rows();
  const auto row = std::ranges::find_if(
      rows, [&](const FunctionRow& each) { return base::same_name(each.name, function); });
  if (row == rows.end()) {
    const bool converts = base::fold_name(function).find("to_") != std::string::npos;
    return converts && position == 0 ? "IN" : "";
  }
  std::string_view words = row->parameters;
  for (uint32_t at = 0; !words.empty(); ++at) {
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(std::min(words.size(), word.size() + 1));
    if (word.back() == '+') {  // "IN1+": IN1, IN2, ...
      const auto first = static_cast<uint32_t>(word[word.size() - 2] - '0');
      return std::string(word.substr(0, word.size() - 2)) + std::to_string(first + position - at);
    }
    if (at == position) return std::string(word);
  }
  return {};
}

bool is_vendor_library(std::string_view name) {
#define VENDOR(name, meaning) name,
  static constexpr std::string_view kNames[] = {
#include "stdlib/registry.def"
  };
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [name](std::string_view one) { return base::same_name(one, name); });
}

std::span<const PageRow> page_rows() {
#define SECTION(title) PageRow{title, "", ""},
#define FUNCTION(id, name, rule, fewest, most, parameters, signature, meaning) \
  PageRow{name, signature, meaning},
#define CONVERSION(form, signature, meaning) PageRow{form, signature, meaning},
#define LIBRARY(name, interface, meaning) LIBRARY_OF(kAll, name, interface, meaning)
#define LIBRARY_OF(dialects, name, interface, meaning) \
  PageRow{name, interface, meaning, true, LibraryDialects::dialects},
#define VENDOR(name, meaning) PageRow{name, "all of it", meaning},
  static constexpr PageRow kRows[] = {
#include "stdlib/registry.def"
  };
  return kRows;
}

}  // namespace stdlib
