#include "online_change/store/retained_migrations.h"

#include <algorithm>
#include <cstring>

#include "online_change/apply/migrator.h"

namespace online_change {
namespace {

// Retained values at their places in data memory.
void put(const ir::Image& image, base::ByteSpan values, uint8_t* memory) {
  for (const ir::RetainRange& range : image.retain) {
    std::memcpy(memory + range.data, values.data(), range.size);
    values = values.subspan(range.size);
  }
}

}  // namespace

RetainedMigrations::RetainedMigrations(const Migrations& migrations, const ir::Image& from,
                                       const ir::Image& to, const ir::VerifiedImage& code)
    : migrations_(migrations),
      from_(from),
      to_(to),
      code_(code),
      from_map_(from),
      to_map_(to),
      calls_(plan_, migrations_, from, code.image()) {}

void RetainedMigrations::add(const DiffOp& op, uint32_t id, uint32_t old_area, uint32_t new_area) {
  for (uint32_t i = 0; i < op.count && !migrations_.error(); ++i) {
    const uint64_t to = uint64_t{new_area} + op.to + uint64_t{i} * op.to_stride;
    if (!to_map_.find(to, op.size)) continue;
    plan_.steps.push_back(calls_.step(op, i, id, old_area, new_area, kNoFate));
  }
}

void RetainedMigrations::failed(const std::string& why) {
  if (failures_++ == 0) first_failure_ = why;
}

bool RetainedMigrations::readable(const MigrationCall& call) const {
  return std::all_of(call.inputs.begin(), call.inputs.end(), [&](const MigrationInput& input) {
    return from_map_.find(input.from, from_.layouts[input.type].size).has_value();
  });
}

void RetainedMigrations::leave_out_unreadable() {
  std::vector<uint32_t> number(plan_.calls.size(), kNoFate);
  std::vector<MigrationCall> calls;
  for (size_t i = 0; i < plan_.calls.size(); ++i) {
    MigrationCall& call = plan_.calls[i];
    if (readable(call)) {
      number[i] = static_cast<uint32_t>(calls.size());
      calls.push_back(std::move(call));
      continue;
    }
    const uint32_t pou = code_.image().migrations[call.row].pou;
    failed("`" + code_.image().pous[pou].name + "` for " + place_of(call, to_) +
           " reads what is not retained: declare it RETAIN, or change online");
  }
  std::erase_if(plan_.steps, [&](UpdateStep& step) {
    uint32_t& call = step.as<GivenValue>()->call;
    call = number[call];
    return call == kNoFate;
  });
  plan_.calls = std::move(calls);
}

std::string RetainedMigrations::run(base::ByteSpan values, base::ByteSpan as_changed,
                                    base::Bytes& out) {
  if (migrations_.error()) failed(migrations_.error()->text);
  leave_out_unreadable();
  if (!plan_.calls.empty()) {
    if (const std::string why = run_on(values, as_changed, out); !why.empty()) failed(why);
  }
  if (failures_ == 0) return {};
  std::string alarm = "migrations of retained values: " + first_failure_;
  if (failures_ > 1) alarm += ", and " + std::to_string(failures_ - 1) + " more";
  return alarm + "; what they make is " +
         (as_changed.empty() ? "initialised" : "as it was before the trial");
}

std::string RetainedMigrations::run_on(base::ByteSpan values, base::ByteSpan as_changed,
                                       base::Bytes& out) {
  base::Result<vm::Memory> memory = vm::Memory::reserve();
  if (!memory.ok()) return base::to_string(memory.error());
  const auto code = vm::Generation::build(code_, 0, memory->data());
  auto made = Migrator::make(plan_, from_, to_, *code);
  if (!made.ok()) return base::to_string(made.error());
  Migrator& migrate = **made;
  if (!as_changed.empty()) {
    put(from_, as_changed, memory->data());
    migrate.note(memory->data());
  }
  put(from_, values, memory->data());
  migrate.gather(0, SIZE_MAX, memory->data());
  (void)migrate.run_gathered([&](const base::Error& error) { failed(error.text); }).ok();
  for (const UpdateStep& step : plan_.steps) {
    const std::optional<size_t> at = to_map_.find(step.to, step.size);
    const base::Bytes& value = step.as<GivenValue>()->made;
    if (!at || value.size() != step.size) continue;
    std::copy(value.begin(), value.end(), out.begin() + static_cast<std::ptrdiff_t>(*at));
  }
  return {};
}

}  // namespace online_change
