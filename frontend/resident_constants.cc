// Constants of bodies: each body's lie side by side, in the order in which bodies are lowered. When
// an edited body has more of them or fewer, those of the bodies after it move.
#include <algorithm>

#include "frontend/resident_parts.h"

namespace frontend {

Resident::Values Resident::constants_between(uint32_t first, uint32_t end) const {
  Values values;
  for (uint32_t i = first; i < end; ++i) {
    values.push_back(sema_->program.constants[ir::ConstId(i)]);
  }
  return values;
}

// From number `first` on; the table has `size` in the end, which is not less than it has values.
void Resident::set_constants(uint32_t first, const Values& values, uint32_t size) {
  ir::ConstTable& constants = sema_->program.constants;
  constants.set_next(first);
  for (const ir::ConstValue& value : values) constants.add(value);
  constants.set_next(constants.size());
  if (constants.size() == size) return;
  ir::ConstTable fewer;
  for (uint32_t i = 0; i < size; ++i) fewer.add(constants[ir::ConstId(i)]);
  constants = std::move(fewer);
}

// Does nothing but code name constants that come with this body, or later?
bool Resident::may_move_constants(uint32_t pou) const {
  const uint32_t first = bodies_[pou].first_constant;
  const auto before = [first](ir::ConstId id) { return !id.valid() || id.index < first; };
  const ir::Program& program = sema_->program;
  for (uint32_t number = pou; number < bodies_.size(); ++number) {
    Sizes with_types = bodies_[number].before;
    with_types.types = bodies_[number].behind.types;
    if (with_types != bodies_[number].behind) return false;
  }
  for (uint32_t i = 0; i < program.types.size(); ++i) {
    const ir::Type& type = program.types[ir::TypeId(i)];
    const auto is_before = [&](const ir::Member& member) { return before(member.init); };
    if (!before(type.init)) return false;
    if (!std::all_of(type.members.begin(), type.members.end(), is_before)) return false;
  }
  const auto starts_before = [&](const ir::ProgramInstance& row) { return before(row.init); };
  return std::all_of(program.instances.begin(), program.instances.end(), starts_before) &&
         std::all_of(sema_->declared.variables.begin(), sema_->declared.variables.end(),
                     [&](const Variable& variable) { return before(variable.init); }) &&
         std::all_of(sema_->facts.specs.begin(), sema_->facts.specs.end(),
                     [&](const SpecInfo& spec) { return before(spec.use.init); }) &&
         std::none_of(sema_->declared.pous.begin(), sema_->declared.pous.end(),
                      [](const PouInfo& info) { return info.meaning != nullptr; });
}

// Replaces the constants of one body; the records of the bodies after it follow.
void Resident::replace_constants(uint32_t pou, Values values) {
  BodyRecord& record = bodies_[pou];
  const ir::ConstTable& constants = sema_->program.constants;
  const uint32_t old_end = record.end_constant;
  record.end_constant = record.first_constant + static_cast<uint32_t>(values.size());
  if (record.end_constant == old_end) {
    return set_constants(record.first_constant, values, constants.size());
  }
  Values behind = constants_between(old_end, constants.size());
  for (ir::ConstValue& value : behind) {
    values.push_back(std::move(value));
  }
  const size_t size = record.first_constant + values.size();
  set_constants(record.first_constant, values, static_cast<uint32_t>(size));
  for (uint32_t number = pou + 1; number < bodies_.size(); ++number) {
    if (!sema_->declared.pous[number].id.valid()) continue;
    bodies_[number].first_constant += record.end_constant - old_end;
    bodies_[number].end_constant += record.end_constant - old_end;
  }
}

}  // namespace frontend
