#include "vm/runtime/controller.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "base/check.h"
#include "vm/runtime/boundary_watch.h"
#include "vm/runtime/live_copy.h"
#include "vm/runtime/native_maker.h"
#include "vm/runtime/scheduler.h"
#include "vm/runtime/stamp_ref.h"
#include "vm/runtime/summaries.h"
#include "vm/runtime/task_tables.h"

namespace vm {
struct Controller::Impl {
  Impl(const ControllerOptions& options, Clock& clock, IoPort& io, Memory reserved)
      : memory(std::move(reserved)),
        io_port(io),
        scheduler(options, clock, io),
        data_limit(options.data_limit),
        tier(options.tier),
        code_slots(std::make_shared<CodeSlots>(options.code_limit / sizeof(ir::Unit),
                                               options.code_slack_percent)) {}

  const ir::Image& image() const { return running->image(); }
  std::unique_ptr<ForceChange> prepare_forces(std::vector<Force> forces) const;
  void set_change_flag(bool changed);
  void reset_data(bool retain);
  base::Status leave(const std::vector<uint32_t>& ids, bool changed, int64_t limit_ns);
  base::Error last_trap(base::Refusal refusal) const;

  Memory memory;
  IoPort& io_port;
  Scheduler scheduler;
  uint64_t data_limit;
  TierOptions tier;
  std::shared_ptr<CodeSlots> code_slots;
  std::unique_ptr<Generation> running;
  // The tables of the running generation, and of one that is prepared or can come back by undo.
  std::map<const Generation*, std::unique_ptr<TaskTables>> tables;
  BoundaryWatch* watch = nullptr;
  NativeMaker native_maker;  // ends before the generation that it works on
};

Controller::Controller() = default;
Controller::~Controller() = default;
base::Result<std::unique_ptr<Controller>> Controller::start(const ir::VerifiedImage& image,
                                                            ControllerOptions options, Clock& clock,
                                                            IoPort& io, base::ByteSpan retained) {
  base::Result<Memory> memory = Memory::reserve();
  if (!memory.ok()) return memory.error();
  std::unique_ptr<Controller> controller(new Controller());
  controller->impl_ = std::make_unique<Impl>(options, clock, io, std::move(*memory));
  Impl& impl = *controller->impl_;
  write_initial_data(image.image(), impl.memory.data());
  if (!retained.empty()) write_retained(image.image(), retained, impl.memory.data());
  auto first = Generation::build(image, 0, impl.memory.data(), impl.code_slots, nullptr, impl.tier);
  if (!first.ok()) return first.error();
  impl.running = std::move(*first);
  impl.running->bools().normalise_all(impl.memory.data());  // whatever the files say
  if (base::Status devices = io.prepare(image); !devices.ok()) return devices.error();
  io.use(image.digest());
  auto tables = std::make_unique<TaskTables>(*impl.running, impl.scheduler.next_cycle_ns());
  impl.scheduler.use(*tables, impl.memory.data());
  options.halted ? impl.scheduler.fault() : impl.scheduler.run_start_tasks();
  if (!impl.scheduler.faulted()) io.publish_globals(tables->shared, impl.memory.data());
  impl.tables[impl.running.get()] = std::move(tables);
  if (impl.tier.making == Making::kBeside) {
    impl.native_maker.start(*impl.running, impl.tier);
  }
  return controller;
}

void Controller::cycle() {
  impl_->native_maker.take(impl_->scheduler.tables(), impl_->tier.take_at, cycles());
  impl_->scheduler.run_cycle();
  if (impl_->watch != nullptr && (at_boundary() || faulted())) impl_->watch->at_boundary();
  if (!at_boundary() || faulted()) return;
  const TaskTables& tables = impl_->scheduler.tables();
  impl_->io_port.at_boundary(tables.process_image, impl_->memory.data());
  impl_->io_port.publish_globals(tables.shared, impl_->memory.data());
}
void Controller::run_idle(const std::function<bool()>& unit) { impl_->scheduler.run_idle(unit); }
void Controller::watch(BoundaryWatch* watch) { impl_->watch = watch; }
void Controller::worked(int64_t expected_ns) { impl_->scheduler.worked(expected_ns); }
uint64_t Controller::cycles() const { return impl_->scheduler.cycles(); }
void Controller::reset_times() { impl_->scheduler.tables().forget_times(); }
bool Controller::at_boundary() const { return impl_->scheduler.at_boundary(); }
bool Controller::faulted() const { return impl_->scheduler.faulted(); }
bool Controller::start_pending() const { return impl_->scheduler.start_pending(); }
bool Controller::starts_anew() const { return impl_->scheduler.starts_anew(); }
void Controller::values_put_back() { impl_->scheduler.outputs_put_back(); }
int64_t Controller::next_release_ns() const { return impl_->scheduler.tables().next_release_ns(); }
int64_t Controller::next_cycle_ns() const { return impl_->scheduler.next_cycle_ns(); }
int64_t Controller::base_period_ns() const { return impl_->scheduler.tables().base_period_ns; }
const ir::Image& Controller::image() const { return impl_->image(); }
const ir::VerifiedImage& Controller::verified() const { return impl_->running->verified(); }
const Generation& Controller::generation() const { return *impl_->running; }
const CodeTable& Controller::code() const { return *impl_->scheduler.tables().code; }
Memory& Controller::memory() { return impl_->memory; }
uint64_t Controller::data_limit() const { return impl_->data_limit; }
const CodeSlots& Controller::code_slots() const { return *impl_->code_slots; }

std::vector<TaskStatus> Controller::tasks() const {
  std::vector<TaskStatus> rows;
  for (const TaskSlot& task : impl_->scheduler.tables().tasks) {
    rows.push_back(task.status);
    rows.back().run = summary_of(task.times->run);
    rows.back().delay = summary_of(task.times->delay);
    rows.back().recent_ns = task.times->recent_run.longest();
  }
  return rows;
}

std::optional<TaskActivity> Controller::activity(size_t task, uint32_t generation) const {
  return impl_->scheduler.board().look(task, generation);
}

std::optional<TaskTimes> Controller::task_times(std::string_view name) const {
  for (const TaskSlot& task : impl_->scheduler.tables().tasks) {
    if (!ir::same_name(task.status.name, name)) continue;
    return TaskTimes{task.status.name, classes_of(task.times->run), classes_of(task.times->delay)};
  }
  return std::nullopt;
}

uint64_t Controller::missed_releases() const { return impl_->scheduler.tables().missed_releases(); }
uint64_t Controller::load() const { return impl_->scheduler.tables().load(); }

void Controller::copy_task(size_t number, TaskSample& out) const {
  const TaskSlot& task = impl_->scheduler.tables().tasks[number];
  out.status = task.status;
  out.status.recent_ns = task.times->recent_run.longest();
  out.run = task.times->run;
  out.delay = task.times->delay;
}

const Traps& Controller::traps() const { return impl_->scheduler.traps(); }
uint64_t Controller::trap_count() const { return impl_->scheduler.trap_count(); }

base::Result<std::string> Controller::get(std::string_view path) const {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image(), path);
  if (!symbol.ok()) return symbol.error();
  return ir::format_value(image(), *symbol, impl_->memory.view());
}

base::Status Controller::set(std::string_view path, std::string_view value) {
  auto set = prepare_set(std::array{NamedValue{std::string(path), std::string(value)}});
  if (!set.ok()) return set.error();
  write(*set);
  return base::Ok{};
}

base::Result<WriteSet> Controller::prepare_set(std::span<const NamedValue> values) const {
  return WriteSet::make(impl_->scheduler.tables(), values);
}

bool Controller::write(const WriteSet& set) {
  base::check(at_boundary(), "a value is set while a task is inside a scan");
  if (set.generation != generation().number()) return false;
  for (const WriteSet::Value& value : set.values) {
    value.put(impl_->memory.data());
  }
  impl_->scheduler.outputs_set(set.outputs);
  worked(static_cast<int64_t>(set.work_bytes) / kCopyBytesPerNs);
  return true;
}

base::Result<std::unique_ptr<ForceChange>> Controller::prepare_force(
    std::span<const NamedValue> values) const {
  std::vector<Force> next = forces();
  for (const NamedValue& row : values) {
    base::Result<ir::Symbol> symbol = writable(verified(), row.path);
    if (!symbol.ok()) return symbol.error();
    base::Result<base::Bytes> bytes = parsed(image(), *symbol, row);
    if (!bytes.ok()) return bytes.error();
    Force force{row.path, *symbol, std::move(*bytes)};
    const ProcessImage& bits = impl_->scheduler.tables().process_image;
    std::erase_if(next, [&](const Force& other) { return overlap(force, other, bits); });
    next.push_back(std::move(force));
  }
  return impl_->prepare_forces(std::move(next));
}

base::Result<std::unique_ptr<ForceChange>> Controller::prepare_unforce(
    std::span<const std::string> paths) const {
  std::vector<Force> next = forces();
  for (const std::string& path : paths) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(verified().names(), path);
    if (!symbol.ok()) return symbol.error();
    const auto same_place = [&](const Force& f) { return ir::same_place(f.symbol, *symbol); };
    const bool twice = std::none_of(forces().begin(), forces().end(), same_place);
    if (twice) return base::Error{base::Refusal::kNoSuchVariable, "`" + path + "` is not forced"};
    std::erase_if(next, same_place);
  }
  return impl_->prepare_forces(std::move(next));
}

std::unique_ptr<ForceChange> Controller::renew_forces() const {
  const ForcedSet& forced = impl_->scheduler.tables().forced;
  const bool newest = forced.made_of == impl_->running->code()->number.value;
  return forced.code == nullptr || newest ? nullptr : impl_->prepare_forces(forced.forces);
}

void Controller::use(ForceChange& change) {
  base::check(at_boundary(), "a variable is forced while a task is inside a scan");
  for (ForceChange::Row& row : change.rows) {
    const auto tables = impl_->tables.find(row.generation);
    if (tables != impl_->tables.end()) tables->second->exchange_forces(row.set);
    if (row.generation == impl_->running.get()) impl_->scheduler.forces_exchanged(row.set);
  }
}

base::Status Controller::force(std::string_view path, std::string_view value) {
  auto change = prepare_force(std::array{NamedValue{std::string(path), std::string(value)}});
  if (!change.ok()) return change.error();
  use(**change);
  return base::Ok{};
}

base::Status Controller::unforce(std::string_view path) {
  auto change = prepare_unforce(std::array{std::string(path)});
  if (!change.ok()) return change.error();
  use(**change);
  return base::Ok{};
}

const std::vector<Force>& Controller::forces() const {
  return impl_->scheduler.tables().forced.forces;
}

const ForcedSet& Controller::next_forces(const Generation& prepared) const {
  return impl_->tables.at(&prepared)->forced;
}
MovedForces Controller::take_moved_forces() {
  return std::exchange(impl_->scheduler.tables().forced.moved, {});
}

uint32_t Controller::pous_to_make() const { return impl_->native_maker.to_make(); }

base::Result<std::unique_ptr<Generation>> Controller::prepare(ir::VerifiedImage next_image,
                                                              ForceList back) {
  const Generation* running = impl_->running.get();
  // The maker of machine code would read code slots that are written now.
  if (!impl_->native_maker.is_for(*running)) {
    impl_->native_maker.stop();
    (void)impl_->native_maker.take_stopped();
  }
  std::erase_if(impl_->tables, [&](const auto& row) { return row.first != running; });
  auto next = Generation::build(std::move(next_image), running->number() + 1, impl_->memory.data(),
                                impl_->code_slots, running, impl_->tier);
  if (!next.ok()) return next;
  base::Status devices = impl_->io_port.prepare((*next)->verified());
  if (!devices.ok()) return devices.error();
  auto tables = std::make_unique<TaskTables>(**next, 0);
  ForcedSet forced = tables->adopted_forces(image(), forces(), impl_->tier, std::move(back));
  tables->exchange_forces(forced);
  TaskTables::compare_outputs(impl_->scheduler.tables(), *tables);
  impl_->tables[next->get()] = std::move(tables);
  return next;
}

std::unique_ptr<Generation> Controller::publish(std::unique_ptr<Generation> next, Memory* data) {
  base::check(at_boundary(), "a program is replaced while a task is inside a scan");
  auto prepared = impl_->tables.find(next.get());
  base::check(prepared != impl_->tables.end(), "a generation is published that was not prepared");
  TaskTables& tables = *prepared->second;
  tables.adopt(impl_->scheduler.tables(), impl_->scheduler.cycle_start_ns());
  if (data != nullptr) std::swap(impl_->memory, *data);
  if (ir::needs_normalising(impl_->running->bools(), next->bools())) {
    next->bools().normalise_all(impl_->memory.data());
  }
  impl_->scheduler.use(tables, impl_->memory.data());
  std::swap(impl_->running, next);
  impl_->io_port.use(verified().digest());
  return next;
}

// The version that runs was built on the other one, or that one on it.
void Controller::make_native() {
  Impl& impl = *impl_;
  const Generation& running = *impl.running;
  if (impl.tier.making != Making::kBeside || impl.native_maker.is_for(running)) return;
  if (running.native() != nullptr) return;
  impl.native_maker.stop();
  std::optional<MadeCode> like = impl.native_maker.take_stopped();
  for (const auto& [generation, tables] : impl.tables) {
    if (generation == &running || tables->own_code->native == nullptr) continue;
    like.emplace(MadeCode{tables->version, tables->own_code});
  }
  impl.native_maker.start(running, impl.tier, std::move(like));
}

// Nothing runs of another version, nor will.
void Controller::settle_devices() {
  std::erase_if(impl_->tables, [&](const auto& row) { return row.first != impl_->running.get(); });
  impl_->io_port.settle();
}
std::vector<DeviceStatus> Controller::devices() const { return impl_->io_port.status(); }

void Controller::construct() {
  impl_->set_change_flag(true);
  impl_->scheduler.start_in_next_cycle(false);
}

base::Status Controller::enter() {
  if (faulted()) return base::Ok{};
  impl_->set_change_flag(true);
  if (impl_->scheduler.run_inits()) return base::Ok{};
  return impl_->last_trap(base::Refusal::kInitFailed);
}
base::Status Controller::leave(const std::vector<uint32_t>& ids, int64_t limit_ns) {
  return impl_->leave(ids, true, limit_ns);
}

base::Status Controller::leave_all(int64_t limit_ns) {
  std::vector<uint32_t> ids;
  for (uint32_t id = 1; id < image().instances.size(); ++id) {
    if (image().instances[id].live) ids.push_back(id);
  }
  base::Status left = impl_->leave(ids, false, limit_ns);
  impl_->scheduler.send_outputs();
  return left;
}

void Controller::make_outputs_safe() { impl_->scheduler.make_outputs_safe(true); }

base::Status Controller::restart(Restart kind, int64_t exit_limit_ns) {
  base::Status left = base::Ok{};
  if (kind != Restart::kHot) {
    left = leave_all(exit_limit_ns);
    impl_->reset_data(kind == Restart::kWarm);
    impl_->set_change_flag(false);
  }
  impl_->scheduler.restart();
  if (kind != Restart::kHot) impl_->scheduler.start_in_next_cycle(true);
  return left;
}

// To initial values, in the areas of this program only.
void Controller::Impl::reset_data(bool retain) {
  uint8_t* data = memory.data();
  std::vector<uint8_t> kept;
  for (const ir::RetainRange& range : image().retain) {
    kept.insert(kept.end(), data + range.data, data + range.data + range.size);
  }
  for (uint32_t id = 0; id < image().instances.size(); ++id) {
    const ir::Instance& row = image().instances[id];
    if (id != 0 && !row.live) continue;
    std::memset(data + row.data, 0, image().layouts[row.type].area_capacity);
  }
  write_initial_data(image(), data);
  if (retain) write_retained(image(), kept, data);
  running->bools().normalise_all(data);
}

base::Status Controller::Impl::leave(const std::vector<uint32_t>& ids, bool changed,
                                     int64_t limit_ns) {
  std::vector<std::pair<StampRef, uint32_t>> marked;  // with what it was
  for (uint32_t id : ids) {
    const StampRef stamp(*running, id, memory.data());
    if (stamp.get() != ir::kNewStamp && !scheduler.faulted())
      marked.push_back({stamp, stamp.get()});
  }
  if (marked.empty()) return base::Ok{};
  for (const auto& [stamp, before] : marked) stamp.set(ir::kLeavingStamp);
  set_change_flag(changed);
  const bool done = scheduler.run_exits(limit_ns);
  for (const auto& [stamp, before] : marked) {
    stamp.set(stamp.get() == ir::kLeavingStamp ? before : ir::kNewStamp);
  }
  return done ? base::Status(base::Ok{}) : last_trap(base::Refusal::kExitFailed);
}

base::Error Controller::Impl::last_trap(base::Refusal refusal) const {
  const TrapText& last = scheduler.traps().back()->text;
  return {refusal, last.pou + " in line " + std::to_string(last.line) + ": " + last.text};
}

void Controller::Impl::set_change_flag(bool changed) {
  StampRef(*running, 0, memory.data()).set(changed ? 1 : 0);
}

// Prepared tables carry the forces too, so that a switch need not look them up.
std::unique_ptr<ForceChange> Controller::Impl::prepare_forces(std::vector<Force> forces) const {
  auto change = std::make_unique<ForceChange>();
  for (const auto& [generation, other] : tables) {
    if (generation == running.get()) continue;
    change->rows.push_back(
        {generation, other->adopted_forces(image(), forces, tier, other->forced.moved.back)});
  }
  ForcedSet set = ForcedSet::make(running->verified(), *running->code(), std::move(forces), tier);
  change->rows.push_back({running.get(), std::move(set)});
  return change;
}

}  // namespace vm
