// stvm status: what runs there.
#include <algorithm>
#include <cstdio>

#include "ir/bytecode/no_program.h"
#include "ir/bytecode/verify.h"
#include "tools/common/exit.h"
#include "tools/common/fate_report.h"
#include "tools/common/json.h"
#include "tools/common/table.h"
#include "tools/stvm/activity_text.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/event_text.h"
#include "tools/stvm/times_text.h"
#include "tools/stvm/trap_text.h"
#include "tools/stvm/units.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kStatusOptions[] = {
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION,
    {"--activity", nullptr, "what tasks are doing at this instant, and how their buffers stand"},
    {"--units", nullptr,
     "the table of units (of those named, or of all): identities, slots, what is edited; and what "
     "the controller can do"},
    {"--task", "NAME", "histograms of a task: run times, and delays of its start"},
    {"--reset-times", nullptr, "the controller forgets how long scans took and began late"}};
constexpr tools::Command kStatusCommand{
    "status", "[UNIT...]", "Shows what a controller runs and how it is.", kStatusOptions, 0};

bool on_trial(const vm::StatusReport& report) { return report.edits != 0; }

// The report has what is accepted (D4).
const base::Digest& boots_next(const vm::StatusReport& report) {
  return report.last_edit_boots ? report.running : report.boots_next;
}

void print_tier(const vm::StatusReport& report) {
  if (report.pous_to_make != 0) {
    std::printf(
        "  code        interpreted; machine code of %llu of %llu POUs is still to be made\n",
        static_cast<unsigned long long>(report.pous_to_make),
        static_cast<unsigned long long>(report.pous));
    return;
  }
  if (report.native_pous == 0) {
    std::printf("  code        interpreted\n");
    return;
  }
  std::printf("  code        native, %llu of %llu POUs, %llu bytes\n",
              static_cast<unsigned long long>(report.native_pous),
              static_cast<unsigned long long>(report.pous),
              static_cast<unsigned long long>(report.native_bytes));
  for (const std::string& pou : report.interpreted) {
    std::printf("              interpreted: %s\n", pou.c_str());
  }
}

void print_versions(const vm::StatusReport& report, bool undone) {
  const char* state = report.faulted ? "FAULT" : on_trial(report) ? "running, on trial" : "running";
  std::printf("%s: %s\n", report.name.c_str(), state);
  if (report.running == ir::no_program().digest()) {
    std::printf("  `stvm change SOURCES|IMAGE` brings a program\n");
  } else if (report.faulted) {
    std::printf(
        "  `stvm restart` runs it again: RETAIN keeps its values, all else begins anew\n"
        "  `stvm restart --hot` goes on with all values as they are\n"
        "  %s\n",
        on_trial(report)
            ? "`stvm undo` brings back the program before, and its values"
            : "`stvm change` or `stvm revert` goes on with another program and the values");
    if (undone) std::printf("  `stvm redo` brings the edit again that was undone\n");
  }
  std::printf("  running     %s\n", base::short_hex(report.running).c_str());
  if (on_trial(report)) {
    std::printf("  undo brings %s\n", base::short_hex(report.previous).c_str());
  }
  std::printf("  boots next  %s\n", base::short_hex(boots_next(report)).c_str());
  if (report.trial_lost != base::Digest{}) {
    std::printf("  trial lost  %s; the controller ended before it was accepted\n",
                base::short_hex(report.trial_lost).c_str());
  }
  const std::string by = report.changed_by.empty() ? "" : ", by " + report.changed_by;
  std::printf("  change      %s%s\n", report.change.c_str(),
              report.change == "idle" ? "" : by.c_str());
  if (on_trial(report)) {
    std::printf("  on trial    %llu edit(s) (stvm edits)\n",
                static_cast<unsigned long long>(report.edits));
    if (!report.watched_by.empty()) {
      std::printf("  watched     by %s; taken back in %s unless accepted\n",
                  report.watched_by.c_str(),
                  age_text(std::max<int64_t>(report.watch_left_ns, 0)).c_str());
    }
    std::printf("  power loss  %s\n",
                report.last_edit_boots
                    ? "they go on, with their ways back ([change] boots = \"last-edit\")"
                    : "they are lost, and what boots next runs ([change] boots = \"accepted\")");
  }
  if (!report.aborted.empty()) std::printf("  aborted     %s\n", report.aborted.c_str());
  std::printf("  cycles      %llu of %s\n", static_cast<unsigned long long>(report.cycles),
              tools::duration(report.base_period_ns).c_str());
  std::printf("  forces      %llu", static_cast<unsigned long long>(report.forces));
  if (report.boundary_forces != 0) {
    std::printf(", %llu at the boundaries of cycles (stvm get --forces)",
                static_cast<unsigned long long>(report.boundary_forces));
  }
  std::printf("\n");
  print_tier(report);
  std::printf("\n");
}

// What is left for changes, in bytes.
void print_memory(const vm::MemoryReport& memory) {
  tools::Table table({"memory", "> areas", "> used", "> slack"});
  auto row = [&](const char* name, const vm::AreaRoom& room) {
    table.row(
        {name, std::to_string(room.areas), std::to_string(room.used), std::to_string(room.slack)});
  };
  row("globals", memory.globals);
  row("programs", memory.programs);
  row("instances", memory.instances);
  std::printf("%sfree %llu of %llu bytes, %llu in one piece\n\n", table.text().c_str(),
              static_cast<unsigned long long>(memory.free),
              static_cast<unsigned long long>(memory.capacity),
              static_cast<unsigned long long>(memory.largest_free));
}

void room_json(tools::JsonWriter& json, const char* name, const vm::AreaRoom& room) {
  json.key(name).begin_object().field("areas", room.areas).field("used", room.used);
  json.field("slack", room.slack).end_object();
}

void memory_json(tools::JsonWriter& json, const vm::MemoryReport& memory) {
  json.key("memory").begin_object().field("capacity", memory.capacity);
  json.field("free", memory.free).field("largest_free", memory.largest_free);
  room_json(json, "globals", memory.globals);
  room_json(json, "programs", memory.programs);
  room_json(json, "instances", memory.instances);
  json.end_object();
}

void print_devices(const std::vector<vm::DeviceStatus>& devices) {
  if (devices.empty()) return;
  tools::Table table({"device", "driver", "state", "> exchanges", "> errors", "> age"});
  for (const vm::DeviceStatus& device : devices) {
    table.row({device.name, device.driver, device.state, std::to_string(device.exchanges),
               std::to_string(device.errors),
               device.age_ns < 0 ? "never" : tools::duration(device.age_ns)});
  }
  std::printf("\n%s", table.text().c_str());
  for (const vm::DeviceStatus& device : devices) {
    if (device.error.empty()) continue;
    const std::string age =
        device.error_age_ns < 0 ? "" : ", " + age_text(device.error_age_ns) + " ago";
    std::printf("last error of %s%s: %s\n", device.name.c_str(), age.c_str(), device.error.c_str());
  }
  for (const vm::DeviceStatus& device : devices) {
    if (device.writes == 0) continue;
    std::printf("others wrote to %s: %llu times, last %s\n", device.name.c_str(),
                static_cast<unsigned long long>(device.writes), device.last_writer.c_str());
  }
}

void device_json(tools::JsonWriter& json, const vm::DeviceStatus& device) {
  json.begin_object().field("name", device.name).field("driver", device.driver);
  json.field("state", device.state).field("exchanges", device.exchanges);
  json.field("errors", device.errors).field("age_ns", device.age_ns);
  json.field("error", device.error).field("error_age_ns", device.error_age_ns);
  json.field("writes", device.writes);
  json.field("last_writer", device.last_writer).end_object();
}

std::string period_text(const vm::TaskStatus& task) {
  if (task.once) return "once";
  if (task.freewheeling) return "free";
  return task.period_ns == 0 ? "event" : tools::duration(task.period_ns);
}

std::string state_text(const vm::TaskStatus& task) {
  if (task.stopped) return "stopped";
  return task.overruns == 0 ? "ok" : "overran";
}

// `undone`: there is an edit that redo brings again.
void print_status_text(const vm::StatusReport& report, bool undone) {
  print_versions(report, undone);
  print_memory(report.memory);
  tools::Table tasks({"task", "> period", "> prio", "> scans", "> missed", "> average", "> p99",
                      "> longest", "> delay", "state"});
  for (const vm::TaskStatus& task : report.tasks) {
    tasks.row({task.name, period_text(task), std::to_string(task.priority),
               std::to_string(task.scans), std::to_string(task.missed),
               tools::duration(task.run.average), tools::duration(task.run.p99),
               tools::duration(task.run.max), tools::duration(task.delay.p99), state_text(task)});
  }
  std::fputs(tasks.text().c_str(), stdout);
  print_devices(report.devices);
  for (const std::string& alarm : report.alarms) std::printf("alarm: %s\n", alarm.c_str());
  for (const vm::TrapRow& trap : report.traps) std::printf("trap: %s\n", trap_text(trap).c_str());
}

void summary_json(tools::JsonWriter& json, const char* name, const vm::TimeSummary& times) {
  json.key(name).begin_object().field("min", times.min).field("average", times.average);
  json.field("p99", times.p99).field("max", times.max).end_object();
}

void task_json(tools::JsonWriter& json, const vm::TaskStatus& task) {
  json.begin_object().field("name", task.name).field("period_ns", task.period_ns);
  json.field("priority", task.priority).field("scans", task.scans).field("missed", task.missed);
  json.field("overruns", task.overruns).field("last_ns", task.last_ns);
  json.field("recent_longest_ns", task.recent_ns);
  summary_json(json, "run_ns", task.run);
  summary_json(json, "start_delay_ns", task.delay);
  json.field("stopped", task.stopped);
  activity_json(json, task.activity);
  json.end_object();
}

void print_status_json(const vm::StatusReport& report) {
  tools::JsonWriter json;
  json.begin_object().field("name", report.name);
  json.field("running", base::to_hex(report.running)).field("edition", report.edition);
  json.field("change", report.change).field("changed_by", report.changed_by);
  json.field("aborted", report.aborted).field("trial", on_trial(report));
  json.field("edits", report.edits).field("last_edit_boots", report.last_edit_boots);
  if (on_trial(report)) json.field("undo_brings", base::to_hex(report.previous));
  if (!report.watched_by.empty()) {
    json.field("watched_by", report.watched_by).field("watch_left_ns", report.watch_left_ns);
  }
  json.field("boots_next", base::to_hex(boots_next(report))).field("cycles", report.cycles);
  if (report.trial_lost != base::Digest{}) {
    json.field("trial_lost", base::to_hex(report.trial_lost));
  }
  json.key("alarms").begin_array();
  for (const std::string& alarm : report.alarms) json.value(alarm);
  json.end_array();
  json.field("uptime_ns", report.uptime_ns).field("base_period_ns", report.base_period_ns);
  json.field("faulted", report.faulted).field("forces", report.forces);
  json.field("boundary_forces", report.boundary_forces);
  json.field("pous", report.pous).field("native_pous", report.native_pous);
  json.field("native_bytes", report.native_bytes).field("pous_to_make", report.pous_to_make);
  json.key("interpreted").begin_array();
  for (const std::string& pou : report.interpreted) json.value(pou);
  json.end_array();
  memory_json(json, report.memory);
  json.key("tasks").begin_array();
  for (const vm::TaskStatus& task : report.tasks) task_json(json, task);
  json.end_array().key("devices").begin_array();
  for (const vm::DeviceStatus& device : report.devices) device_json(json, device);
  json.end_array().key("traps").begin_array();
  for (const vm::TrapRow& trap : report.traps) {
    json.begin_object().field("cycle", trap.cycle).field("task", trap.task);
    json.field("pou", trap.text.pou).field("file", trap.text.file).field("line", trap.text.line);
    json.field("text", trap.text.text).end_object();
  }
  json.end_array().end_object();
  std::fputs(json.finish().c_str(), stdout);
}

// The units of the version that ran when the command began.
base::Result<std::vector<UnitView>> look_at_units(const std::vector<std::string>& patterns,
                                                  ControllerClient& client) {
  base::Result<std::vector<UnitRow>> rows = client.units();
  if (!rows.ok()) return rows.error();
  base::Result<base::Bytes> bytes = client.image();
  if (!bytes.ok()) return bytes.error();
  base::Result<ir::VerifiedImage> running = ir::verify(std::move(*bytes));
  if (!running.ok()) return running.error();
  base::Result<std::vector<TrialEdit>> edits = client.edits();
  if (!edits.ok()) return edits.error();
  std::vector<EditStep> steps;
  for (TrialEdit& edit : *edits) {
    if (edit.undone) continue;
    base::Result<base::Bytes> before = client.image_before(edit.name);
    if (!before.ok()) return before.error();
    base::Result<ir::VerifiedImage> image = ir::verify(std::move(*before));
    if (!image.ok()) return image.error();
    steps.push_back({std::move(edit), ir::parts_of(image->image(), running->image().unit_members)});
  }
  return unit_views(*rows, running->image(), steps, patterns);
}

base::Status show_units(const std::vector<std::string>& patterns, bool json,
                        ControllerClient& client) {
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  base::Result<ControllerFacts> facts = client.facts();
  if (!facts.ok()) return facts.error();
  base::Result<std::vector<UnitView>> units = look_at_units(patterns, client);
  if (!units.ok()) return units.error();
  if (units->empty() && !patterns.empty()) {
    return base::Error{base::Refusal::kNoSuchVariable,
                       "no unit is called `" + patterns.front() + "`"};
  }
  if (json) {
    std::fputs(units_json(*units, *facts, *status).c_str(), stdout);
  } else {
    std::printf("%s\n%s", units_text(*units).c_str(), facts_text(*facts, *status).c_str());
  }
  return base::Ok{};
}

base::Status show(const tools::Options& options) {
  if (!options.arguments().empty() && !options.has("--units")) {
    return base::Error{base::Refusal::kUsage, "status: names of units go with --units"};
  }
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  if (options.has("--reset-times")) {
    base::Result<base::Bytes> reset = client->call({.command = vm::Command::kResetTimes});
    if (!reset.ok()) return reset.error();
  }
  if (options.has("--task")) {
    base::Result<vm::TaskTimes> times = client->task_times(options.text("--task"));
    if (!times.ok()) return times.error();
    std::fputs((*json ? times_json(*times) : times_text(*times)).c_str(), stdout);
    return base::Ok{};
  }
  if (options.has("--units")) return show_units(options.arguments(), *json, *client);
  base::Result<vm::StatusReport> report = client->status();
  if (!report.ok()) return report.error();
  if (options.has("--activity") && !*json) {
    std::fputs(activity_text(report->tasks).c_str(), stdout);
    return base::Ok{};
  }
  if (*json) {
    print_status_json(*report);
    return base::Ok{};
  }
  bool undone = false;
  if (report->faulted) {
    const base::Result<std::vector<TrialEdit>> edits = client->edits();
    undone = edits.ok() && std::ranges::any_of(*edits, &TrialEdit::undone);
  }
  print_status_text(*report, undone);
  return base::Ok{};
}

int run_status(const tools::Options& options) {
  base::Status shown = show(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kStatus{&kStatusCommand, run_status};

}  // namespace stvm
