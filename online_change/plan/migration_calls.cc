#include "online_change/plan/migration_calls.h"

#include "online_change/plan/area_steps.h"

namespace online_change {

UpdateStep MigrationCalls::step(const DiffOp& op, uint32_t instance, uint32_t from, uint32_t to,
                                uint32_t fate) {
  const Migration& migration = migrations_.rows()[op.from];
  const ir::LinkedMigration& row = code_.migrations[migration.row];
  const std::vector<ir::FrameSlot>& slots = code_.pous[row.pou].slots;
  const auto [known, fresh] = here_.try_emplace(op.from, static_cast<uint32_t>(plan_.calls.size()));
  if (fresh) {
    MigrationCall& call = plan_.calls.emplace_back();
    call.row = migration.row;
    call.instance = instance;
    for (const MigratedValue& value : migration.values) {
      if (!value.input) continue;
      call.inputs.push_back({from + from_.layouts[migration.from_type].member_offsets[value.member],
                             from_.types[migration.from_type].members[value.member].type,
                             slots[value.slot].offset});
    }
  }
  UpdateStep step = step_for(op, StepKind::kMigrate, from, to, fate);
  step.from = known->second;
  step.from_stride = slots[migration.values[op.from_stride].slot].offset;
  step.new_type = op.new_type;
  return step;
}

}  // namespace online_change
