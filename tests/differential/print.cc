// The tree as Structured Text.
#include "tests/differential/tree.h"

namespace differential {
namespace {

std::string filled(const std::string& pattern, const std::vector<Expr>& operands) {
  std::string out;
  for (size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '@') {
      out += pattern[i];
      continue;
    }
    char which = pattern[++i];
    if (which != '*') {
      out += text(operands[static_cast<size_t>(which - '0')]);
      continue;
    }
    for (const Expr& operand : operands) {
      if (&operand != operands.data()) out += ", ";
      out += text(operand);
    }
  }
  return out;
}

std::string array_text(const Program& program, const Type& type) {
  std::string dims;
  for (const Bounds& dim : type.dims) {
    if (!dims.empty()) dims += ", ";
    dims += std::to_string(dim.low) + ".." + std::to_string(dim.high);
  }
  return "ARRAY[" + dims + "] OF " + type_text(program, type.base);
}

class Printer {
 public:
  explicit Printer(const Program& program) : program_(program) {}

  std::string run() {
    types();
    for (const VarBlock& block : program_.globals) variables(block);
    for (const Pou& one : program_.pous) in_space(one);
    configuration();
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_ += std::string(indent_ * 2, ' ') + text + "\n"; }

  void types() {
    if (program_.declared.empty()) return;
    line("TYPE");
    ++indent_;
    for (TypeRef type : program_.declared) declaration(program_[type]);
    --indent_;
    line("END_TYPE");
  }

  void declaration(const Type& type) {
    switch (type.form) {
      case Form::kEnum:
        return line(type.name + " : " + enumeration(type) + ";");
      case Form::kSubrange:
        return line(type.name + " : " + type_text(program_, type.base) + " (" +
                    std::to_string(type.low) + ".." + std::to_string(type.high) + ");");
      case Form::kStruct:
        return structure(type, "STRUCT");
      case Form::kUnion:
        return structure(type, type.overlap ? "STRUCT OVERLAP" : "UNION");
      default:
        return line(type.name + " : " + array_text(program_, type) + ";");
    }
  }

  void structure(const Type& type, const std::string& word) {
    bool extends = type.form == Form::kStruct && type.base != kNoType;
    line(type.name + (extends ? " EXTENDS " + type_text(program_, type.base) : "") + " : " + word);
    ++indent_;
    for (const Variable& member : type.members) variable(member);
    --indent_;
    line(word == "UNION" ? "END_UNION;" : "END_STRUCT;");
  }

  std::string enumeration(const Type& type) const {
    std::string out = is_elementary(type.base) && type.base != elementary(ir::Kind::kInt)
                          ? program_[type.base].name + " ("
                          : "(";
    for (size_t i = 0; i < type.literals.size(); ++i) {
      if (i != 0) out += ", ";
      out += type.literals[i] + " := " + std::to_string(type.values[i]);
    }
    return out + ")";
  }

  void variable(const Variable& one) {
    line(one.name + (one.address.empty() ? "" : " AT " + one.address) + " : " +
         (one.bit ? "BIT" : type_text(program_, one.type)) + one.arguments +
         (one.edge.empty() ? "" : " " + one.edge) +
         (one.initial ? initial_word(one) + text(*one.initial) : "") + ";");
  }

  const char* initial_word(const Variable& one) const {
    return program_[one.type].form == Form::kReference ? " REF= " : " := ";
  }

  void variables(const VarBlock& block) {
    if (block.variables.empty()) return;
    if (!block.list.empty()) {
      line("{attribute 'list' := '" + block.list + "'} {attribute 'qualified_only'}");
    }
    line(section_text(block.section));
    ++indent_;
    for (const Variable& one : block.variables) variable(one);
    --indent_;
    line("END_VAR");
  }

  void in_space(const Pou& one) {
    if (!one.space.empty()) line("NAMESPACE " + one.space);
    size_t begin = out_.size();
    pou(one);
    if (!one.uses.empty()) shorten(begin, one.uses);
    if (!one.space.empty()) line("END_NAMESPACE");
  }

  // Names of that namespace stand alone.
  void shorten(size_t begin, const std::string& space) {
    std::string text = out_.substr(begin);
    out_.resize(begin);
    size_t done = 0;
    for (size_t at = text.find(space + "."); at != std::string::npos;
         at = text.find(space + ".", done)) {
      size_t end = at + space.size() + 1;
      bool deeper = text.compare(end, 4, "Deep") == 0;
      out_ += text.substr(done, (deeper ? end : at) - done);
      done = end;
    }
    out_ += text.substr(done);
  }

  void pou(const Pou& one) {
    static constexpr const char* kHeads[] = {"FUNCTION", "FUNCTION_BLOCK", "PROGRAM",
                                             "CLASS",    "METHOD",         "INTERFACE"};
    std::string head = kHeads[static_cast<size_t>(one.kind)];
    if (!one.attribute.empty()) line(one.attribute);
    line(head + " " + one.words + one.name + one.relations +
         (one.result == kNoType ? "" : " : " + type_text(program_, one.result)));
    if (!one.uses.empty()) line("  USING " + one.uses + ";");
    for (const VarBlock& block : one.blocks) variables(block);
    ++indent_;
    for (const Pou& method : one.methods) pou(method);
    --indent_;
    statements(one.body);
    statements(one.members);
    line("END_" + head);
  }

  void statements(const std::vector<Stmt>& list) {
    ++indent_;
    for (const Stmt& one : list) {
      for (const Clause& clause : one.clauses) {
        line(filled(clause.head, clause.operands));
        statements(clause.body);
      }
      if (!one.tail.empty()) line(one.tail);
    }
    --indent_;
  }

  void configuration() {
    if (program_.tasks.empty()) return;
    line("CONFIGURATION Plant");
    line("  RESOURCE Cpu ON PLC");
    for (const Task& task : program_.tasks) {
      for (const std::string& one : task.attributes) line("    {attribute " + one + "}");
      std::string when = task.event.empty()
                             ? "INTERVAL := T#" + std::to_string(task.period_ms) + "ms"
                             : "SINGLE := " + task.event;
      line("    TASK " + task.name + "(" + when + ", PRIORITY := " + std::to_string(task.priority) +
           ");");
    }
    for (const Task& task : program_.tasks) {
      if (task.program.empty()) continue;  // of a function block
      std::string list;
      for (const std::string& one : task.connections) list += (list.empty() ? "(" : ", ") + one;
      line("    PROGRAM Run" + task.program + " WITH " + task.name + " : " + task.program + list +
           (list.empty() ? ";" : ");"));
    }
    line("  END_RESOURCE");
    entries("VAR_ACCESS", program_.accesses);
    entries("VAR_CONFIG", program_.configured);
    line("END_CONFIGURATION");
  }

  void entries(const std::string& word, const std::vector<std::string>& list) {
    if (list.empty()) return;
    line("  " + word);
    for (const std::string& one : list) line("    " + one);
    line("  END_VAR");
  }

  const Program& program_;
  std::string out_;
  size_t indent_ = 0;
};

}  // namespace

const char* section_text(Section section) {
  static constexpr const char* kTexts[] = {
      "VAR",        "VAR_INPUT",         "VAR_OUTPUT",         "VAR_IN_OUT", "VAR_TEMP",
      "VAR RETAIN", "VAR CONSTANT",      "VAR_STAT",           "VAR_INST",   "VAR_EXTERNAL",
      "VAR_GLOBAL", "VAR_GLOBAL RETAIN", "VAR_GLOBAL CONSTANT"};
  return kTexts[static_cast<size_t>(section)];
}

std::vector<Variable> members_of(const Program& program, TypeRef ref) {
  const Type& type = program[ref];
  std::vector<Variable> out;
  if (type.form == Form::kStruct && type.base != kNoType) out = members_of(program, type.base);
  out.insert(out.end(), type.members.begin(), type.members.end());
  return out;
}

std::string type_text(const Program& program, TypeRef ref) {
  const Type& type = program[ref];
  return type.name.empty() ? array_text(program, type) : type.name;
}

std::string text(const Expr& expr) { return filled(expr.pattern, expr.operands); }

std::string print(const Program& program) { return Printer(program).run(); }

}  // namespace differential
