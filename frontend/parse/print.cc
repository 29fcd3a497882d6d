#include "frontend/parse/printer.h"

namespace frontend {

namespace {

const char* section_name(VarSection section) {
  switch (section) {
    case VarSection::kLocal:
      return "VAR";
    case VarSection::kInput:
      return "VAR_INPUT";
    case VarSection::kOutput:
      return "VAR_OUTPUT";
    case VarSection::kInOut:
      return "VAR_IN_OUT";
    case VarSection::kTemp:
      return "VAR_TEMP";
    case VarSection::kExternal:
      return "VAR_EXTERNAL";
    case VarSection::kGlobal:
      return "VAR_GLOBAL";
  }
  return "";
}

const char* pou_name(PouKind kind) {
  switch (kind) {
    case PouKind::kFunction:
      return "FUNCTION ";
    case PouKind::kFunctionBlock:
      return "FUNCTION_BLOCK ";
    case PouKind::kProgram:
      return "PROGRAM ";
  }
  return "";
}

}  // namespace

std::string print(const Tree& tree) { return Printer(tree).run(); }

std::string Printer::run() {
  for (const TypeDecl& decl : tree_.types) type(decl);
  for (const VarBlock& globals : tree_.globals) block(globals);
  for (const PouDecl& decl : tree_.pous) pou(decl);
  for (const ConfigDecl& decl : tree_.configs) config(decl);
  return std::move(out_);
}

void Printer::type(const TypeDecl& decl) {
  std::string text = "TYPE " + std::string(decl.name.text) + " : " + spec(decl.spec);
  if (decl.init.valid()) text += " := " + expression(decl.init);
  line(text);
}

void Printer::pou(const PouDecl& decl) {
  std::string head = pou_name(decl.kind) + std::string(decl.name.text);
  if (decl.result.valid()) head += " : " + spec(decl.result);
  line(head);
  ++depth_;
  for (const VarBlock& vars : decl.blocks) block(vars);
  body(decl.body);
  --depth_;
}

void Printer::block(const VarBlock& block) {
  std::string head = section_name(block.section);
  if (block.constant) head += " CONSTANT";
  if (block.retain) head += " RETAIN";
  line(head);
  ++depth_;
  for (const VarDecl& decl : block.vars) variable(decl);
  --depth_;
}

void Printer::variable(const VarDecl& decl) {
  std::string text;
  for (const Name& name : decl.names) {
    text += (text.empty() ? "" : ", ") + std::string(name.text);
  }
  if (decl.has_address) text += " AT " + address(decl.address);
  text += " : " + spec(decl.spec);
  if (decl.init.valid()) text += " := " + expression(decl.init);
  line(text);
}

void Printer::config(const ConfigDecl& decl) {
  line("CONFIGURATION " + std::string(decl.name.text));
  ++depth_;
  for (const VarBlock& globals : decl.globals) block(globals);
  for (const ResourceDecl& item : decl.resources) resource(item);
  --depth_;
}

void Printer::resource(const ResourceDecl& decl) {
  line("RESOURCE" + (decl.name.empty() ? "" : ' ' + std::string(decl.name.text)));
  ++depth_;
  for (const VarBlock& globals : decl.globals) block(globals);
  for (const TaskDecl& item : decl.tasks) task(item);
  for (const ProgramDecl& item : decl.programs) program(item);
  --depth_;
}

void Printer::task(const TaskDecl& decl) {
  std::string text = "TASK " + std::string(decl.name.text);
  if (decl.interval.valid()) text += " INTERVAL " + expression(decl.interval);
  if (decl.single.valid()) text += " SINGLE " + expression(decl.single);
  if (decl.priority.valid()) text += " PRIORITY " + expression(decl.priority);
  line(text);
}

void Printer::program(const ProgramDecl& decl) {
  std::string text = "PROGRAM " + std::string(decl.name.text);
  if (!decl.task.empty()) text += " WITH " + std::string(decl.task.text);
  text += " : " + std::string(decl.type.text);
  if (decl.args.count != 0) text += arguments(decl.args);
  line(text);
}

}  // namespace frontend
