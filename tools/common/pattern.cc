#include "tools/common/pattern.h"

#include "ir/types/types.h"

namespace tools {
namespace {

template <class Same>
bool matches_characters(std::string_view pattern, std::string_view name, Same same) {
  return matches_parts(
      pattern, name, [](char p) { return p == '*'; },
      [&](char p, char n) { return p == '?' || same(p, n); });
}

}  // namespace

bool matches(std::string_view pattern, std::string_view name) {
  return matches_characters(pattern, name, [](char p, char n) {
    return ir::same_name(std::string_view(&p, 1), std::string_view(&n, 1));
  });
}

bool matches_file(std::string_view pattern, std::string_view name) {
  return matches_characters(pattern, name, [](char p, char n) { return p == n; });
}

}  // namespace tools
