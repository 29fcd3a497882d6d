// JMP and labels. A label is reached from its own statement list and from everything
// inside; nothing jumps into a block.
#include <algorithm>

#include "frontend/lower/statements.h"
#include "frontend/lower/try_code.h"
#include "frontend/parse/declared_twice.h"
#include "frontend/sema/declarations/variables.h"

namespace frontend {

bool Statements::is_same_row(const Stmt& a, const Stmt& b) const {
  if (!a.span.begin.valid() || !b.span.begin.valid()) return false;
  LineFinder lines(sema_.sources);
  return lines.line_of(a.span.begin) == lines.line_of(b.span.begin);
}

Flow::Labels Statements::labels_of(Range32 list) {
  Flow::Labels labels;
  for (uint32_t i = 0; i < list.count; ++i) {
    const Stmt& stmt = tree_[tree_.stmt_lists[list.first + i]];
    if (stmt.kind != StmtKind::kLabel) continue;
    const Name name = tree_.name(stmt.name);
    // `x : f(y);` is a slip of the finger, and would be a label and a call. A label in a row of its
    // own, as drawings and instruction lists have it, may be called like a variable.
    if (ask<Variables>().find_variable(name).valid() && i + 1 < list.count &&
        is_same_row(stmt, tree_[tree_.stmt_lists[list.first + i + 1]])) {
      error(DiagnosticCode::kDuplicateName, name.span,
            "`" + std::string(name.text) + "` is a variable and cannot be a label",
            "write `:=` to assign to it");
    }
    if (labels.emplace(name.text, build_.new_block()).second) continue;
    for (uint32_t first = 0; first < i; ++first) {
      const Stmt& other = tree_[tree_.stmt_lists[list.first + first]];
      if (other.kind != StmtKind::kLabel ||
          !ir::same_name(tree_.name(other.name).text, name.text)) {
        continue;
      }
      error(DiagnosticCode::kDuplicateName, name.span,
            "the label " +
                declared_twice(sema_.sources, name.text, name.span, tree_.name(other.name).span));
      break;
    }
  }
  return labels;
}

void Statements::label(const Stmt& stmt) {
  ir::BlockId block = body_.flow.labels.back().labels.find(tree_.name(stmt.name).text)->second;
  const std::span<const ir::BlockId> started = build_.blocks();
  if (std::find(started.begin(), started.end(), block) != started.end()) return;  // stands twice
  if (build_.reachable()) build_.jump(block);
  build_.start(block);
}

void Statements::jump(const Stmt& stmt) {
  if (!stmt.instruction) {
    allow_extension("JMP in Structured Text", stmt.span, "use IF, loops, EXIT and RETURN");
  }
  const Name wanted = tree_.name(stmt.name);
  for (size_t i = body_.flow.labels.size(); i-- > 0;) {
    auto found = body_.flow.labels[i].labels.find(wanted.text);
    if (found == body_.flow.labels[i].labels.end()) continue;
    leave_loops();
    return ask<TryCode>().go(found->second, body_.flow.labels[i].tries);
  }
  std::string name = "`" + std::string(wanted.text) + "`";
  for (const Stmt& other : tree_.stmts) {
    bool inside = other.kind == StmtKind::kLabel && info_.decl != nullptr &&
                  !(other.span.begin < info_.decl->span.begin) &&
                  other.span.begin < info_.decl->span.end;
    if (!inside || !ir::same_name(tree_.name(other.name).text, wanted.text)) continue;
    error(DiagnosticCode::kJumpIntoBlock, stmt.span,
          "the label " + name + " lies inside a block that this jump is not in",
          "put the label in front of the block, or the jump inside it");
    return;
  }
  NearestName nearest(wanted.text);
  for (const Flow::LabelList& list : body_.flow.labels) nearest.offer_all(list.labels);
  error(DiagnosticCode::kUnknownLabel, wanted.span, "there is no label " + name, nearest.fix());
}

}  // namespace frontend
