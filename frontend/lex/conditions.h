// Conditional compilation (CODESYS): {IF cond} {ELSIF cond} {ELSE} {END_IF},
// {define NAME ['value']}, {undefine NAME}. One Conditions serves one file from its
// beginning to its end; a define holds from its place on, in its file.
//
//   cond: AND, OR, NOT, parentheses, and
//     defined(NAME)                           a define of the file or of --define
//     defined(variable|type|pou|task|resource: NAME)
//     hasvalue(NAME, 'value')                 the value of a define
//     hastype(variable: NAME, TYPE)           as the declaration spells it
//     hasattribute(variable|type|pou: NAME, 'attribute')
// A declaration counts wherever it stands, also in text that another condition leaves out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/pragma.h"

namespace frontend {

struct ConditionProblem {
  base::DiagnosticCode code;
  std::string text;
  std::string fix;
};

class Conditions {
 public:
  explicit Conditions(const LexOptions& options);

  // Is the text here part of the program?
  bool active() const { return frames_.empty() || frames_.back().active; }
  // Takes note of a pragma; others than those above change nothing.
  std::optional<ConditionProblem> take(std::string_view inside, base::SourceSpan span);
  // The {IF ...} that are still open.
  std::vector<base::SourceSpan> open_spans() const;

 private:
  struct Frame {
    bool outer;  // is the text around it active?
    bool taken;  // was one of its branches active?
    bool active;
    bool has_else;
    base::SourceSpan span;
  };
  void begin_if(PragmaReader& reader, base::SourceSpan span);
  void next_branch(PragmaReader& reader, bool has_condition);
  void define(PragmaReader& reader);
  void undefine(PragmaReader& reader);
  const std::string* value_of(std::string_view name) const;  // of a define, or null

  bool evaluate(PragmaReader& reader);
  bool disjunction(PragmaReader& reader);
  bool conjunction(PragmaReader& reader);
  bool negation(PragmaReader& reader);
  bool query(PragmaReader& reader);
  bool query_defined(PragmaReader& reader);
  bool query_declared(PragmaReader& reader, std::string_view function);
  void expect(PragmaReader& reader, char sign);
  std::string_view take_piece(PragmaReader& reader, const char* what);
  void fail(std::string text);

  const DeclarationIndex* declarations_;
  std::unordered_map<std::string, std::string> defines_;  // by folded name
  std::vector<Frame> frames_;
  uint32_t position_ = 0;  // of the pragma at hand
  uint32_t depth_ = 0;
  std::optional<ConditionProblem> problem_;
};

}  // namespace frontend
