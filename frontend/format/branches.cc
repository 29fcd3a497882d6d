#include "frontend/format/branches.h"

#include <vector>

#include "frontend/format/outliner.h"

namespace frontend::formatting {

bool ends_branch(const Text& text, uint32_t i) {
  bool ends = false;
  for_each_pragma(text, i, [&](std::string_view word) {
    ends = ends || begins_other_branch(word) || ir::same_name(word, "END_IF");
  });
  return ends;
}

uint32_t open_in_branch(const Text& text) {
  std::vector<uint32_t> open;
  std::vector<size_t> outside;  // so many were open at each open {IF ...}
  for (uint32_t i = 0; i < text.token_count(); ++i) {
    bool left = false;
    for_each_pragma(text, i, [&](std::string_view word) {
      const bool end = ir::same_name(word, "END_IF");
      if (ir::same_name(word, "IF")) outside.push_back(open.size());
      if (outside.empty() || !(end || begins_other_branch(word))) return;
      left = left || open.size() > outside.back();
      if (end) outside.pop_back();
    });
    if (left) return open.back();
    if (is_opening(text.kind(i))) open.push_back(i);
    if (is_closing_bracket(text.kind(i)) && !open.empty()) open.pop_back();
  }
  return text.token_count();
}

}  // namespace frontend::formatting
