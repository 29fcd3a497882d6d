// The oracle: a small, slow, obviously correct evaluator. It knows no layout, no
// addresses and no bytecode: variables are trees of values. Interpreter and native
// tier must give the same state after every scan, traps included.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

struct EvalTrap {
  TrapKind kind;
  std::string pou;
  uint32_t line = 0;
  std::string text;  // operands, for people
};

class Evaluator {
 public:
  // `program` must be verified and outlive the evaluator. All variables hold
  // their initial values.
  explicit Evaluator(const Program& program);
  ~Evaluator();

  // Runs one scan: every task whose period divides now_ns, by priority, each to its
  // end. A trap stops the rest of that task for this scan and is returned.
  // `budget` bounds the instructions of a task (kFuel trap).
  std::vector<EvalTrap> scan(int64_t now_ns, uint64_t budget);

  // One leaf variable by path ("Main.fb.x", "gCount", "Main.a[1,2].b"), without
  // case: its bits (sign-extended; bool 0/1), or a string's bytes.
  base::Result<uint64_t> bits(std::string_view path) const;
  base::Result<std::string> string(std::string_view path) const;
  base::Status set_bits(std::string_view path, uint64_t bits);

  // Every leaf variable, "path=value" sorted by declaration; the format of
  // ir/bytecode/symbols.h so that tiers can be compared as text.
  std::string state() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ir
