// The oracle: a small, slow, obviously correct evaluator. It knows no addresses and no
// bytecode: variables are trees of values. A layout only says what they are as bytes, for unions
// and for references that name something else than a whole variable. Interpreter and native tier
// must give the same state after every scan, traps included.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/program/ir.h"
#include "ir/types/layout.h"

namespace ir {

struct EvalTrap {
  TrapKind kind;
  std::string pou;
  uint32_t line = 0;
  std::string text;  // operands, for people
};

// What one local of a function holds at its end.
struct EvalResult {
  std::optional<EvalTrap> trap;
  uint64_t bits = 0;
  std::string text;
};
// Runs `pou`, which has no parameters, names neither globals nor instances and calls
// native functions only: how the compiler knows the value of a constant expression.
EvalResult evaluate_alone(const Program& program, const Pou& pou, uint32_t local, uint64_t budget);

// Where variables lie in the memory that the evaluator is compared with.
struct EvalArea {
  std::string path;  // of an instance, as ir::Image::instance_path; "" for the globals
  uint32_t id = 0;
  uint32_t generation = 0;
  uint32_t data = 0;
};
struct EvalMemory {
  Layouts layouts;  // of the program's types
  std::vector<EvalArea> areas;
};

class Evaluator {
 public:
  // `program` must be verified and outlive the evaluator. All variables hold
  // their initial values, and the tasks that run once have run; their traps come with the
  // first scan's.
  explicit Evaluator(const Program& program);  // laid out naturally
  Evaluator(const Program& program, EvalMemory memory);
  ~Evaluator();

  // Start code once more, as a controller runs it after a change: for what has not begun yet. Its
  // traps belong to the next scan, as those of the start.
  void run_start();
  // Runs one scan: every task whose period divides now_ns, by priority, each to its
  // end. A trap stops the rest of that task for this scan and is returned.
  // `budget` bounds the instructions of a task (kFuel trap).
  std::vector<EvalTrap> scan(int64_t now_ns, uint64_t budget);

  // Which variables keep their values: those that are RETAIN, or none. What has FB_Exit leaves
  // first; start code runs at the next scan.
  void restart(bool warm);

  // One leaf variable by path ("Main.fb.x", "gCount", "Main.a[1,2].b"), without
  // case: its bits (sign-extended; bool 0/1), or a string's bytes.
  base::Result<uint64_t> bits(std::string_view path) const;
  base::Result<std::string> string(std::string_view path) const;
  base::Status set_bits(std::string_view path, uint64_t bits);
  // As they are in memory, of a structure too: with what overlaps other leaves, follows a NUL or
  // is padding. Outputs count as left by a complete scan.
  base::Status set_bytes(std::string_view path, std::span<const uint8_t> bytes);
  // From now on the bytes are there again after whatever may have written them: a force, as every
  // reader is to find it (docs/adr/0026-forced-versions.md).
  base::Status hold(std::string_view path, std::span<const uint8_t> bytes);
  void release(std::string_view path);
  // Cut to the capacity; WSTRING: UTF-16LE.
  base::Status set_string(std::string_view path, std::string_view text);

  // Every leaf variable, "path=value" sorted by declaration; the format of
  // ir/bytecode/symbols.h so that tiers can be compared as text.
  std::string state() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ir
