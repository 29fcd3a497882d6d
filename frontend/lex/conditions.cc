#include "frontend/lex/conditions.h"

#include <algorithm>

#include "base/diagnostics_render.h"
#include "base/limits.h"
#include "frontend/lex/declaration_index.h"
#include "ir/types/types.h"

namespace frontend {

using base::DiagnosticCode;

Conditions::Conditions(const LexOptions& options) : declarations_(options.declarations) {
  for (const std::string& text : options.defines) {
    size_t equals = std::min(text.find('='), text.size());
    defines_[ir::fold_name(text.substr(0, equals))] =
        text.substr(std::min(equals + 1, text.size()));
  }
}

std::optional<ConditionProblem> Conditions::take(std::string_view inside, base::SourceSpan span) {
  problem_.reset();
  position_ = span.begin.offset;
  PragmaReader reader(inside);
  if (reader.accept_word("IF")) {
    begin_if(reader, span);
  } else if (reader.accept_word("ELSIF")) {
    next_branch(reader, true);
  } else if (reader.accept_word("ELSE")) {
    next_branch(reader, false);
  } else if (reader.accept_word("END_IF")) {
    if (frames_.empty()) {
      fail("{END_IF} stands here, but no {IF ...} is open");
    } else {
      frames_.pop_back();
    }
  } else if (active() && reader.accept_word("define")) {
    define(reader);
  } else if (active() && reader.accept_word("undefine")) {
    undefine(reader);
  } else if (active() && reader.is_word("error")) {
    reader.next();
    problem_ = {DiagnosticCode::kErrorPragma, base::printable(reader.piece()), {}};
  } else if (active() && reader.is_word("warning")) {
    reader.next();
    if (reader.kind() == PragmaReader::Kind::kText) {
      problem_ = {DiagnosticCode::kWrittenWarning, base::printable(reader.piece()), {}};
    }
  }
  return std::move(problem_);
}

std::vector<base::SourceSpan> Conditions::open_spans() const {
  std::vector<base::SourceSpan> out;
  for (const Frame& frame : frames_) out.push_back(frame.span);
  return out;
}

void Conditions::begin_if(PragmaReader& reader, base::SourceSpan span) {
  Frame frame{active(), false, false, false, span};
  if (frame.outer) frame.taken = frame.active = evaluate(reader);
  frames_.push_back(frame);
}

void Conditions::next_branch(PragmaReader& reader, bool has_condition) {
  if (frames_.empty() || frames_.back().has_else) {
    return fail(frames_.empty() ? "no {IF ...} is open in front of this branch"
                                : "this branch stands after the {ELSE} of its {IF ...}");
  }
  // The condition may not change the frames.
  bool outer = frames_.back().outer;
  bool wanted = outer && !frames_.back().taken && (!has_condition || evaluate(reader));
  Frame& frame = frames_.back();
  frame.has_else = !has_condition;
  frame.active = wanted;
  frame.taken = frame.taken || wanted;
}

void Conditions::define(PragmaReader& reader) {
  std::string name = ir::fold_name(take_piece(reader, "the name that is defined"));
  if (!name.empty()) defines_[std::move(name)] = reader.piece();
}

void Conditions::undefine(PragmaReader& reader) {
  defines_.erase(ir::fold_name(take_piece(reader, "a name")));
}

const std::string* Conditions::value_of(std::string_view name) const {
  auto found = defines_.find(ir::fold_name(name));
  return found == defines_.end() ? nullptr : &found->second;
}

void Conditions::fail(std::string text) {
  if (problem_) return;
  problem_ = {DiagnosticCode::kBadCondition, std::move(text),
              "write it like {IF defined(NAME) AND NOT defined(pou: Name)}"};
}

void Conditions::expect(PragmaReader& reader, char sign) {
  if (!reader.accept_sign(sign)) fail(std::string("`") + sign + "` belongs here");
}

std::string_view Conditions::take_piece(PragmaReader& reader, const char* what) {
  bool piece =
      reader.kind() == PragmaReader::Kind::kWord || reader.kind() == PragmaReader::Kind::kText;
  if (!piece) {
    fail(std::string(what) + " belongs here");
    return {};
  }
  std::string_view out = reader.piece();
  reader.next();
  return out;
}

// False, with a problem, when it is malformed.
bool Conditions::evaluate(PragmaReader& reader) {
  bool value = disjunction(reader);
  if (reader.kind() != PragmaReader::Kind::kEnd) fail("the condition ends before this pragma does");
  return value && !problem_;
}

bool Conditions::disjunction(PragmaReader& reader) {
  bool value = conjunction(reader);
  while (reader.accept_word("OR")) value = conjunction(reader) || value;
  return value;
}

bool Conditions::conjunction(PragmaReader& reader) {
  bool value = negation(reader);
  while (reader.accept_word("AND")) value = negation(reader) && value;
  return value;
}

bool Conditions::negation(PragmaReader& reader) {
  bool positive = true;
  while (reader.accept_word("NOT")) positive = !positive;
  if (depth_ >= base::kMaxNesting) {
    fail("this condition is nested too deeply");
    return false;
  }
  ++depth_;
  bool value = query(reader);
  --depth_;
  return value == positive;
}

bool Conditions::query(PragmaReader& reader) {
  if (reader.accept_sign('(')) {
    bool value = disjunction(reader);
    expect(reader, ')');
    return value;
  }
  std::string_view function = take_piece(reader, "a condition");
  if (problem_) return false;
  expect(reader, '(');
  bool value = false;
  const bool project = ir::same_name(function, "project_defined");  // all defines are the project's
  if (project || ir::same_name(function, "defined")) {
    value = query_defined(reader);
  } else if (ir::same_name(function, "hasvalue")) {
    const std::string* value_here = value_of(take_piece(reader, "the name of a define"));
    expect(reader, ',');
    std::string_view wanted = take_piece(reader, "a value");
    value = value_here != nullptr && *value_here == wanted;
  } else if (ir::same_name(function, "hastype") || ir::same_name(function, "hasattribute")) {
    value = query_declared(reader, function);
  } else {
    fail("`" + base::printable(function) + "` is not a condition");
  }
  if (!problem_) expect(reader, ')');
  return value;
}

bool Conditions::query_defined(PragmaReader& reader) {
  std::string_view first = take_piece(reader, "a name");
  if (!reader.accept_sign(':')) return value_of(first) != nullptr;
  std::string_view name = take_piece(reader, "a name");
  auto kind = declared_kind(first);
  if (!kind) fail("`" + base::printable(first) + "` is not a kind of declaration");
  return kind && declarations_ != nullptr && declarations_->find(*kind, name, position_) != nullptr;
}

// hastype(variable: NAME, TYPE), hasattribute(pou: NAME, 'attribute')
bool Conditions::query_declared(PragmaReader& reader, std::string_view function) {
  auto kind = declared_kind(take_piece(reader, "variable, type or pou"));
  expect(reader, ':');
  std::string_view name = take_piece(reader, "a name");
  expect(reader, ',');
  std::string_view wanted = take_piece(reader, "what it is asked for");
  if (!kind) fail("variable, type or pou belongs in front of the name");
  if (!kind || declarations_ == nullptr) return false;
  const Declared* declared = declarations_->find(*kind, name, position_);
  if (declared == nullptr) return false;
  if (ir::same_name(function, "hastype")) return ir::same_name(declared->type, wanted);
  return std::any_of(declared->attributes.begin(), declared->attributes.end(),
                     [&](std::string_view other) { return ir::same_name(other, wanted); });
}

}  // namespace frontend
