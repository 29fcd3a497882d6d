#include "online_change/plan/migration_calls.h"

#include "ir/bytecode/symbols.h"
#include "online_change/plan/area_steps.h"

namespace online_change {

UpdateStep MigrationCalls::step(const DiffOp& op, uint32_t index, uint32_t instance, uint32_t from,
                                uint32_t to, uint32_t fate) {
  const Migration& migration = migrations_.rows()[op.migration.migration];
  const std::vector<ir::FrameSlot>& slots = code_.pous[code_.migrations[migration.row].pou].slots;
  UpdateStep step = step_for(op, to, fate);
  step.to += index * op.to_stride;
  step.count = 1;
  step.to_stride = 0;
  GivenValue how;
  how.call = call_for(op, instance, from + op.from + index * op.from_stride, step.to - op.within);
  how.slot = slots[migration.values[op.migration.value].slot].offset;
  how.type = op.new_type;
  step.how = std::move(how);
  return step;
}

// `from` and `to`: of the area, or of the structure.
uint32_t MigrationCalls::call_for(const DiffOp& op, uint32_t instance, uint32_t from, uint32_t to) {
  const uint32_t number = op.migration.migration;
  const auto [known, fresh] =
      here_.try_emplace({number, from}, static_cast<uint32_t>(plan_.calls.size()));
  if (!fresh) return known->second;
  const Migration& migration = migrations_.rows()[number];
  const std::vector<ir::FrameSlot>& slots = code_.pous[code_.migrations[migration.row].pou].slots;
  MigrationCall& call = plan_.calls.emplace_back();
  call.row = migration.row;
  call.instance = instance;
  if (ir::is_structure(from_.types[migration.from_type].kind)) {
    call.place = to;
    call.type = migration.to_type;
  }
  for (const MigratedValue& value : migration.values) {
    if (!value.input) continue;
    if (value.place != 0) {
      call.inputs.push_back({value.place, value.type, slots[value.slot].offset});
      continue;
    }
    call.inputs.push_back({from + from_.layouts[migration.from_type].member_offsets[value.member],
                           from_.types[migration.from_type].members[value.member].type,
                           slots[value.slot].offset});
  }
  return known->second;
}

std::string place_of(const MigrationCall& call, const ir::Image& to) {
  const std::string path =
      call.place == 0 ? to.instance_path(call.instance) : ir::path_of(to, {call.place, call.type});
  return path.empty() ? "the globals" : "`" + path + "`";
}

}  // namespace online_change
