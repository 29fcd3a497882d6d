// Inside of print(): writes the tree as indented text, one node per line, names
// as the sources spell them, no positions.
#pragma once

#include <string>

#include "frontend/parse/tree.h"

namespace frontend {

class Printer {
 public:
  explicit Printer(const Tree& tree) : tree_(tree) {}
  std::string run();

 private:
  // print.cc
  void usings(const Scope& scope);
  void type(const TypeDecl& decl);
  void pou(const PouDecl& decl);
  void block(const VarBlock& block);
  std::string variable(const VarDecl& decl) const;
  void attributes(Range32 of);
  std::string attribute_text(Range32 of) const;
  std::string spec_list(const char* word, const std::vector<SpecId>& specs) const;
  std::string path(Range32 names) const;
  std::string scoped(ScopeId scope, const Name& name) const;
  void config(const ConfigDecl& decl);
  void resource(const ResourceDecl& decl);
  void task(const TaskDecl& decl);
  void program(const ProgramDecl& decl);
  void line(const std::string& text) { out_ += std::string(2 * depth_, ' ') + text + '\n'; }

  // print_chart.cc
  void chart(const Chart& chart);

  // print_statement.cc
  void body(Range32 statements);
  void statement(const Stmt& stmt);
  void branches(const Stmt& stmt);
  void cases(const Stmt& stmt);
  void try_statement(const Stmt& stmt);
  void nested(const std::string& head, Range32 statements);

  // print_expression.cc: everything in parentheses, so that grouping shows
  std::string expression(ExprId id) const;
  std::string literal(const Literal& literal) const;
  std::string arguments(Range32 args) const;
  std::string list(Range32 list) const;
  std::string binary(const Expr& expr) const;
  static const char* assign_text(AssignOp op);  // with blanks around it

  // print_spec.cc
  std::string spec(SpecId id) const;
  std::string enumerators(const Spec& spec) const;
  std::string fields(const Spec& spec) const;
  std::string named(const Spec& spec) const;
  std::string array(const Spec& spec) const;
  std::string address(const ir::DirectAddress& address, Range32 levels,
                      bool incomplete = false) const;

  const Tree& tree_;
  std::string out_;
  size_t depth_ = 0;
};

}  // namespace frontend
