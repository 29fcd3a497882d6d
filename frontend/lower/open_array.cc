// Elements and bounds of an ARRAY[*] that is known when the code runs only
// (sema/declarations/open_arrays.cc), and what makes one of an array.
#include "frontend/lower/arguments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/lower/write_checks.h"

namespace frontend {
namespace {

constexpr ir::Scalar kI64 = ir::Scalar::kI64;

// #data, or #low1, #high1, #low2 and so on.
ir::Place part_of(const ir::Place& record, const ir::TypeTable& types, uint32_t member) {
  ir::Place part = record;
  part.steps.push_back(step_to(ir::StepKind::kMember, member));
  part.type = types[record.type].members[member].type;
  return part;
}

uint32_t low_member(uint32_t dimension) { return 1 + 2 * dimension; }

}  // namespace

ir::Place Places::open_element(const Expr& expr, const OpenArray& open) {
  const ir::Place record = place(expr.operand);
  std::vector<ir::ValueId> indices;
  for (uint32_t i = 0; i < open.dims; ++i) {
    const Typed index = natural(tree_.expr_lists[expr.list.first + i]);
    indices.push_back(code_.machine_convert(index.value, scalar(index.type), kI64));
  }
  set_line(expr.span);
  const ir::BlockId bad = build_.new_block();
  ir::ValueId flat;
  for (uint32_t i = 0; i < open.dims; ++i) {
    const ir::ValueId low = build_.load(part_of(record, types(), low_member(i)), kI64);
    const ir::ValueId high = build_.load(part_of(record, types(), low_member(i) + 1), kI64);
    for (const bool first : {true, false}) {
      const ir::BlockId good = build_.new_block();
      build_.branch(first ? build_.compare(ir::Op::kLe, kI64, low, indices[i])
                          : build_.compare(ir::Op::kLe, kI64, indices[i], high),
                    good, bad);
      build_.start(good);
    }
    const ir::ValueId at = build_.binary(ir::Op::kSub, kI64, indices[i], low);
    if (!flat.valid()) {
      flat = at;
      continue;
    }
    const ir::ValueId count = build_.binary(
        ir::Op::kAdd, kI64, build_.binary(ir::Op::kSub, kI64, high, low), build_.constant(kI64, 1));
    flat = build_.binary(ir::Op::kAdd, kI64, build_.binary(ir::Op::kMul, kI64, flat, count), at);
  }
  const ir::ValueId data = build_.load(part_of(record, types(), 0), ir::Scalar::kU64);
  const ir::BlockId on = build_.new_block();
  build_.jump(on);
  build_.start(bad);
  build_.trap(ir::TrapKind::kIndex);
  build_.start(on);
  return code_.target_place(code_.moved(data, flat, open.element), open.element);
}

ir::ValueId Places::open_bound(ExprId array, uint32_t dimension, bool upper) {
  const ir::Place bound = part_of(place(array), types(), low_member(dimension) + (upper ? 1 : 0));
  return code_.machine_convert(build_.load(bound, kI64), kI64, ir::Scalar::kI32);
}

// The record of an array, or the caller's own one.
bool Arguments::evaluate_open_array(Binding& binding, const OpenArray& open) {
  const Variable& parameter = resolve(binding.variable);
  const ExprId id = binding.arg->value;
  const Note& note = infer(id);
  if (!note.type.valid()) return false;
  if (note.type == parameter.type) {
    const ir::Place record = place(id);
    parameter.by_reference ? void(binding.place = record)
                           : void(binding.value = build_.address(record));
    return true;
  }
  const ir::Type& array = types()[note.type];
  if (array.kind != ir::Kind::kArray || array.base != open.element ||
      array.dims.size() != open.dims) {
    error(DiagnosticCode::kInOutNeedsVariable, binding.arg->span,
          quoted_name(parameter.name) + " is `" + sema_.report.type_text(parameter.type) +
              "`, the argument is `" + sema_.report.type_text(note.type) + "`",
          "pass an array with elements of exactly this type");
    return false;
  }
  if (!ask<WriteChecks>().check_writable(id)) return false;
  const ir::Place record = temporary_place(parameter.type);
  build_.store(part_of(record, types(), 0), ir::Scalar::kU64, ask<References>().handle_of(id));
  for (uint32_t i = 0; i < open.dims; ++i) {
    const ir::Dimension dim = types()[note.type].dims[i];
    for (const bool upper : {false, true}) {
      build_.store(part_of(record, types(), low_member(i) + (upper ? 1 : 0)), kI64,
                   build_.constant(kI64, static_cast<uint64_t>(upper ? dim.high : dim.low)));
    }
  }
  binding.place = record;
  return true;
}

}  // namespace frontend
