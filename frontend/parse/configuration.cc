// CONFIGURATION, RESOURCE, TASK, and program instances.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

void Parser::parse_configuration() {
  const Token opening = take();
  ConfigDecl config;
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
      return parse_var_block(config.globals);
    }
    report_here(Code::kWrongSection, "a configuration has VAR_GLOBAL blocks only");
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
  const Token opening = take();
  ResourceDecl resource;
  resource.name = parse_name("resource");
  if (!panic_ && accept(TokenKind::kOn)) parse_name("resource type");
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
      parse_var_block(resource.globals);
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
  base::SourcePos begin = {take().begin};
  task.name = parse_name("task");
  const Token open = *current_;
  if (!panic_ && expect(TokenKind::kLeftParen, "behind the name of the task")) {
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
  if (expect(TokenKind::kAssign, "behind the task parameter")) *place = parse_expression();
}

// PROGRAM name [WITH task] : type [(in := g, out => h)];
ProgramDecl Parser::parse_program_instance() {
  ProgramDecl program;
  base::SourcePos begin = {take().begin};
  if ((kind() == TokenKind::kRetain || kind() == TokenKind::kNonRetain) && is_name(next_kind())) {
    not_supported(take().span(), "RETAIN for a whole program is", "declare VAR RETAIN inside it");
  }
  program.name = parse_name("program instance");
  if (!panic_ && accept(TokenKind::kWith)) program.task = parse_name("task");
  if (!panic_) expect(TokenKind::kColon, "in front of the program's type");
  if (!panic_) program.type = parse_name("program type");
  if (!panic_ && kind() == TokenKind::kLeftParen) {
    if (is_name(next_kind()) && peek(2).kind == TokenKind::kWith) {
      not_supported(peek(2).span(), "function blocks with a task of their own are");
      panic_ = true;
    } else {
      program.args = parse_arguments();
    }
  }
  program.span = span_from(begin);
  finish_declaration("program instance");
  return program;
}

}  // namespace frontend
