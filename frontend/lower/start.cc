#include "frontend/lower/given_values.h"
#include "frontend/lower/pool_code.h"
#include "frontend/lower/start_code.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {

void StartCode::run() {
  if (info_.owner == kNoPou) {
    references(sema_.started.globals);
    for (VarId id : sema_.started.globals) variable(id);
    ask<PoolCode>().visit_all();
    const ir::Place flag = variable_place(sema_.started.change_flag);
    return build_.store(flag, ir::Scalar::kU32, number(0));
  }
  const PouInfo& block = sema_.declared.pous[info_.owner];
  const uint32_t base = block.base == kNoPou ? kNoPou : sema_.declared.pous[block.base].start;
  if (base != kNoPou) {
    info_.callees.push_back(base);
    build_.call_method(sema_.declared.pous[base].id);
  }
  references(block.members);
  for (VarId id : block.members) variable(id);
}

void StartCode::references(const std::vector<VarId>& variables) {
  for (VarId id : variables) {
    const Variable& variable = resolve(id);
    if (variable.section == VarSection::kInOut || !variable.type.valid()) continue;
    if (variable.each_call) continue;
    if (!sema_.start_values.inside(variable.type, variable.init)) continue;
    span_ = variable.name.span;
    bind_references(variable_place(id), variable.type, variable.init);
  }
}

void StartCode::bind_references(const ir::Place& at, ir::TypeId id, ir::ConstId init) {
  if (!sema_.start_values.inside(id, init)) return;
  const ir::Type type = types()[id];
  if (!init.valid()) init = type.init;
  if (types().is_reference(id)) return bind_reference(at, sema_.program.constants[init].bits);
  if (type.kind == ir::Kind::kArray) {
    return each_element(at, id, init, [&](const ir::Place& one, ir::ConstId given) {
      bind_references(one, type.base, given);
    });
  }
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::ConstId given = ask<Constants>().listed(init, i);
    if (!ir::is_structure(type.kind) && !given.valid()) continue;  // a matter of the block
    ir::Place member = at;
    if (!ir::is_structure(type.kind)) member.steps.push_back(step_to(ir::StepKind::kEnter));
    member.steps.push_back(step_to(ir::StepKind::kMember, i));
    member.type = type.members[i].type;
    bind_references(member, member.type, given.valid() ? given : type.members[i].init);
  }
}

// One by one, unless all are alike.
void StartCode::each_element(const ir::Place& at, ir::TypeId id, ir::ConstId init,
                             const PerValue& each) {
  const ir::Type type = types()[id];
  uint64_t total = 1;
  for (const ir::Dimension& dim : type.dims) total *= dim.count();
  std::vector<ir::ConstElement> given;
  if (init.valid()) given = sema_.program.constants[init].elements;
  const bool alike = given.empty() || (given.size() == 1 && given[0].count == total);
  if (alike) {
    const ir::ConstId value = given.empty() ? ir::ConstId() : given[0].value;
    return loop(at, type.dims, 0, type.base, [&](const ir::Place& one) { each(one, value); });
  }
  for (uint64_t i = 0; i < total; ++i) {
    each(element(at, type, i), ask<Constants>().listed(init, i));
  }
}

ir::Place StartCode::element(const ir::Place& at, const ir::Type& array, uint64_t flat) {
  ir::Place one = at;
  for (size_t d = array.dims.size(); d-- > 0; flat /= array.dims[d].count()) {
    ir::Step index = step_to(ir::StepKind::kIndex);
    index.constant_index = array.dims[d].low + static_cast<int64_t>(flat % array.dims[d].count());
    one.steps.insert(one.steps.begin() + static_cast<ptrdiff_t>(at.steps.size()), index);
  }
  one.type = array.base;
  return one;
}

void StartCode::bind_reference(const ir::Place& at, uint64_t unbound) {
  constexpr ir::Scalar kU64 = ir::Scalar::kU64;
  const ExprId expr = sema_.start_values.find(unbound);
  const ir::ValueId now = build_.load(at, kU64);
  when(build_.compare(ir::Op::kEq, kU64, now, build_.constant(kU64, unbound)), [&] {
    set_line(sema_.tree[expr].span);
    build_.store(at, kU64, value(expr, at.type));
  });
}

void StartCode::begin(VarId id) {
  const Variable& variable = resolve(id);
  bind_references(variable_place(id), variable.type, variable.init);
  visit(id);
}

void StartCode::variable(VarId id) {
  if (!resolve(id).each_call) visit(id);
}

void StartCode::visit(VarId id) {
  const Variable& variable = resolve(id);
  if (variable.section == VarSection::kInOut || !ask<Objects>().constructs(variable.type)) return;
  const Spec* spec =
      variable.decl == nullptr ? nullptr : ask<Objects>().construction(variable.decl->spec);
  set_line(variable.name.span);
  span_ = variable.name.span;
  const bool late = !variable.retain && ask<GivenValues>().come_late();
  content(variable_place(id), variable.type, {spec, late ? variable.init : ir::ConstId()});
}

void StartCode::content(const ir::Place& at, ir::TypeId type, Written written) {
  if (!ask<Objects>().constructs(type)) return;
  const ir::Kind kind = types()[type].kind;
  if (kind == ir::Kind::kArray) return elements(at, type, written);
  if (!ir::is_structure(kind)) {
    const Spec* spec = written.spec;
    return instance(at, type, spec == nullptr ? Range32() : spec->args, written.values);
  }
  for (uint32_t i = 0; i < types()[type].members.size(); ++i) {
    ir::Place member = at;
    member.steps.push_back(step_to(ir::StepKind::kMember, i));
    member.type = types()[type].members[i].type;
    const StructureField* field = sema_.declared.find_field(type, types()[type].members[i].name);
    const bool whole = field != nullptr && field->bit < 0;
    StartCode outside(body_, PouScope());  // it sees what the members' arguments name
    outside.span_ = span_;
    Written inside;
    if (whole) inside.spec = outside.ask<Objects>().construction(field->spec);
    if (ask<GivenValues>().come_late()) {
      inside.values = ask<Constants>().listed(written.values, i);
      if (!inside.values.valid()) inside.values = types()[type].members[i].init;
    }
    outside.content(member, member.type, inside);
  }
}

// Pump[(1), (2)] has arguments for each element; otherwise all have the same.
void StartCode::elements(const ir::Place& at, ir::TypeId id, Written written) {
  const ir::Type type = types()[id];
  const ir::TypeId base = type.base;
  const Spec* spec = written.spec;
  const bool array = spec != nullptr && spec->kind == SpecKind::kArray;
  if (!array || spec->element_args.count == 0) {
    const Spec* inner = array ? ask<Objects>().construction(spec->element) : nullptr;
    return each_element(at, id, written.values, [&](const ir::Place& one, ir::ConstId values) {
      content(one, base, {inner, values});
    });
  }
  uint64_t total = 1;
  for (const ir::Dimension& dim : type.dims) total *= dim.count();
  if (total != spec->element_args.count || !types().is_instance(base)) {
    error(DiagnosticCode::kBadConstruction, spec->span,
          std::to_string(spec->element_args.count) + " lists of arguments for " +
              std::to_string(total) + " elements",
          "give one for each, or one for all: ARRAY[..] OF Block(arguments)");
    return;
  }
  for (uint32_t i = 0; i < total; ++i) {
    const Expr& list = sema_.tree[sema_.tree.expr_lists[spec->element_args.first + i]];
    instance(element(at, type, i), base, list.list, ask<Constants>().listed(written.values, i));
  }
}

// One loop for each dimension, from the first.
void StartCode::loop(const ir::Place& at, const std::vector<ir::Dimension>& dims, size_t number,
                     ir::TypeId element, const PerElement& each) {
  if (number == dims.size()) {
    ir::Place one = at;
    one.type = element;
    return each(one);
  }
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  const ir::Place counter = temporary_place(types().elementary(ir::Kind::kLint));
  const ir::BlockId head = build_.new_block();
  const ir::BlockId body = build_.new_block();
  const ir::BlockId done = build_.new_block();
  auto constant = [&](int64_t value) {
    return build_.constant(kI64, static_cast<uint64_t>(value));
  };
  build_.store(counter, kI64, constant(dims[number].low));
  build_.jump(head);
  build_.start(head);
  const ir::ValueId now = build_.load(counter, kI64);
  build_.branch(build_.compare(ir::Op::kLe, kI64, now, constant(dims[number].high)), body, done);
  build_.start(body);
  ir::Place inner = at;
  inner.steps.push_back(step_to(ir::StepKind::kIndex));
  inner.steps.back().value = now;
  loop(inner, dims, number + 1, element, each);
  build_.store(counter, kI64, build_.binary(ir::Op::kAdd, kI64, now, constant(1)));
  build_.jump(head);
  build_.start(done);
}

void StartCode::when(ir::ValueId condition, const std::function<void()>& then) {
  const ir::BlockId inside = build_.new_block();
  const ir::BlockId behind = build_.new_block();
  build_.branch(condition, inside, behind);
  build_.start(inside);
  then();
  build_.jump(behind);
  build_.start(behind);
}

}  // namespace frontend
