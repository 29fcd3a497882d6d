// R_EDGE and F_EDGE: inside, such an input is TRUE in the call that sees the edge. What
// the caller wrote, or left as it was, is compared with what the call before saw.
#include "frontend/lower/frame.h"

namespace frontend {

void Frame::detect_edges() {
  for (VarId id : info_.variables) {
    const Variable& input = resolve(id);
    if (!input.edge.valid() || !input.type.valid()) continue;
    constexpr ir::Scalar kBool = ir::Scalar::kBool;
    set_line(input.name.span);
    ir::Place raw = member_variable_place(input);
    ir::Place last = member_variable_place(resolve(input.last));
    ir::Place edge = variable_place(input.edge);
    ir::ValueId now = build_.load(raw, kBool);
    ir::ValueId before = build_.load(last, kBool);
    bool rising = input.decl->edge == Edge::kRising;
    // The memory starts FALSE, as in the standard's R_TRIG and F_TRIG: for a falling edge it
    // holds the negated value.
    ir::ValueId level = rising ? now : build_.unary(ir::Op::kNot, kBool, now);
    ir::ValueId was_not = build_.unary(ir::Op::kNot, kBool, before);
    build_.store(edge, kBool, build_.binary(ir::Op::kAnd, kBool, level, was_not));
    build_.store(last, kBool, level);
  }
}

}  // namespace frontend
