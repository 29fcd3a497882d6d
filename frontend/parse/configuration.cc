// CONFIGURATION, RESOURCE, TASK, and program instances.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

void Parser::parse_configuration(Range32 attributes) {
  const Token opening = take();
  ConfigDecl config;
  config.attributes = attributes;
  config.scope = scope_;
  config.name = parse_name("configuration");
  panic_ = false;
  for (;;) {
    bool ends = kind() == TokenKind::kEndConfiguration || kind() == TokenKind::kEnd ||
                kind() == TokenKind::kFunction || kind() == TokenKind::kFunctionBlock ||
                kind() == TokenKind::kType || kind() == TokenKind::kConfiguration;
    if (ends) break;
    parse_configuration_item(config);
  }
  if (!accept(TokenKind::kEndConfiguration)) {
    report_missing_end(opening, TokenKind::kEndConfiguration);
  }
  accept(TokenKind::kSemicolon);
  config.span = span_from({opening.begin});
  tree_.configs.push_back(std::move(config));
}

void Parser::parse_configuration_item(ConfigDecl& config) {
  if (accept(TokenKind::kSemicolon)) return;
  if (at_var_block()) {
    if (kind() == TokenKind::kVarGlobal || kind() == TokenKind::kVarAccess ||
        kind() == TokenKind::kVarConfig) {
      return parse_var_block(config.globals, take_attributes());
    }
    report_here(Code::kWrongSection,
                "a configuration has VAR_GLOBAL, VAR_ACCESS and VAR_CONFIG blocks only");
    skip_block(TokenKind::kEndVar);
    panic_ = false;
    return;
  }
  if (kind() == TokenKind::kResource) return parse_resource(config);
  if (kind() == TokenKind::kTask || kind() == TokenKind::kProgram) {
    parse_resource_item(unnamed_resource(config));
    return;
  }
  report_here(Code::kExpected,
              "expected RESOURCE, TASK, PROGRAM, VAR_GLOBAL or END_CONFIGURATION, found " +
                  describe(*current_));
  take();
  skip_to_declaration_end();
}

ResourceDecl& Parser::unnamed_resource(ConfigDecl& config) {
  if (config.resources.empty() || !config.resources.back().name.empty()) {
    config.resources.emplace_back();
  }
  return config.resources.back();
}

// RESOURCE name [ON type] ... END_RESOURCE
void Parser::parse_resource(ConfigDecl& config) {
  ResourceDecl resource;
  resource.attributes = take_attributes();
  const Token opening = take();
  resource.name = parse_name("resource");
  if (!panic_ && accept(TokenKind::kOn)) resource.type = parse_name("resource type");
  panic_ = false;
  while (parse_resource_item(resource)) {
  }
  if (!accept(TokenKind::kEndResource)) report_missing_end(opening, TokenKind::kEndResource);
  accept(TokenKind::kSemicolon);
  config.resources.push_back(std::move(resource));
}

bool Parser::parse_resource_item(ResourceDecl& resource) {
  if (accept(TokenKind::kSemicolon)) return true;
  switch (kind()) {
    case TokenKind::kVarGlobal:
    case TokenKind::kVarAccess:
    case TokenKind::kVarConfig:
      parse_var_block(resource.globals, take_attributes());
      return true;
    case TokenKind::kTask:
      resource.tasks.push_back(parse_task());
      return true;
    case TokenKind::kProgram:
      resource.programs.push_back(parse_program_instance());
      return true;
    default:
      break;
  }
  if (kind() == TokenKind::kEnd || is_closing(kind()) || is_file_level_start(kind())) return false;
  report_here(Code::kExpected,
              "expected TASK, PROGRAM, VAR_GLOBAL or END_RESOURCE, found " + describe(*current_));
  take();
  skip_to_declaration_end();
  return true;
}

// TASK name (INTERVAL := T#10ms, PRIORITY := 1);
TaskDecl Parser::parse_task() {
  TaskDecl task;
  task.attributes = take_attributes();
  base::SourcePos begin = {take().begin};
  task.name = parse_name("task");
  const Token open = *current_;
  if (!panic_ && expect(TokenKind::kLeftParen, "after the name of the task")) {
    do {
      parse_task_parameter(task);
    } while (!panic_ && accept(TokenKind::kComma));
    close_bracket(TokenKind::kRightParen, open);
  }
  task.span = span_from(begin);
  finish_declaration("task");
  return task;
}

void Parser::parse_task_parameter(TaskDecl& task) {
  const Token name = *current_;
  ExprId* place = is_word(name, "INTERVAL")   ? &task.interval
                  : is_word(name, "PRIORITY") ? &task.priority
                  : is_word(name, "SINGLE")   ? &task.single
                                              : nullptr;
  if (place == nullptr) {
    return report_here(Code::kBadTaskParameter,
                       "a task has INTERVAL, PRIORITY and SINGLE, not " + describe(name));
  }
  take();
  if (place->valid()) {
    note_only(Code::kBadTaskParameter, name.span(), describe(name) + " is given twice");
  }
  if (expect(TokenKind::kAssign, "after the task parameter")) *place = parse_expression();
}

// PROGRAM [RETAIN] name [WITH task] : type [(in := g, out => h, fb WITH task)];
ProgramDecl Parser::parse_program_instance() {
  ProgramDecl program;
  program.attributes = take_attributes();
  base::SourcePos begin = {take().begin};
  if ((kind() == TokenKind::kRetain || kind() == TokenKind::kNonRetain) && is_name(next_kind())) {
    program.retain = kind() == TokenKind::kRetain;
    program.non_retain = !program.retain;
    take();
  }
  program.name = parse_name("program instance");
  if (!panic_ && accept(TokenKind::kWith)) program.task = parse_name("task");
  if (!panic_) expect(TokenKind::kColon, "in front of the program's type");
  if (!panic_) {
    const Spec& type = tree_[parse_type_name()];
    program.qualifiers = type.qualifiers;
    program.type = type.name;
  }
  if (!panic_ && kind() == TokenKind::kLeftParen) parse_program_connections(program);
  program.span = span_from(begin);
  finish_declaration("program instance");
  return program;
}

void Parser::parse_program_connections(ProgramDecl& program) {
  const Token open = take();
  size_t mark = arg_stack_.size();
  while (!panic_ && kind() != TokenKind::kRightParen) {
    if (is_name(kind()) && next_kind() == TokenKind::kWith) {
      Name block = name_of(take());
      take();
      program.block_tasks.push_back({block, parse_name("task")});
    } else {
      arg_stack_.push_back(parse_argument());
    }
    if (panic_ || !accept(TokenKind::kComma)) break;
  }
  close_bracket(TokenKind::kRightParen, open);
  program.args = move_tail(arg_stack_, mark, tree_.args);
}

}  // namespace frontend
