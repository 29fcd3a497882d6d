#include "frontend/parse/printer.h"
#include "frontend/parse/section_word.h"

namespace frontend {

namespace {

const char* pou_name(PouKind kind) {
  switch (kind) {
    case PouKind::kFunction:
      return "FUNCTION ";
    case PouKind::kFunctionBlock:
      return "FUNCTION_BLOCK ";
    case PouKind::kProgram:
      return "PROGRAM ";
    case PouKind::kClass:
      return "CLASS ";
    case PouKind::kInterface:
      return "INTERFACE ";
    case PouKind::kMethod:
      return "METHOD ";
    case PouKind::kAction:
      return "ACTION ";
    case PouKind::kGetter:
      return "GET ";
    case PouKind::kSetter:
      return "SET ";
    case PouKind::kTest:
      return "TEST ";
    case PouKind::kSetup:
      return "SETUP";
    case PouKind::kTeardown:
      return "TEARDOWN";
    case PouKind::kMockFunction:
      return "MOCK_FUNCTION ";
  }
  return "";
}

const char* access_name(Access access) {
  switch (access) {
    case Access::kDefault:
      return "";
    case Access::kPublic:
      return "PUBLIC ";
    case Access::kPrivate:
      return "PRIVATE ";
    case Access::kProtected:
      return "PROTECTED ";
    case Access::kInternal:
      return "INTERNAL ";
  }
  return "";
}

}  // namespace

std::string print(const Tree& tree) { return Printer(tree).run(); }

std::string Printer::run() {
  for (const Scope& scope : tree_.scopes) usings(scope);
  for (const TypeDecl& decl : tree_.types) type(decl);
  for (const VarBlock& globals : tree_.globals) block(globals);
  for (const PouDecl& decl : tree_.pous) pou(decl);
  for (const ConfigDecl& decl : tree_.configs) config(decl);
  for (const PouDecl& decl : tree_.tests) pou(decl);
  return std::move(out_);
}

void Printer::type(const TypeDecl& decl) {
  attributes(decl.attributes);
  std::string text = "TYPE " + (access_name(decl.access) + scoped(decl.scope, decl.name)) + " : " +
                     spec(decl.spec);
  if (decl.init.valid()) text += " := " + expression(decl.init);
  line(text);
}

void Printer::pou(const PouDecl& decl) {
  attributes(decl.attributes);
  bool member = decl.kind >= PouKind::kMethod;
  std::string head = pou_name(decl.kind) + std::string(access_name(decl.access));
  if (decl.is_abstract) head += "ABSTRACT ";
  if (decl.is_final) head += "FINAL ";
  if (decl.is_override) head += "OVERRIDE ";
  if (decl.qualifiers.count != 0) head += path(decl.qualifiers) + '.';
  head += member ? std::string(decl.name.text) : scoped(decl.scope, decl.name);
  head += spec_list(" EXTENDS ", decl.extends) + spec_list(" IMPLEMENTS ", decl.implements);
  if (decl.result.valid()) head += " : " + spec(decl.result);
  line(head);
  ++depth_;
  for (Range32 used : decl.usings) line("USING " + path(used));
  for (const VarBlock& vars : decl.blocks) block(vars);
  for (const PouDecl& inner : decl.members) pou(inner);
  body(decl.body);
  if (decl.chart != kNoChart) chart(tree_.charts[decl.chart]);
  --depth_;
}

std::string Printer::spec_list(const char* word, const std::vector<SpecId>& specs) const {
  std::string out;
  for (SpecId id : specs) out += (out.empty() ? word : ", ") + spec(id);
  return out;
}

std::string Printer::path(Range32 names) const {
  std::string out;
  for (uint32_t i = 0; i < names.count; ++i) {
    out += (i == 0 ? "" : ".") + std::string(tree_.names[names.first + i].text);
  }
  return out;
}

void Printer::usings(const Scope& scope) {
  std::string in = scope.name.empty() ? "" : " IN " + scoped(scope.parent, scope.name);
  for (Range32 used : scope.usings) line("USING " + path(used) + in);
}

// The name with its namespaces in front.
std::string Printer::scoped(ScopeId scope, const Name& name) const {
  std::string out(name.text);
  for (ScopeId at = scope; tree_.in_namespace(at); at = tree_[at].parent) {
    out = std::string(tree_[at].name.text) + '.' + out;
  }
  return out;
}

std::string Printer::attribute_text(Range32 of) const {
  std::string out;
  for (uint32_t i = 0; i < of.count; ++i) {
    const Attribute& attribute = tree_.attributes[of.first + i];
    out += (i == 0 ? "{" : " {") + std::string(attribute.name.text);
    if (attribute.has_value) out += " := " + std::string(attribute.value);
    out += '}';
  }
  return out;
}

void Printer::attributes(Range32 of) {
  if (of.count != 0) line(attribute_text(of));
}

void Printer::block(const VarBlock& block) {
  attributes(block.attributes);
  std::string head = section_word(block.section);
  if (block.constant) head += " CONSTANT";
  if (block.retain) head += " RETAIN";
  if (block.non_retain) head += " NON_RETAIN";
  if (block.access != Access::kDefault) head += std::string(" ") + access_name(block.access);
  if (head.back() == ' ') head.pop_back();
  line(head);
  ++depth_;
  for (const VarDecl& decl : block.vars) line(variable(decl));
  --depth_;
}

std::string Printer::variable(const VarDecl& decl) const {
  std::string text;
  for (const Name& name : decl.names) {
    text += (text.empty() ? "" : ", ") + std::string(name.text);
  }
  if (decl.path.valid()) text += (text.empty() ? "" : " : ") + expression(decl.path);
  if (decl.has_address) {
    text += " AT " + address(decl.address, decl.levels, decl.incomplete);
  }
  text += " : " + spec(decl.spec);
  if (decl.edge != Edge::kNone) text += decl.edge == Edge::kRising ? " R_EDGE" : " F_EDGE";
  if (decl.init.valid()) text += " := " + expression(decl.init);
  if (decl.writable) text += " READ_WRITE";
  if (decl.attributes.count != 0) text = attribute_text(decl.attributes) + ' ' + text;
  return text;
}

void Printer::config(const ConfigDecl& decl) {
  attributes(decl.attributes);
  line("CONFIGURATION " + std::string(decl.name.text));
  ++depth_;
  for (const VarBlock& globals : decl.globals) block(globals);
  for (const ResourceDecl& item : decl.resources) resource(item);
  --depth_;
}

void Printer::resource(const ResourceDecl& decl) {
  attributes(decl.attributes);
  std::string head = "RESOURCE";
  if (!decl.name.empty()) head += ' ' + std::string(decl.name.text);
  if (!decl.type.empty()) head += " ON " + std::string(decl.type.text);
  line(head);
  ++depth_;
  for (const VarBlock& globals : decl.globals) block(globals);
  for (const TaskDecl& item : decl.tasks) task(item);
  for (const ProgramDecl& item : decl.programs) program(item);
  --depth_;
}

void Printer::task(const TaskDecl& decl) {
  attributes(decl.attributes);
  std::string text = "TASK " + std::string(decl.name.text);
  if (decl.interval.valid()) text += " INTERVAL " + expression(decl.interval);
  if (decl.single.valid()) text += " SINGLE " + expression(decl.single);
  if (decl.priority.valid()) text += " PRIORITY " + expression(decl.priority);
  line(text);
}

void Printer::program(const ProgramDecl& decl) {
  attributes(decl.attributes);
  std::string text = "PROGRAM ";
  if (decl.retain) text += "RETAIN ";
  if (decl.non_retain) text += "NON_RETAIN ";
  text += decl.name.text;
  if (!decl.task.empty()) text += " WITH " + std::string(decl.task.text);
  text += " : ";
  if (decl.qualifiers.count != 0) text += path(decl.qualifiers) + '.';
  text += decl.type.text;
  if (decl.args.count != 0) text += arguments(decl.args);
  for (const BlockTask& block : decl.block_tasks) {
    text += ", " + std::string(block.block.text) + " WITH " + std::string(block.task.text);
  }
  line(text);
}

}  // namespace frontend
