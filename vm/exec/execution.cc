#include "vm/exec/execution.h"

#include <algorithm>

#include "base/check.h"
#include "base/limits.h"
#include "vm/exec/context.h"
#include "vm/exec/references.h"
#include "vm/native/program.h"

namespace vm {

namespace {

// The unit of its POU where it is, also when a side unit of machine code stands for that.
uint32_t unit_of(const Context& ctx) {
  const ir::Unit* const pc =
      ctx.native == nullptr ? ctx.pc : ctx.native->real_unit(ctx.pou, ctx.pc);
  return static_cast<uint32_t>(pc - ctx.pous[ctx.pou].code);
}

void place_trap(Context& ctx) {
  if (ctx.trap_has_place) return;
  ctx.trap.pou = ctx.pou;
  ctx.trap.instance = ctx.instance;
  ctx.trap.unit = unit_of(ctx);
  ctx.trap_has_place = true;
}

// Goes on at the handler of the innermost open try. Calls above its POU are gone, and with them
// what they had exposed; what was stored is stored.
bool catch_trap(Context& ctx) {
  if (ctx.try_top == ctx.tries_begin || !ir::can_be_caught(ctx.trap.kind)) return false;
  const TryRecord& record = *--ctx.try_top;
  place_trap(ctx);
  ctx.trapped = true;
  ctx.caught = ctx.trap;
  ctx.trap = {};
  ctx.trap_has_place = false;
  ctx.call = ctx.calls_begin + record.depth;
  drop_exposed(ctx, record.depth + 1);
  ctx.pou = record.pou;
  ctx.instance = record.instance;
  ctx.pc = record.handler;
  ctx.frame = ctx.memory + record.frame;
  ctx.self = ctx.memory + record.self;
  ctx.exit = Exit::kDone;
  ctx.running = true;
  return true;
}

// With tail calls the first handler returns when the execution stops; without, each does.
void dispatch(Context& ctx) {
  do {
    while (ctx.running) {
      kHandlers.of[ctx.pc->op](ctx.pc, ctx.frame, ctx.self, ctx.memory, ctx.consts, &ctx);
    }
  } while (ctx.exit == Exit::kTrap && catch_trap(ctx));
}

}  // namespace

Execution::Execution(uint32_t depth, uint32_t task, uint32_t tries)
    : calls_(size_t{depth} + 1),
      exposures_(base::kMaxExposures),
      tries_((size_t{depth} + 1) * tries),
      state_(std::make_unique<Context>()) {
  state_->calls_begin = calls_.data();
  state_->calls_end = calls_.data() + calls_.size();
  state_->exposures = exposures_.data();
  state_->tries_begin = tries_.data();
  state_->tries_end = tries_.data() + tries_.size();
  state_->task = task;
}

Execution::~Execution() = default;

void Execution::count_on(const Execution& earlier) {
  state_->exposures_made = std::max(state_->exposures_made, earlier.state_->exposures_made);
}

void Execution::start(const Generation& generation, const CodeTable& code, uint8_t* memory,
                      uint32_t id, uint32_t stack, int64_t task_time_ns) {
  const InstanceEntry& instance = generation.instances()[id];
  base::check(instance.data != 0, "an execution starts with a live program instance");
  begin(generation, code, memory, instance.pou, stack);
  state_->instance = id;
  state_->self = memory + instance.data;
  state_->task_time_ns = task_time_ns;
}

void Execution::call(const Generation& generation, uint8_t* memory, uint32_t pou, uint32_t frame) {
  begin(generation, *generation.code(), memory, pou, frame);
  state_->instance = 0;
  state_->self = memory;
  state_->task_time_ns = 0;
}

// What stays the same from scan to scan, and what traps leave behind.
STC_COLD void Execution::prepare(const Generation& generation, const CodeTable& code,
                                 uint8_t* memory) {
  Context& ctx = *state_;
  ctx.generation = &generation;
  ctx.native = code.native.get();
  ctx.memory = memory;
  ctx.consts = memory + generation.pool_offset();
  ctx.pous = code.pous.data();
  ctx.instances = generation.instances().data();
  ctx.instance_count = static_cast<uint32_t>(generation.instances().size());
  ctx.bounds = generation.bounds().data();
  ctx.ranges = generation.ranges().data();
  ctx.areas = generation.areas().data();
  const OverrideTable& overrides = generation.override_table();
  ctx.overrides = overrides.rows.data();
  ctx.override_mask = overrides.mask;
  ctx.override_factor = overrides.factor;
  ctx.caught = {};
  ctx.trap = {};
  ctx.trap_has_place = false;
  for (KnownReach& known : ctx.reaches) known = {};
  prepared_ = code.number.value;
}

inline void Execution::begin(const Generation& generation, const CodeTable& code, uint8_t* memory,
                             uint32_t pou, uint32_t frame) {
  Context& ctx = *state_;
  const bool prepared = prepared_ == code.number.value && ctx.memory == memory && !ctx.trapped;
  if (!prepared) [[unlikely]]
    prepare(generation, code, memory);
  ctx.trapped = false;
  ctx.entries = 0;
  ctx.call = ctx.calls_begin;
  if (ctx.exposure_count != 0) [[unlikely]]
    drop_exposed(ctx, 0);
  ctx.try_top = ctx.tries_begin;
  ctx.exit = Exit::kDone;
  ctx.pou = pou;
  ctx.pc = ctx.pous[pou].entry;
  ctx.frame = memory + frame;
  fuel_used_ = 0;
}

uint64_t Execution::machine_entries() const { return state_->entries; }
int64_t Execution::task_time_ns() const { return state_->task_time_ns; }
const Trap& Execution::trap() const { return state_->trap; }

Trap Execution::interrupted(ir::TrapKind kind) const {
  Trap trap;
  trap.kind = kind;
  trap.pou = state_->pou;
  trap.unit = unit_of(*state_);
  trap.instance = state_->instance;
  return trap;
}

Exit Execution::run(uint64_t fuel) {
  Context& ctx = *state_;
  ctx.fuel = std::max<uint64_t>(fuel, 1);
  const uint64_t given = ctx.fuel;
  if (ctx.exit == Exit::kSuspended) {
    if (ctx.native != nullptr) ctx.pc = ctx.native->entry(ctx.pou, ctx.pc);
    ctx.exit = Exit::kDone;
  }
  ctx.running = true;
  dispatch(ctx);
  if (ctx.exit == Exit::kTrap) {
    place_trap(ctx);
    ctx.trapped = true;
  }
  fuel_used_ += given - ctx.fuel;
  return ctx.exit;
}

uint32_t Execution::stack_top() const {
  const Context& ctx = *state_;
  return static_cast<uint32_t>(ctx.frame - ctx.memory) + ctx.pous[ctx.pou].frame_size;
}

}  // namespace vm
