#include "linker/translate.h"

#include <algorithm>

#include "ir/types/member_finder.h"

namespace linker {
namespace {

using ir::ConstId;
using ir::Kind;
using ir::Type;
using ir::TypeId;

constexpr uint32_t kGone = 0xffffffffu;

std::string anonymous_key(const ir::TypeTable& types, TypeId id) {
  return std::to_string(static_cast<uint32_t>(types[id].kind)) + ir::fold_name(types.text(id));
}

}  // namespace

const ir::Pou* Parameters::find(const std::string& pou) const {
  const auto found = names.find(ir::fold_name(pou));
  return found == names.end() ? nullptr : &program.pous[found->second.index];
}

Translator::Translator(const ir::Program& from, ir::Program& to, bool copied, Checks checks)
    : from_(from), to_(to), copied_(copied), checks_(std::move(checks)), types_(from.types.size()) {
  for (uint32_t i = ir::kElementaryCount; i < to.types.size(); ++i) {
    const Type& type = to.types[TypeId(i)];
    if (type.kind == Kind::kGlobals) continue;
    if (type.name.empty()) {
      anonymous_.try_emplace(anonymous_key(to.types, TypeId(i)), TypeId(i));
    } else {
      declared_.try_emplace(ir::fold_name(type.name), TypeId(i));
    }
  }
}

TypeId Translator::type(TypeId id) {
  if (!id.valid() || id.index < ir::kElementaryCount) return id;
  if (types_[id.index].valid()) return types_[id.index];
  const Type& type = from_.types[id];
  if (type.kind == Kind::kGlobals) return types_[id.index] = to_.globals;
  return type.name.empty() ? anonymous(id) : declared(id);
}

TypeId Translator::declared(TypeId id) {
  const Type& type = from_.types[id];
  const auto found = declared_.find(ir::fold_name(type.name));
  if (found == declared_.end()) {
    fail("the type `" + type.name + "`, which is not there");
    return types_[id.index] = to_.types.elementary(Kind::kByte);
  }
  types_[id.index] = found->second;
  const bool other_kind = to_.types[found->second].kind != type.kind;
  if (other_kind || checks_.other_type(type))
    fail("the type `" + type.name + "`, which is another one there");
  ask_for_parts(type);
  return found->second;
}

// What a type is made of must be there as well. It has its number by now, so it may lead back.
void Translator::ask_for_parts(const Type& type) {
  (void)this->type(type.base);
  for (const ir::Member& member : type.members) (void)this->type(member.type);
  for (const TypeId interface : type.interfaces) (void)this->type(interface);
}

TypeId Translator::anonymous(TypeId id) {
  const auto [found, added] = anonymous_.try_emplace(anonymous_key(from_.types, id), TypeId());
  if (!added && found->second.valid()) {
    types_[id.index] = found->second;
    ask_for_parts(from_.types[id]);
    return types_[id.index];
  }
  // A reference may lead back to itself: it has its number before its parts have theirs.
  Type copy;
  copy.kind = from_.types[id].kind;
  const TypeId there = to_.types.declare(copy);
  found->second = types_[id.index] = there;
  copy = from_.types[id];
  copy.base = type(copy.base);
  for (ir::Member& member : copy.members) member = member_of(member);
  for (TypeId& interface : copy.interfaces) interface = type(interface);
  for (ir::EnumLiteral& literal : copy.literals) literal.old_name = rule(literal.old_name);
  copy.init = {};
  copy.old_name = rule(copy.old_name);
  to_.types.edit(there) = std::move(copy);
  unsettled_.push_back(id);
  if (settled_) settle();
  return there;
}

void Translator::settle() {
  settled_ = true;
  while (!unsettled_.empty()) {
    const TypeId id = unsettled_.back();
    unsettled_.pop_back();
    give_initial_values(id);
  }
}

void Translator::give_initial_values(TypeId id) {
  const TypeId there = type(id);
  const Type& before = from_.types[id];
  for (size_t i = 0; i < before.members.size(); ++i) {
    const ConstId init = constant(before.members[i].type, before.members[i].init);
    to_.types.edit(there).members[i].init = init;
  }
  const ConstId init = constant(id, before.init);
  to_.types.edit(there).init = init;
}

std::optional<uint32_t> Translator::member(TypeId id, uint32_t number) {
  const auto [found, added] = members_.try_emplace(id.index);
  if (added) {
    ir::MemberFinder finder(to_.types, type(id));
    std::vector<uint32_t> numbers;
    for (const ir::Member& member : from_.types[id].members) {
      const std::optional<size_t> there = finder.find(member.name);
      numbers.push_back(there ? static_cast<uint32_t>(*there) : kGone);
    }
    members_[id.index] = std::move(numbers);
  }
  const std::vector<uint32_t>& numbers = members_[id.index];
  if (number >= numbers.size() || numbers[number] == kGone) return std::nullopt;
  return numbers[number];
}

ConstId Translator::constant(TypeId id, ConstId value) {
  if (!value.valid() || !from_.types.contains(id)) return ConstId();
  const uint64_t key = uint64_t{id.index} << 32 | value.index;
  if (const auto known = constants_.find(key); known != constants_.end()) return known->second;
  ir::ConstValue content = from_.constants[value];
  const bool members = from_.types.has_members(id);
  std::vector<ir::ConstElement> elements;
  for (ir::ConstElement element : content.elements) {
    TypeId part = from_.types[id].base;
    if (members) {
      if (element.first >= from_.types[id].members.size()) continue;
      part = from_.types[id].members[element.first].type;
      const std::optional<uint32_t> there = member(id, element.first);
      if (!there) continue;
      element.first = *there;
    }
    element.value = constant(part, element.value);
    elements.push_back(element);
  }
  const auto same = [](const ir::ConstElement& a, const ir::ConstElement& b) {
    return a.first == b.first && a.count == b.count && a.value == b.value;
  };
  const bool unchanged = std::equal(elements.begin(), elements.end(), content.elements.begin(),
                                    content.elements.end(), same);
  if (copied_ && unchanged) return constants_[key] = value;
  content.elements = std::move(elements);
  return constants_[key] = to_.constants.add(std::move(content));
}

ir::OldNameId Translator::rule(ir::OldNameId rule) {
  return rule.valid() ? to_.types.add_old_name(from_.types.old_name(rule)) : rule;
}

ir::Member Translator::member_of(const ir::Member& member) {
  ir::Member there = member;
  there.type = type(member.type);
  there.init = {};
  there.old_name = rule(member.old_name);
  return there;
}

ir::Steps Translator::steps(ir::Region root, const ir::Steps& steps) {
  ir::Steps there;
  ir::Region at = root;
  for (ir::Step step : steps) {
    const Type& type = from_.types[at.type];
    if (step.kind == ir::StepKind::kMember) {
      const ir::Member& member = type.members[step.index];
      const std::optional<uint32_t> number = this->member(at.type, step.index);
      if (!number) {
        fail("`" + member.name + "`, which is not there");
      } else if (to_.types[this->type(at.type)].members[*number].type != this->type(member.type) ||
                 (type.kind == Kind::kGlobals && checks_.other_global(member))) {
        fail("`" + member.name + "`, which is another one there");
      }
      at = {member.type, 0};
      step.index = number.value_or(0);
    } else {
      ++at.dim;
      const bool whole = at.dim == type.dims.size() && !from_.types.is_instance(type.base);
      if (whole) at = {type.base, 0};
    }
    there.push_back(step);
  }
  return there;
}

void Translator::parameter(ir::Slot& slot, const ir::Object& object, const Parameters& from,
                           const Parameters& to) {
  const std::string& name = object.callees[slot.callee];
  const ir::Pou* const before = from.find(name);
  const ir::Pou* const now = to.find(name);
  if (before == nullptr || now == nullptr || slot.param >= before->locals.size()) {
    return fail("`" + name + "`, which is not there");
  }
  const ir::Local& parameter = before->locals[slot.param];
  for (uint32_t i = 0; i < now->locals.size(); ++i) {
    const ir::Local& there = now->locals[i];
    if (!ir::same_name(there.name, parameter.name)) continue;
    if (there.kind != parameter.kind || there.type != type(parameter.type)) break;
    slot.param = i;
    return;
  }
  fail("`" + parameter.name + "` of `" + name + "`, which has another interface");
}

ir::Object Translator::object(const ir::Object& object, const Parameters& from,
                              const Parameters& to) {
  ir::Object there = object;
  there.self = type(object.self);
  for (ir::Slot& slot : there.slots) {
    slot.region = region(slot.region);
    if (slot.kind == ir::SlotKind::kArg) parameter(slot, object, from, to);
  }
  for (ir::ObjectPlace& place : there.places) {
    ir::Region root = place.region;
    if (place.root == ir::PlaceRoot::kSelf) root = {object.self, 0};
    if (place.root == ir::PlaceRoot::kGlobal) root = {from_.globals, 0};
    if (place.root == ir::PlaceRoot::kSlot) root = object.slots[place.slot].region;
    if (place.root != ir::PlaceRoot::kFixed) place.steps = steps(root, place.steps);
    place.region = region(place.region);
    place.result = region(place.result);
  }
  for (ir::ObjectConstant& constant : there.constants) {
    if (!constant.type.valid()) continue;
    constant.value = this->constant(constant.type, constant.value);
    constant.type = type(constant.type);
  }
  for (ir::Region& row : there.regions) row = region(row);
  for (ir::Bound& bound : there.bounds) bound.array = type(bound.array);
  for (const std::string& callee : there.callees) check_interface(callee, from, to);
  return there;
}

// All inputs of a callee are given at each call, so it must not have more than it had.
void Translator::check_interface(const std::string& callee, const Parameters& from,
                                 const Parameters& to) {
  const ir::Pou* const before = from.find(callee);
  const ir::Pou* const now = to.find(callee);
  if (before == nullptr || now == nullptr) return fail("`" + callee + "`, which is not there");
  if (before->kind != now->kind || before->locals.size() != now->locals.size()) {
    fail("`" + callee + "`, which has another interface");
  }
}

}  // namespace linker
