// What is read and written of the running program's variables.
#include <algorithm>

#include "ir/bytecode/name_index.h"
#include "ir/bytecode/variable_names.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_text.h"

namespace stvm {
namespace {

base::Error other_version() { return {base::Refusal::kStaleBase, "another version runs now"}; }

using NamedValues = std::vector<vm::NamedValue>;

// Names become paths here: a force is kept by its path, which is the same after a change.
base::Result<std::vector<std::string>> paths_of(const ir::VerifiedImage& version,
                                                const vm::Request& request) {
  std::vector<std::string> paths;
  for (const std::string& name : request.names) {
    base::Result<ir::NamedSymbol> named = ir::named_symbol(version.names(), name);
    if (!named.ok()) return named.error();
    paths.push_back(std::move(named->path));
  }
  return paths;
}

base::Result<NamedValues> named_values(const ir::VerifiedImage& version,
                                       const vm::Request& request) {
  base::Result<std::vector<std::string>> paths = paths_of(version, request);
  if (!paths.ok()) return paths.error();
  NamedValues values;
  for (size_t i = 0; i < paths->size(); ++i) {
    values.push_back({std::move((*paths)[i]), request.values[i]});
  }
  return values;
}

std::string assignments_text(const NamedValues& values) {
  std::vector<std::string> rows;
  for (const vm::NamedValue& value : values) rows.push_back(value.path + "=" + value.value);
  return list_text(rows);
}

}  // namespace

base::Error ControllerService::too_long() {
  return {base::Refusal::kTooMany, "the answer is too long; ask for less"};
}

// A portion that found no time is tried again a cycle later.
base::Status ControllerService::copy_at_boundaries(const std::function<vm::Copied(int64_t)>& take) {
  for (;;) {
    vm::Copied copied = vm::Copied::kPart;
    base::Status taken =
        look_at_boundary([&] { copied = take(controller_.next_cycle_ns() - clock_.now_ns()); });
    if (!taken.ok()) return taken;
    if (copied == vm::Copied::kAll) return base::Ok{};
    if (copied == vm::Copied::kOtherProgram) return other_version();
    if (copied == vm::Copied::kLater) boundary_.pause(kBetweenAttemptsNs);
  }
}

base::Result<vm::LiveCopy> ControllerService::copy_of(std::vector<ir::DataRange> ranges) {
  auto copy = vm::LiveCopy::prepare(controller_, std::move(ranges));
  if (!copy.ok()) return copy.error();
  base::Status copied =
      copy_at_boundaries([&](int64_t free_ns) { return copy->take(controller_, free_ns); });
  if (!copied.ok()) return copied.error();
  return copy;
}

base::Result<base::Bytes> ControllerService::get(const vm::Request& request) {
  const ir::VerifiedImage version = controller_.verified();
  base::Result<const vm::AskedValues::Request*> asked = asked_.find(version, request.names);
  if (!asked.ok()) return asked.error();
  base::Result<vm::LiveCopy> copy = copy_of((*asked)->ranges);
  if (!copy.ok()) return copy.error();
  vm::Values values;
  values.cycle = copy->first_cycle();
  values.last_cycle = copy->last_cycle();
  size_t left = vm::kMaxMessageBytes;
  for (const vm::AskedValues::Variable& variable : (*asked)->variables) {
    const size_t room = std::min<size_t>(left, vm::kMaxNameBytes);
    std::string value =
        ir::format_value(version.image(), variable.named.symbol, copy->memory(), room);
    if (value.size() > room) return too_long();
    left -= value.size();
    values.rows.push_back({variable.named.path, variable.type, std::move(value)});
  }
  return vm::encode(values);
}

// All or none: a mistake in the last of several is found before the first is written.
base::Result<base::Bytes> ControllerService::set(const vm::Request& request) {
  base::Result<NamedValues> values = named_values(controller_.verified(), request);
  if (!values.ok()) return values.error();
  base::Result<vm::WriteSet> set = controller_.prepare_set(*values);
  if (!set.ok()) return set.error();
  if (set->values.empty()) return base::Bytes();
  vm::BoundaryShare share;
  base::Status taken = base::Ok{};
  vm::Copied written = vm::Copied::kLater;
  for (int attempt = 0; taken.ok() && written == vm::Copied::kLater; ++attempt) {
    if (attempt != 0) boundary_.pause(kBetweenAttemptsNs);
    taken = at_boundary([&] {
      const int64_t free_ns = controller_.next_cycle_ns() - clock_.now_ns();
      if (share.bytes(controller_, free_ns, set->work_bytes, true) == 0) return;
      written = controller_.write(*set) ? vm::Copied::kAll : vm::Copied::kOtherProgram;
    });
  }
  if (!taken.ok()) return taken.error();
  if (written == vm::Copied::kOtherProgram) return other_version();
  note_done(online_change::Event::kSet, who_, assignments_text(*values));
  return base::Bytes();
}

// The code for it is made here, beside the running program; the boundary only exchanges it.
base::Result<base::Bytes> ControllerService::force(const vm::Request& request) {
  base::Result<NamedValues> values = named_values(controller_.verified(), request);
  if (!values.ok()) return values.error();
  auto change = controller_.prepare_force(*values);
  if (!change.ok()) return change.error();
  base::Status taken = at_boundary([&] { controller_.use(**change); });
  if (!taken.ok()) return taken.error();
  note_done(online_change::Event::kForced, who_, assignments_text(*values));
  std::vector<std::string> paths;
  for (vm::NamedValue& row : *values) paths.push_back(std::move(row.path));
  return force_rows(paths);
}

base::Result<base::Bytes> ControllerService::unforce(const vm::Request& request) {
  base::Result<std::vector<std::string>> names = paths_of(controller_.verified(), request);
  if (!names.ok()) return names.error();
  if (names->empty()) {
    for (const vm::Force& force : controller_.forces()) names->push_back(force.path);
  }
  auto change = controller_.prepare_unforce(*names);
  if (!change.ok()) return change.error();
  base::Status taken = at_boundary([&] { controller_.use(**change); });
  if (!taken.ok()) return taken.error();
  if (names->empty()) return base::Bytes();  // nothing was forced
  note_done(online_change::Event::kUnforced, who_, list_text(*names));
  return base::Bytes();
}

base::Result<base::Bytes> ControllerService::forces(const vm::Request&) { return force_rows({}); }

// The forces of the variables with these names, or all. Only this thread's commands change forces,
// so they can be read here.
base::Bytes ControllerService::force_rows(const std::vector<std::string>& names) const {
  vm::ForceRows forces;
  const ir::Image& image = controller_.image();
  for (const vm::Force& force : controller_.forces()) {
    const bool wanted =
        names.empty() || std::find(names.begin(), names.end(), force.path) != names.end();
    if (!wanted) continue;
    forces.rows.push_back({force.path, image.types.text(force.symbol.type),
                           vm::value_text(image, force), force.reason});
  }
  return vm::encode(forces);
}

}  // namespace stvm
