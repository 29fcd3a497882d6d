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

namespace {

bool begins_pou(TokenKind kind) {
  return kind == TokenKind::kProgram || kind == TokenKind::kFunction ||
         kind == TokenKind::kFunctionBlock;
}

bool ends_pou(TokenKind kind) {
  return kind == TokenKind::kEndProgram || kind == TokenKind::kEndFunction ||
         kind == TokenKind::kEndFunctionBlock;
}

// Brackets, or POUs, of one {IF ...}: how many are open.
struct Branches {
  size_t before = 0;
  std::optional<size_t> behind;  // the first of its branches
  uint32_t last = 0;             // token of that
  bool has_else = false;
};

class OpenWalk {
 public:
  OpenWalk(const Text& text, Opened what) : text_(text), pous_(what == Opened::kPou) {}

  uint32_t run() {
    for (uint32_t i = 0; i < text_.token_count(); ++i) {
      for_each_pragma(text_, i, [&](std::string_view word) { pragma(word, i); });
      if (found_) return *found_;
      const TokenKind kind = text_.kind(i);
      if (pous_ ? begins_pou(kind) : is_opening(kind)) open_.push_back(i);
      const bool closes = pous_ ? ends_pou(kind) : is_closing_bracket(kind);
      if (closes && !open_.empty()) open_.pop_back();
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
  bool pous_;
  std::vector<uint32_t> open_;
  std::vector<Branches> branches_;
  std::optional<uint32_t> found_;
};

}  // namespace

uint32_t open_in_branch(const Text& text, Opened what) { return OpenWalk(text, what).run(); }

}  // namespace frontend::formatting
