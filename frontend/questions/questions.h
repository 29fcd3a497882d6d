// What can be asked of a compilation that is kept: what a name means, where it is declared, who
// uses it, of which type an expression is, how something is called, and what its author says of it.
// The language server and `stc xref` stand on this.
//
// Read-only: no answer changes what the compilation knows, so the next edit is followed as if
// nobody had asked. It answers for sources with mistakes, too, as far as they are understood. One
// Questions is for one state of the sources: make another one after an edit. The first question
// goes through the whole project, others are cheap. docs/adr/0040-questions.md
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/questions/documentation.h"
#include "frontend/questions/symbols.h"

namespace frontend::questions {

struct Parameter {
  std::string name;
  std::string type;
  std::string_view section;  // VAR_INPUT, VAR_OUTPUT, VAR_IN_OUT
};

// How something is declared, for people: `FUNCTION Scale(raw : INT, gain : REAL) : REAL`.
struct Signature {
  std::string text;
  std::vector<Parameter> parameters;  // of what is called
  std::string documentation;
};

struct TypedExpression {
  base::SourceSpan span;
  std::string type;
};

class Questions {
 public:
  // `sema` has looked at all bodies, and keeps its tree (frontend/resident.h).
  explicit Questions(Sema& sema) : sema_(sema) {}

  // The place in a file, lines and columns from 1 (bytes); invalid: there is no such place.
  base::SourcePos place(std::string_view file, uint32_t line, uint32_t column) const;
  base::SourceLocation locate(base::SourcePos pos) const;

  const Symbol* symbol_at(base::SourcePos pos);
  // By its qualified name, without case: `Plant.Pump.level`, `Color#Red`.
  const Symbol* symbol_named(std::string_view name);
  // What shares a bit with an address: variables AT it, and addresses in code.
  std::vector<const Symbol*> symbols_at(const ir::DirectAddress& address);
  // In the order of the files, the declaration too when it is in one of them.
  std::vector<Occurrence> uses_of(const Symbol& symbol);
  // Of the innermost expression there that has a type.
  std::optional<TypedExpression> type_at(base::SourcePos pos);
  Signature signature_of(const Symbol& symbol);
  // What is called around the position; null: nothing is.
  const Symbol* called_at(base::SourcePos pos);
  const Index& index();

 private:
  std::string documentation_of(const Symbol& symbol);
  void describe_call(const PouInfo& info, Signature& out) const;

  Sema& sema_;
  std::optional<Index> index_;
  std::map<uint32_t, Documentation> documented_;  // by file
};

}  // namespace frontend::questions
