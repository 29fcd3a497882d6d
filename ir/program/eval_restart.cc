#include "ir/program/eval_restart.h"

#include "ir/types/stamps.h"

namespace ir {
namespace {

// Values only: others point to the parts.
void assign(Variable& to, const Variable& from) {
  if (to.slot) return;
  to.bits = from.bits;
  to.bytes = from.bytes;
  for (size_t i = 0; i < to.parts.size(); ++i) assign(to.parts[i], from.parts[i]);
}

void for_each_leaf(Variable& variable, const std::function<void(Variable&)>& visit) {
  if (variable.slot) return;
  if (variable.parts.empty()) visit(variable);
  for (Variable& part : variable.parts) for_each_leaf(part, visit);
}

}  // namespace

// Visits members inside of others, too.
void EvalRestart::for_each_member(Variable& owner, const Visit& visit) {
  const bool members = program_.types.has_members(owner.type);
  for (size_t i = 0; i < owner.parts.size(); ++i) {
    Variable& part = owner.parts[i];
    if (members) visit(part, program_.types[owner.type].members[i]);
    if (!part.slot) for_each_member(part, visit);
  }
}

bool EvalRestart::mark_leaving() {
  bool any = false;
  const auto mark = [&any](Variable& stamp, const Member& member) {
    if (member.section != Section::kStamp || stamp.bits == kNewStamp) return;
    stamp.bits = kLeavingStamp;
    any = true;
  };
  for (Variable& instance : instances_) for_each_member(instance, mark);
  for (Variable& part : globals_.parts) {
    if (!part.slot) for_each_member(part, mark);  // the globals' own stamp is a flag
  }
  return any;
}

void EvalRestart::reset_area(Variable& area, ConstId init, bool warm) {
  struct Kept {
    Variable* variable;
    uint64_t bits;
    std::string bytes;
  };
  std::vector<Kept> kept;
  std::vector<Variable*> stamps;
  for_each_member(area, [&](Variable& part, const Member& member) {
    if (member.section == Section::kStamp) stamps.push_back(&part);
    if (!member.retain || !warm) return;
    for_each_leaf(part, [&](Variable& leaf) { kept.push_back({&leaf, leaf.bits, leaf.bytes}); });
  });
  assign(area, Variables(program_, &layouts_).make(area.type, init));
  for (Kept& each : kept) {
    each.variable->bits = each.bits;
    each.variable->bytes = std::move(each.bytes);
  }
  for (Variable* stamp : stamps) stamp->bits = kNewStamp;
}

void EvalRestart::reset(bool warm) {
  reset_area(globals_, {}, warm);
  for (size_t i = 0; i < instances_.size(); ++i) {
    reset_area(instances_[i], program_.instances[i].init, warm);
  }
}

}  // namespace ir
