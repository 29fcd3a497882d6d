// Attributes: pragmas that belong to the declaration which they stand before.
#include "frontend/lex/pragma.h"
#include "frontend/parse/parser.h"
#include "ir/types/types.h"

namespace frontend {

// The attributes between the token before and the current one. What the parser has
// passed without asking stands before no declaration and is dropped.
Range32 Parser::take_attributes() {
  Range32 out{static_cast<uint32_t>(tree_.attributes.size()), 0};
  uint32_t after = current_ == first_ ? base_ : last_end().offset;
  const std::vector<base::SourceSpan>& pragmas = list_.pragmas;
  for (; next_pragma_ < pragmas.size(); ++next_pragma_) {
    base::SourceSpan span = pragmas[next_pragma_];
    if (span.begin.offset >= current_->begin) break;
    if (span.begin.offset < after) {
      report_lost_rule(span);
    } else {
      add_attribute(span);
    }
  }
  out.count = static_cast<uint32_t>(tree_.attributes.size()) - out.first;
  return out;
}

// A rule that changes what becomes of values must not be passed over in silence.
void Parser::report_lost_rule(base::SourceSpan span) {
  uint32_t begin = span.begin.offset - base_;
  auto found = read_attribute(text_.substr(begin, span.end.offset - span.begin.offset));
  if (!found) return;
  const bool migrates = ir::same_name(found->name, kMigrationAttribute);
  if (!migrates && !ir::same_name(found->name, kRenamedAttribute)) return;
  diagnostics_.add(
      migrates ? Code::kBadMigration : Code::kBadRename, span,
      "this rule stands before no declaration",
      migrates ? "put it in front of a FUNCTION" : "put it in front of what was renamed");
}

void Parser::report_lost_rules() {
  for (; next_pragma_ < list_.pragmas.size(); ++next_pragma_) {
    report_lost_rule(list_.pragmas[next_pragma_]);
  }
}

void Parser::add_attribute(base::SourceSpan span) {
  uint32_t begin = span.begin.offset - base_;
  auto found = read_attribute(text_.substr(begin, span.end.offset - span.begin.offset));
  if (!found) return;
  auto at = static_cast<uint32_t>(found->name.data() - text_.data()) + base_;
  auto length = static_cast<uint32_t>(found->name.size());
  tree_.attributes.push_back({{found->name, {{at}, {at + length}}},
                              found->has_value,
                              found->value,
                              found->marked,
                              found->from,
                              found->part});
}

// Both lists as one. Beyond the limit only the second: a copy for each of many
// declarations would cost the product of both numbers.
Range32 Parser::join_attributes(Range32 a, Range32 b) {
  static constexpr uint32_t kMostCopied = 64;
  if (a.count == 0 || (b.count != 0 && a.count > kMostCopied)) return b;
  if (b.count == 0) return a;
  Range32 out{static_cast<uint32_t>(tree_.attributes.size()), a.count + b.count};
  for (Range32 part : {a, b}) {
    for (uint32_t i = 0; i < part.count; ++i) {
      Attribute copy = tree_.attributes[part.first + i];
      tree_.attributes.push_back(copy);
    }
  }
  return out;
}

}  // namespace frontend
