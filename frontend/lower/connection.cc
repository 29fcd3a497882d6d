// PROGRAM p WITH t : T(in := g, out => h): inputs are copied before each scan of the
// program, outputs after it. The other side is named where the configuration stands.
#include "frontend/lower/assignments.h"
#include "frontend/lower/frame.h"

namespace frontend {

void Frame::connect_inputs() {
  for (const Connection& connection : info_.connections) {
    const Arg& arg = tree_.args[connection.arg];
    const Variable& input = resolve(connection.parameter);
    if (input.section != VarSection::kInput || !input.type.valid()) continue;
    Target target;
    target.place = member_variable_place(input);
    target.type = input.type;
    Frame(body_, PouScope()).connect_input(target, arg);
  }
}

void Frame::connect_input(const Target& input, const Arg& arg) {
  set_line(arg.span);
  if (types().is_scalar(input.type)) {
    store(input, value(arg.value, input.type));
  } else {
    ask<Assignments>().assign_aggregate(input, arg.value);
  }
}

void Frame::connect_outputs() {
  for (const Connection& connection : info_.connections) {
    const Arg& arg = tree_.args[connection.arg];
    const Variable& output = resolve(connection.parameter);
    if (output.section != VarSection::kOutput || !output.type.valid()) continue;
    Frame(body_, PouScope()).connect_output(output, arg);
  }
}

void Frame::connect_output(const Variable& output, const Arg& arg) {
  ir::Place from = member_variable_place(output);
  set_line(arg.span);
  auto to = target(arg.value);
  if (!to) return;
  bool strings = is_string(types(), output.type) && is_string(types(), to->type) &&
                 wide(output.type) == wide(to->type);
  if (types().is_scalar(output.type) && types().is_scalar(to->type)) {
    ir::ValueId now = build_.load(from, scalar(output.type));
    if (arg.negated) now = build_.unary(ir::Op::kNot, scalar(output.type), now);
    store(*to, convert({now, output.type}, to->type, arg.span));
  } else if (strings || output.type == to->type) {
    build_.copy(to->place, from);
  } else {
    error(DiagnosticCode::kWrongArgument, arg.span,
          "`" + std::string(output.name.text) + "` is `" + sema_.report.type_text(output.type) +
              "`, its target is `" + sema_.report.type_text(to->type) + "`");
  }
}

}  // namespace frontend
