#include "frontend/lower/given_values.h"

#include "frontend/lower/arguments.h"
#include "frontend/lower/start_code.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

ir::Place member_of(const ir::TypeTable& types, ir::Place at, uint32_t member) {
  const ir::TypeId type = at.type;
  if (types.is_instance(type)) at.steps.push_back(step_to(ir::StepKind::kEnter));
  at.steps.push_back(step_to(ir::StepKind::kMember, member));
  at.type = types[type].members[member].type;
  return at;
}

}  // namespace

void GivenValues::take_back(const ir::Place& at, ir::TypeId type, ir::ConstId given) {
  set(at, type, given, {});
}

void GivenValues::write(const ir::Place& at, ir::TypeId type, ir::ConstId given) {
  set(at, type, given, given);
}

// All that `listed` lists, with the value that `values` has for it, or else its type.
void GivenValues::set(const ir::Place& at, ir::TypeId id, ir::ConstId listed, ir::ConstId values) {
  const ir::Type type = types()[id];
  if (type.kind == ir::Kind::kArray) {
    StartCode start = ask<StartCode>();
    if (listed == values || !values.valid()) {
      return start.each_element(at, id, listed, [&](const ir::Place& one, ir::ConstId value) {
        set(one, type.base, value, values.valid() ? value : ir::ConstId());
      });
    }
    uint64_t total = 1;
    for (const ir::Dimension& dim : type.dims) total *= dim.count();
    for (uint64_t i = 0; i < total; ++i) {
      set(StartCode::element(at, type, i), type.base, ask<Constants>().listed(listed, i),
          ask<Constants>().listed(values, i));
    }
    return;
  }
  const PouInfo* block = sema_.declared.pou_of(id);
  if (block != nullptr) ask<Arguments>().hold(*block);  // values of its declarations
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::ConstId member = ask<Constants>().listed(listed, i);
    if (!member.valid()) continue;
    const ir::ConstId value = ask<Constants>().listed(values, i);
    set_member(member_of(types(), at, i), type.members[i], member,
               value.valid() ? value : type.members[i].init);
  }
}

void GivenValues::set_member(const ir::Place& at, const ir::Member& member, ir::ConstId listed,
                             ir::ConstId values) {
  const bool located = member.address.area != ir::DirectArea::kNone;
  if (!ir::is_listed(member) || member.constant || member.retain || located) return;
  if (ir::holds_instance(types(), at.type)) return set(at, at.type, listed, values);
  if (sema_.start_values.inside(at.type, listed) || sema_.start_values.inside(at.type, values)) {
    return;
  }
  if (!types().is_scalar(at.type)) return build_.init(at, values);
  if (!values.valid()) values = types()[at.type].init;
  const uint64_t bits = values.valid() ? sema_.program.constants[values].bits : 0;
  build_.store(at, scalar(at.type), build_.constant(scalar(at.type), bits));
}

void GivenValues::find_inner(const ir::Place& at, ir::TypeId id, ir::ConstId given) {
  if (!given.valid() || !ask<Objects>().constructs(id)) return;
  const ir::Type type = types()[id];
  if (type.kind == ir::Kind::kArray) {
    const PouInfo* element = sema_.declared.pou_of(type.base);
    if (element != nullptr && element->stamp.valid()) return remember_each(at, *element, id, given);
    uint64_t total = 1;
    for (const ir::Dimension& dim : type.dims) total *= dim.count();
    for (uint64_t i = 0; i < total; ++i) {
      find_inner(StartCode::element(at, type, i), type.base, ask<Constants>().listed(given, i));
    }
    return;
  }
  const PouInfo* block = sema_.declared.pou_of(id);
  if (block != nullptr && block->stamp.valid()) return remember(at, *block, id, given);
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    if (!ir::is_listed(member) || member.retain) continue;
    find_inner(member_of(types(), at, i), member.type, ask<Constants>().listed(given, i));
  }
}

void GivenValues::remember(const ir::Place& at, const PouInfo& block, ir::TypeId type,
                           ir::ConstId given) {
  StartCode start = ask<StartCode>();
  const ir::ValueId fresh = start.is_new(at, block);
  inner_.push_back({at, type, given, temporary_place(elementary(ir::Kind::kBool))});
  build_.store(inner_.back().fresh, ir::Scalar::kBool, fresh);
  start.when(fresh, [&] { take_back(at, type, given); });
}

// An array of them has an array of BOOL, so that a loop does for elements that are alike.
void GivenValues::remember_each(const ir::Place& at, const PouInfo& element, ir::TypeId id,
                                ir::ConstId given) {
  const ir::Type type = types()[id];
  const ir::TypeId flags =
      sema_.program.types.array(elementary(ir::Kind::kBool), std::vector(type.dims));
  inner_.push_back({at, id, given, temporary_place(flags)});
  StartCode start = ask<StartCode>();
  start.each_element(at, id, given, [&](const ir::Place& one, ir::ConstId value) {
    const ir::ValueId fresh = start.is_new(one, element);
    build_.store(flag_of(inner_.back(), one), ir::Scalar::kBool, fresh);
    start.when(fresh, [&] { take_back(one, type.base, value); });
  });
}

// The flag of an element has the same indices.
ir::Place GivenValues::flag_of(const Inner& array, const ir::Place& element) const {
  ir::Place flag = array.fresh;
  for (size_t i = array.at.steps.size(); i < element.steps.size(); ++i) {
    flag.steps.push_back(element.steps[i]);
  }
  flag.type = elementary(ir::Kind::kBool);
  return flag;
}

void GivenValues::write_inner() {
  for (const Inner& one : inner_) {
    if (types()[one.type].kind == ir::Kind::kArray) {
      StartCode start = ask<StartCode>();
      const ir::TypeId base = types()[one.type].base;
      start.each_element(one.at, one.type, one.given,
                         [&](const ir::Place& element, ir::ConstId value) {
                           start.when(build_.load(flag_of(one, element), ir::Scalar::kBool),
                                      [&] { write(element, base, value); });
                         });
      continue;
    }
    ask<StartCode>().when(build_.load(one.fresh, ir::Scalar::kBool),
                          [&] { write(one.at, one.type, one.given); });
  }
  inner_.clear();
}

}  // namespace frontend
