// Runs the bodies of POUs over variables. One frame per call, one value per
// ValueId, traps as values.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ir/program/eval_scalar.h"
#include "ir/program/eval_variable.h"
#include "ir/program/evaluate.h"

namespace ir {

// A value in a frame: bits of a scalar, or where an addr, str or wstr points.
struct EvalValue {
  uint64_t bits = 0;
  Address address;
};

struct Frame {
  const Pou* pou = nullptr;
  Variable* self = nullptr;
  uint64_t serial = 0;
  bool ran = false;
  std::vector<Variable> locals;
  std::vector<EvalValue> values;
  std::vector<std::unique_ptr<Variable>> constants;  // copies whose address was taken
  std::unique_ptr<Frame> callee;                     // arguments being written, then results
};

class EvalMachine {
 public:
  EvalMachine(const Program& program, Variable& globals)
      : program_(program), variables_(program), globals_(globals) {}

  // Runs the POU of `instance`; the trap that stopped it, if any. `budget` counts
  // down by instructions.
  std::optional<EvalTrap> run(Variable& instance, int64_t now_ns, uint64_t& budget);

 private:
  std::unique_ptr<Frame> make_frame(const Pou& pou, Variable* self);
  void run_frame(Frame& frame);
  // Runs a block to its end; the next block, or invalid at a return or trap.
  BlockId run_block(Frame& frame, BlockId block);
  BlockId run_terminator(Frame& frame, const Inst& inst);
  BlockId take(Frame& frame, const Target& target);
  void run_inst(Frame& frame, const Inst& inst);
  void run_memory(Frame& frame, const Inst& inst);
  void run_string_or_address(Frame& frame, const Inst& inst);
  void run_call_function(Frame& frame, const Inst& inst);
  void run_call_instance(Frame& frame, const Inst& inst);
  void run_native(Frame& frame, const Inst& inst);
  Outcome compute(const Frame& frame, const Inst& inst) const;

  // The variable that a place names; null variable after a trap.
  Address locate(Frame& frame, const Inst& inst, PlaceId place);
  Address locate_base(Frame& frame, const Place& place);
  // The frame in which the arguments of the next call are written.
  Frame& next_callee(Frame& frame, PouId pou);
  Variable& constant(const Place& place);
  bool follow(const Inst& inst, Address& at);
  bool select(const Frame& frame, const Inst& inst, const Place& place, size_t& step,
              Variable*& variable);

  uint64_t bits(const Frame& frame, ValueId value) const { return frame.values[value.index].bits; }
  bool alive(const Address& address) const;
  void trap(const Inst& inst, TrapKind kind, std::string text);

  const Program& program_;
  Variables variables_;
  Variable& globals_;
  std::map<std::pair<uint32_t, uint32_t>, std::unique_ptr<Variable>> constants_;
  std::unordered_map<TypeId, PouId> pou_of_type_;
  std::vector<const Frame*> stack_;
  uint64_t next_serial_ = 1;
  int64_t now_ns_ = 0;
  uint64_t* budget_ = nullptr;
  std::optional<EvalTrap> trap_;
};

}  // namespace ir
