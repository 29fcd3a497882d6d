#include "frontend/parse/printer.h"

namespace frontend {

void Printer::body(Range32 statements) {
  for (uint32_t i = 0; i < statements.count; ++i) {
    statement(tree_[tree_.stmt_lists[statements.first + i]]);
  }
}

void Printer::nested(const std::string& head, Range32 statements) {
  line(head);
  ++depth_;
  body(statements);
  --depth_;
}

void Printer::statement(const Stmt& stmt) {
  switch (stmt.kind) {
    case StmtKind::kError:
      return line("ERROR");
    case StmtKind::kEmpty:
      return line("EMPTY");
    case StmtKind::kAssign:
      return line(expression(stmt.target) + assign_text(stmt.assign) + expression(stmt.value));
    case StmtKind::kCall:
      return line("CALL " + expression(stmt.value));
    case StmtKind::kIf:
      return branches(stmt);
    case StmtKind::kCase:
      return cases(stmt);
    case StmtKind::kFor: {
      std::string head = "FOR " + expression(stmt.target) + " := " + expression(stmt.from) +
                         " TO " + expression(stmt.to);
      if (stmt.by.valid()) head += " BY " + expression(stmt.by);
      return nested(head, stmt.body);
    }
    case StmtKind::kWhile:
      return nested("WHILE " + expression(stmt.value), stmt.body);
    case StmtKind::kRepeat:
      nested("REPEAT", stmt.body);
      return line("UNTIL " + expression(stmt.value));
    case StmtKind::kExit:
      return line("EXIT");
    case StmtKind::kContinue:
      return line("CONTINUE");
    case StmtKind::kReturn:
      return line("RETURN");
    case StmtKind::kJump:
      return line("JMP " + std::string(tree_.name(stmt.name).text));
    case StmtKind::kLabel:
      return line("LABEL " + std::string(tree_.name(stmt.name).text));
    case StmtKind::kTry:
      return try_statement(stmt);
    case StmtKind::kMock:
      return line("MOCK " + expression(stmt.target));
    case StmtKind::kMockFunction: {
      std::string text = "MOCK_FUNCTION " + expression(stmt.target);
      return line(stmt.value.valid() ? text + " RETURNS " + expression(stmt.value) : text);
    }
  }
}

void Printer::try_statement(const Stmt& stmt) {
  nested("TRY", stmt.body);
  if (stmt.has_catch) {
    std::string variable = expression(stmt.target);
    nested(variable.empty() ? "CATCH" : "CATCH " + variable, tree_.branches[stmt.arms.first].body);
  }
  if (stmt.has_finally) nested("FINALLY", tree_.branches[stmt.arms.first + 1].body);
}

void Printer::branches(const Stmt& stmt) {
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    const Branch& branch = tree_.branches[stmt.arms.first + i];
    nested((i == 0 ? "IF " : "ELSIF ") + expression(branch.condition), branch.body);
  }
  if (stmt.has_else) nested("ELSE", stmt.else_body);
}

void Printer::cases(const Stmt& stmt) {
  line("CASE " + expression(stmt.value));
  ++depth_;
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    const CaseArm& arm = tree_.cases[stmt.arms.first + i];
    std::string head;
    for (uint32_t j = 0; j < arm.labels.count; ++j) {
      const CaseLabel& label = tree_.labels[arm.labels.first + j];
      head += (head.empty() ? "" : ", ") + expression(label.low);
      if (label.high.valid()) head += ".." + expression(label.high);
    }
    nested(head + ':', arm.body);
  }
  if (stmt.has_else) nested("ELSE", stmt.else_body);
  --depth_;
}

}  // namespace frontend
