// Execution: one activation of a program instance on the stack. It runs until it
// is done, traps, or its fuel is used up at a safe point; then it can be resumed
// exactly there, also after other executions ran on top of it (B1).
// During run(): no heap allocation, no lock, no system call (invariant 2).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/limits.h"
#include "ir/program/ir.h"
#include "vm/load/generation.h"

namespace vm {

struct Context;

enum class Exit : uint8_t { kDone, kSuspended, kTrap };

// A trap as a value; describe() turns it into words outside the scan.
struct Trap {
  ir::TrapKind kind = ir::TrapKind::kAssert;
  uint32_t pou = 0;             // index into Image::pous
  uint32_t unit = 0;            // unit inside the POU
  uint32_t instance = 0;        // ID, 0 for a function
  int64_t operand[2] = {0, 0};  // kIndex: index and bound number; kSubrange, kConversion: the value
};
struct TrapText {
  std::string pou;
  std::string file;
  uint32_t line = 0;
  std::string text;  // "array index outside its bounds: Speeds[12], bounds 0..9"
};
TrapText describe(const ir::Image& image, const Trap& trap);
// The line of the source; 0: unknown.
uint32_t line_of(const ir::LinkedPou& pou, uint32_t unit);

struct CallRecord {
  const ir::Unit* resume = nullptr;
  uint8_t* frame = nullptr;
  uint8_t* self = nullptr;
  uint32_t pou = 0;
  uint32_t instance = 0;
};

// An open try: how to go on when something traps inside.
struct TryRecord {
  const ir::Unit* handler = nullptr;
  uint32_t frame = 0;
  uint32_t self = 0;
  uint32_t pou = 0;
  uint32_t instance = 0;
  uint32_t depth = 0;  // calls below its POU
};

// A local whose address was taken, for as long as its POU is active.
struct Exposure {
  uint32_t segment = 0;  // ir::exposed_segment
  uint32_t begin = 0;    // in data memory
  uint32_t size = 0;
  uint32_t depth = 0;  // calls below its POU
};

class Execution {
 public:
  // `depth` calls at most (Image::call_depth), with `tries` open ones in each POU at most
  // (Generation::try_depth); allocated here, not in run(). `task` tells the exposed locals of one
  // task from those of others.
  explicit Execution(uint32_t depth, uint32_t task = 0, uint32_t tries = base::kMaxTryDepth);
  ~Execution();
  // Numbers its exposed locals after those of `earlier`, so that no stale reference finds one.
  void count_on(const Execution& earlier);

  // Prepares a call of program instance `id`. `stack` is where its frames begin.
  void start(const Generation& generation, uint8_t* memory, uint32_t id, uint32_t stack,
             int64_t task_time_ns) {
    start(generation, *generation.code(), memory, id, stack, task_time_ns);
  }
  // Starts with other code of that generation, which outlives the execution.
  void start(const Generation& generation, const CodeTable& code, uint8_t* memory, uint32_t id,
             uint32_t stack, int64_t task_time_ns);
  // Prepares a call of a function, which finds its inputs in its frame at `frame`, and leaves what
  // it gives there.
  void call(const Generation& generation, uint8_t* memory, uint32_t pou, uint32_t frame);
  // Runs at most `fuel` safe points (calls and back edges; 0 is taken as 1).
  Exit run(uint64_t fuel);

  const Trap& trap() const;
  // A trap from outside (fuel, watchdog) at the safe point where this one is suspended.
  Trap interrupted(ir::TrapKind kind) const;
  // First stack offset that this activation does not use: where a higher-priority
  // one may start while this one is suspended.
  uint32_t stack_top() const;
  uint64_t fuel_used() const { return fuel_used_; }
  int64_t task_time_ns() const;  // as it was given, and as code has moved it on
  uint64_t machine_entries() const;  // how often the interpreter went on in machine code

 private:
  void prepare(const Generation& generation, const CodeTable& code, uint8_t* memory);
  void begin(const Generation& generation, const CodeTable& code, uint8_t* memory, uint32_t pou,
             uint32_t frame);

  std::vector<CallRecord> calls_;
  std::vector<Exposure> exposures_;
  std::vector<TryRecord> tries_;
  std::unique_ptr<Context> state_;  // where it is; kept, as little of it is new in a scan
  uint64_t fuel_used_ = 0;
  uint64_t prepared_ = 0;  // CodeTable::number for which the state is prepared; 0: none
};

}  // namespace vm
