#include "frontend/lower/pool_code.h"
#include "frontend/lower/write_checks.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/objects/pools.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

constexpr ir::Scalar kU64 = ir::Scalar::kU64;
constexpr ir::Scalar kNumber = ir::Scalar::kI64;
constexpr ir::Scalar kState = ir::Scalar::kU8;

ir::Place part(ir::Place place, ir::StepKind kind, uint32_t index, ir::TypeId type) {
  ir::Step step;
  step.kind = kind;
  step.index = index;
  place.steps.push_back(step);
  place.type = type;
  return place;
}

ir::Place element_at(ir::Place array, ir::ValueId index, ir::TypeId type) {
  ir::Step step;
  step.kind = ir::StepKind::kIndex;
  step.value = index;
  array.steps.push_back(step);
  array.type = type;
  return array;
}

ir::Place own_instance(ir::TypeId self) {
  ir::Place own;
  own.base = ir::PlaceBase::kSelf;
  own.base_type = own.type = self;
  return own;
}

}  // namespace

void PoolCode::search(const Pool& pool, const PerElement& each) {
  const ir::Place counter = temporary_place(types().elementary(ir::Kind::kLint));
  const ir::BlockId head = build_.new_block();
  const ir::BlockId inside = build_.new_block();
  const ir::BlockId done = build_.new_block();
  auto constant = [&](int64_t value) {
    return build_.constant(kNumber, static_cast<uint64_t>(value));
  };
  build_.store(counter, kNumber, constant(1));
  build_.jump(head);
  build_.start(head);
  const ir::ValueId now = build_.load(counter, kNumber);
  build_.branch(build_.compare(ir::Op::kLe, kNumber, now, constant(pool.count)), inside, done);
  build_.start(inside);
  each(element_at(variable_place(pool.elements), now, sema_.declared.pous[pool.block].self),
       element_at(variable_place(pool.states), now, types().elementary(ir::Kind::kByte)));
  build_.store(counter, kNumber, build_.binary(ir::Op::kAdd, kNumber, now, constant(1)));
  build_.jump(head);
  build_.start(done);
}

ir::ValueId PoolCode::has_state(const ir::Place& state, uint64_t wanted) {
  return build_.compare(ir::Op::kEq, kState, build_.load(state, kState),
                        build_.constant(kState, wanted));
}

void PoolCode::set_state(const ir::Place& state, uint64_t value) {
  build_.store(state, kState, build_.constant(kState, value));
}

ir::ValueId PoolCode::handle(const Pool& pool, const ir::Place& element) {
  if (!pool.boxed) return build_.handle(element);
  const ir::Place inside = part(element, ir::StepKind::kEnter, 0, element.type);
  return build_.handle(part(inside, ir::StepKind::kMember, 0, pool.type));
}

void PoolCode::call_made(uint32_t method, const ir::Place& at) {
  if (method == kNoPou) return;
  info_.callees.push_back(method);
  build_.call_method(sema_.declared.pous[method].id, at);
}

// Nothing can come between looking at a state and setting it: no task is suspended there.
ir::ValueId PoolCode::make(const Expr& call) {
  const ExprId type = sema_.tree.args[call.list.first].value;
  const Pool* pool = ask<Pools>().of_new(type);
  if (pool == nullptr) return code_.zero({});
  const Expr& written = sema_.tree[type];
  const Range32 args = written.kind == ExprKind::kCall ? written.list : Range32();
  if (pool->boxed && args.count != 0) {
    error(DiagnosticCode::kBadConstruction, written.span,
          "`" + std::string(pool->name) + "` has no FB_Init that takes arguments");
    return code_.zero({});
  }
  const ir::Place result = temporary_place(types().elementary(ir::Kind::kLword));
  const ir::BlockId done = build_.new_block();
  build_.store(result, kU64, build_.constant(kU64, 0));
  search(*pool, [&](const ir::Place& element, const ir::Place& state) {
    start_.when(has_state(state, kPoolFree), [&] {
      set_state(state, kPoolUsed);
      call_made(sema_.declared.pous[pool->block].reset, element);
      start_.construct(element, sema_.declared.pous[pool->block].self, args, call.span);
      build_.store(result, kU64, handle(*pool, element));
      build_.jump(done);
    });
  });
  build_.jump(done);
  build_.start(done);
  return build_.load(result, kU64);
}

void PoolCode::destroy(const Expr& call) {
  const ExprId argument = sema_.tree.args[call.list.first].value;
  const Note& note = infer(argument);
  if (!note.type.valid() || !ask<WriteChecks>().check_writable(argument)) return;
  const ir::Place pointer = place(argument);
  set_line(call.span);
  const ir::ValueId object = build_.load(pointer, kU64);
  const ir::ValueId null = build_.constant(kU64, 0);
  const ir::BlockId done = build_.new_block();
  const ir::BlockId given = build_.new_block();
  build_.branch(build_.compare(ir::Op::kNe, kU64, object, null), given, done);
  build_.start(given);
  for (const Pool* pool : ask<Pools>().of_target(types()[note.type].base)) {
    search(*pool, [&](const ir::Place& element, const ir::Place& state) {
      start_.when(has_state(state, kPoolUsed), [&] {
        start_.when(build_.compare(ir::Op::kEq, kU64, handle(*pool, element), object), [&] {
          free(*pool, element, state);
          build_.store(pointer, kU64, null);
          build_.jump(done);
        });
      });
    });
  }
  build_.trap(ir::TrapKind::kReference);
  build_.start(done);
}

// A second __DELETE of the same element, by its own FB_Exit or by another task, finds nothing.
void PoolCode::free(const Pool& pool, const ir::Place& element, const ir::Place& state) {
  const PouInfo& block = sema_.declared.pous[pool.block];
  set_state(state, kPoolLeaving);
  leave(element, block.self);
  call_made(block.reset, element);
  set_state(state, kPoolFree);
}

void PoolCode::visit_all() {
  for (const Pool& pool : sema_.pools.all) {
    const ir::TypeId type = sema_.declared.pous[pool.block].self;
    if (!ask<Objects>().constructs(type)) continue;
    search(pool, [&](const ir::Place& element, const ir::Place& state) {
      start_.when(has_state(state, kPoolUsed), [&] { start_.visit(element, type); });
    });
  }
}

void PoolCode::reset_method() {
  const ir::TypeId self = info_.self;
  const ir::Place own = own_instance(self);
  const std::vector<ir::Member> members = types()[self].members;
  for (uint32_t i = 0; i < members.size(); ++i) {
    const bool located = members[i].address.area != ir::DirectArea::kNone;
    if (members[i].section == ir::Section::kInOut || members[i].constant || located) continue;
    reset(part(own, ir::StepKind::kMember, i, members[i].type), members[i].type, members[i].init);
  }
}

void PoolCode::reset(const ir::Place& at, ir::TypeId id, ir::ConstId init) {
  if (!types().contains(id)) return;  // of a member whose type nobody knows
  const ir::Type type = types()[id];
  if (types().is_scalar(id)) {
    if (!init.valid()) init = type.init;
    const ir::Scalar scalar = types().scalar(id);
    const uint64_t bits = init.valid() ? sema_.program.constants[init].bits : 0;
    return build_.store(at, scalar, build_.constant(scalar, bits));
  }
  if (!ir::holds_instance(types(), id)) return build_.init(at, init);
  if (!init.valid()) init = type.init;
  if (type.kind == ir::Kind::kArray) return reset_elements(at, id, init);
  const bool instance = types().is_instance(id);
  ir::Place inside = at;
  if (instance) {
    call_made(sema_.declared.pou_of(id)->reset, at);
    inside = part(at, ir::StepKind::kEnter, 0, id);
  }
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    const ir::ConstId given = ask<Constants>().listed(init, i);
    if (instance && !given.valid()) continue;
    reset(part(inside, ir::StepKind::kMember, i, member.type), member.type,
          given.valid() ? given : member.init);
  }
}

void PoolCode::reset_elements(const ir::Place& at, ir::TypeId id, ir::ConstId init) {
  const ir::Type type = types()[id];
  start_.each_element(
      at, id, init, [&](const ir::Place& one, ir::ConstId value) { reset(one, type.base, value); });
}

void PoolCode::leave_method() {
  const ir::TypeId self = info_.self;
  const ir::Place own = own_instance(self);
  const std::vector<ir::Member> members = types()[self].members;
  for (uint32_t i = 0; i < members.size(); ++i) {
    if (!ir::is_listed(members[i])) continue;
    leave(part(own, ir::StepKind::kMember, i, members[i].type), members[i].type);
  }
}

// From the outside in.
void PoolCode::leave(const ir::Place& at, ir::TypeId id) {
  if (!types().contains(id)) return;
  if (!ask<Pools>().leaves(id)) return;
  const ir::Type type = types()[id];
  if (type.kind == ir::Kind::kArray) {
    return start_.each_element(at, id, {},
                               [&](const ir::Place& one, ir::ConstId) { leave(one, type.base); });
  }
  if (types().is_instance(id)) {
    const PouInfo& block = *sema_.declared.pou_of(id);
    start_.exit(at, block);
    return call_made(block.leave, at);
  }
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    leave(part(at, ir::StepKind::kMember, i, type.members[i].type), type.members[i].type);
  }
}

}  // namespace frontend
