// `fb1 := fb2` (codesys, twincat): the values of all variables, those of inner instances too. What
// a reference leads to is not copied, nor are in-outs, constants and what stands at an address.
#include <algorithm>

#include "frontend/lower/assignments.h"
#include "frontend/lower/start_code.h"
#include "ir/types/parts.h"

namespace frontend {

void Assignments::copy_held(const ir::Place& to, const ir::Place& from, ir::TypeId id) {
  if (types().is_scalar(id)) {
    return build_.store(to, scalar(id), build_.load(from, scalar(id)));
  }
  if (!ir::holds_instance(types(), id)) return build_.copy(to, from);
  // A block that contains itself is an error, which has been told.
  if (std::find(copied_.begin(), copied_.end(), id) != copied_.end()) return;
  copied_.push_back(id);
  copy_parts(to, from, id);
  copied_.pop_back();
}

void Assignments::copy_parts(const ir::Place& to, const ir::Place& from, ir::TypeId id) {
  const ir::Type type = types()[id];
  if (type.kind == ir::Kind::kArray) {
    return ask<StartCode>().each_element(to, id, {}, [&](const ir::Place& one, ir::ConstId) {
      ir::Place other = from;
      for (size_t i = to.steps.size(); i < one.steps.size(); ++i) {
        other.steps.push_back(one.steps[i]);
      }
      other.type = one.type;
      copy_held(one, other, type.base);
    });
  }
  const bool instance = types().is_instance(id);
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    const bool kept = member.section == ir::Section::kInOut ||
                      member.section == ir::Section::kStamp || member.constant ||
                      member.address.area != ir::DirectArea::kNone;
    if (instance && kept) continue;
    ir::Place inner = to;
    ir::Place outer = from;
    for (ir::Place* place : {&inner, &outer}) {
      if (instance) place->steps.push_back(step_to(ir::StepKind::kEnter));
      place->steps.push_back(step_to(ir::StepKind::kMember, i));
      place->type = member.type;
    }
    copy_held(inner, outer, member.type);
  }
}

}  // namespace frontend
