#include "frontend/format/branches.h"

#include <optional>
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

uint32_t first_branch_end(const Text& text) {
  uint32_t i = 0;
  while (i < text.token_count() && !ends_branch(text, i)) ++i;
  return i;
}

namespace {

// Brackets of one {IF ...}: how many are open.
struct Branches {
  size_t before = 0;
  std::optional<size_t> behind;  // the first of its branches
  uint32_t last = 0;             // bracket of that
  bool has_else = false;
};

class BracketWalk {
 public:
  explicit BracketWalk(const Text& text) : text_(text) {}

  uint32_t run() {
    for (uint32_t i = 0; i < text_.token_count(); ++i) {
      for_each_pragma(text_, i, [&](std::string_view word) { pragma(word, i); });
      if (found_) return *found_;
      if (is_opening(text_.kind(i))) open_.push_back(i);
      if (is_closing_bracket(text_.kind(i)) && !open_.empty()) open_.pop_back();
    }
    return text_.token_count();
  }

 private:
  void pragma(std::string_view word, uint32_t at) {
    if (ir::same_name(word, "IF")) return branches_.push_back({open_.size(), {}, at, false});
    const bool end = ir::same_name(word, "END_IF");
    if (branches_.empty() || !(end || begins_other_branch(word))) return;
    Branches& row = branches_.back();
    const uint32_t last = open_.empty() ? at : open_.back();
    if (!row.behind) {
      row.behind = open_.size();
      row.last = last;
    }
    row.has_else = row.has_else || ir::same_name(word, "ELSE");
    const bool only_one = end && !row.has_else;  // the other branch is empty
    if (open_.size() != *row.behind) found_ = open_.size() > *row.behind ? last : row.last;
    if (only_one && *row.behind != row.before) found_ = row.last;
    if (end) return branches_.pop_back();
    open_.resize(row.before, at);
  }

  const Text& text_;
  std::vector<uint32_t> open_;
  std::vector<Branches> branches_;
  std::optional<uint32_t> found_;
};

}  // namespace

uint32_t open_in_branch(const Text& text) { return BracketWalk(text).run(); }

}  // namespace frontend::formatting
