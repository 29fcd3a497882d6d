#include "vm/exec/execution.h"

#include <algorithm>

#include "base/check.h"
#include "base/limits.h"
#include "vm/exec/context.h"
#include "vm/exec/references.h"
#include "vm/native/program.h"

namespace vm {

// Moves the state of an execution into a Context and back.
struct Interpreter {
  static Context context_of(Execution& e, uint64_t fuel) {
    const Generation& generation = *e.generation_;
    Context ctx;
    ctx.fuel = fuel;
    ctx.calls_begin = e.calls_.data();
    ctx.calls_end = e.calls_.data() + e.calls_.size();
    ctx.call = e.calls_.data() + e.depth_;
    ctx.pous = generation.pous().data();
    ctx.instances = generation.instances().data();
    ctx.instance_count = static_cast<uint32_t>(generation.instances().size());
    ctx.pou = e.pou_;
    ctx.instance = e.instance_;
    ctx.exposures = e.exposures_.data();
    ctx.exposure_count = e.exposure_count_;
    ctx.exposures_made = e.exposures_made_;
    find_deepest_exposed(ctx);
    ctx.task = e.task_;
    ctx.tries_begin = e.tries_.data();
    ctx.try_top = e.tries_.data() + e.try_count_;
    ctx.tries_end = e.tries_.data() + e.tries_.size();
    ctx.caught = e.caught_;
    ctx.generation = &generation;
    ctx.memory = e.memory_;
    ctx.consts = e.memory_ + generation.pool_offset();
    ctx.bounds = generation.bounds().data();
    ctx.ranges = generation.ranges().data();
    ctx.task_time_ns = e.task_time_ns_;
    ctx.pc = e.pc_;
    if (generation.native() != nullptr) ctx.pc = generation.native()->entry(e.pou_, e.pc_);
    ctx.frame = e.memory_ + e.frame_;
    ctx.self = e.memory_ + e.self_;
    return ctx;
  }

  // With tail calls the first handler returns when the execution stops; without, each does.
  static void dispatch(const Execution& e, Context& ctx, uint8_t* mem, const uint8_t* consts) {
    do {
      while (ctx.running) {
        kHandlers.of[ctx.pc->op](ctx.pc, ctx.frame, ctx.self, mem, consts, &ctx);
      }
    } while (ctx.exit == Exit::kTrap && catch_trap(e, ctx, mem));
  }

  static void place_trap(const Execution& e, Context& ctx) {
    if (ctx.trap_has_place) return;
    ctx.trap.pou = ctx.pou;
    ctx.trap.instance = ctx.instance;
    const native::Program* const native = e.generation_->native();
    if (native != nullptr) ctx.pc = native->real_unit(ctx.pou, ctx.pc);
    ctx.trap.unit = static_cast<uint32_t>(ctx.pc - e.generation_->pous()[ctx.pou].code);
    ctx.trap_has_place = true;
  }

  // Goes on at the handler of the innermost open try. Calls above its POU are gone, and with them
  // what they had exposed; what was stored is stored.
  static bool catch_trap(const Execution& e, Context& ctx, uint8_t* mem) {
    if (ctx.try_top == ctx.tries_begin || !ir::can_be_caught(ctx.trap.kind)) return false;
    const TryRecord& record = *--ctx.try_top;
    place_trap(e, ctx);
    ctx.caught = ctx.trap;
    ctx.trap = {};
    ctx.trap_has_place = false;
    ctx.call = ctx.calls_begin + record.depth;
    drop_exposed(ctx, record.depth + 1);
    ctx.pou = record.pou;
    ctx.instance = record.instance;
    ctx.pc = record.handler;
    ctx.frame = mem + record.frame;
    ctx.self = mem + record.self;
    ctx.exit = Exit::kDone;
    ctx.running = true;
    return true;
  }

  static void keep(Execution& e, const Context& ctx, uint64_t fuel) {
    e.depth_ = static_cast<uint32_t>(ctx.call - ctx.calls_begin);
    e.exposure_count_ = ctx.exposure_count;
    e.exposures_made_ = ctx.exposures_made;
    e.try_count_ = static_cast<uint32_t>(ctx.try_top - ctx.tries_begin);
    e.caught_ = ctx.caught;
    e.pc_ = ctx.pc;
    e.frame_ = static_cast<uint32_t>(ctx.frame - e.memory_);
    e.self_ = static_cast<uint32_t>(ctx.self - e.memory_);
    e.pou_ = ctx.pou;
    e.instance_ = ctx.instance;
    e.task_time_ns_ = ctx.task_time_ns;
    e.fuel_used_ += fuel - ctx.fuel;
    if (ctx.exit != Exit::kTrap) return;
    e.trap_ = ctx.trap;
  }
};

Execution::Execution(uint32_t depth, uint32_t task, uint32_t tries)
    : calls_(size_t{depth} + 1),
      exposures_(base::kMaxExposures),
      task_(task),
      tries_((size_t{depth} + 1) * tries) {}

void Execution::start(const Generation& generation, uint8_t* memory, uint32_t id, uint32_t stack,
                      int64_t task_time_ns) {
  const InstanceEntry& instance = generation.instances()[id];
  base::check(instance.data != 0, "an execution starts with a live program instance");
  call(generation, memory, instance.pou, stack);
  instance_ = id;
  self_ = instance.data;
  task_time_ns_ = task_time_ns;
}

void Execution::call(const Generation& generation, uint8_t* memory, uint32_t pou, uint32_t frame) {
  generation_ = &generation;
  memory_ = memory;
  depth_ = 0;
  exposure_count_ = 0;
  try_count_ = 0;
  caught_ = {};
  instance_ = 0;
  pou_ = pou;
  pc_ = generation.pous()[pou].code;
  frame_ = frame;
  self_ = 0;
  task_time_ns_ = 0;
  fuel_used_ = 0;
  trap_ = {};
}

Trap Execution::interrupted(ir::TrapKind kind) const {
  Trap trap;
  trap.kind = kind;
  trap.pou = pou_;
  trap.unit = static_cast<uint32_t>(pc_ - generation_->pous()[pou_].code);
  trap.instance = instance_;
  return trap;
}

Exit Execution::run(uint64_t fuel) {
  fuel = std::max<uint64_t>(fuel, 1);
  Context ctx = Interpreter::context_of(*this, fuel);
  Interpreter::dispatch(*this, ctx, memory_, memory_ + generation_->pool_offset());
  if (ctx.exit == Exit::kTrap) Interpreter::place_trap(*this, ctx);
  Interpreter::keep(*this, ctx, fuel);
  return ctx.exit;
}

uint32_t Execution::stack_top() const { return frame_ + generation_->pous()[pou_].frame_size; }

}  // namespace vm
