// Runs the bodies of POUs over variables. One frame per call, one value per
// ValueId, traps as values.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ir/program/eval_references.h"
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
  // Without `layouts` and `references` nothing is looked at as bytes: no unions, no handles.
  EvalMachine(const Program& program, Variable& globals, const Layouts* layouts = nullptr,
              References* references = nullptr)
      : program_(program),
        layouts_(layouts),
        references_(references),
        variables_(program, layouts),
        globals_(globals) {}

  // Runs the POU of `instance`; the trap that stopped it, if any. `budget` counts
  // down by instructions.
  std::optional<EvalTrap> run(Variable& instance, uint32_t task, int64_t now_ns, uint64_t& budget);
  // Runs a function that has no parameters; `local` of its frame as it was at the end.
  EvalResult run_alone(const Pou& pou, uint32_t local, uint64_t& budget);
  // Called after each instruction that may write variables.
  std::function<void()> written;

 private:
  std::unique_ptr<Frame> make_frame(const Pou& pou, Variable* self);
  void run_frame(Frame& frame);
  // After a trap in `block`: its handler, or invalid when nothing catches it.
  BlockId caught_by(Frame& frame, BlockId block);
  // Runs a block to its end; the next block, or invalid at a return or trap.
  BlockId run_block(Frame& frame, BlockId block);
  BlockId run_terminator(Frame& frame, const Inst& inst);
  BlockId take(Frame& frame, const Target& target);
  void run_inst(Frame& frame, const Inst& inst);
  void run_memory(Frame& frame, const Inst& inst);
  void run_string_or_address(Frame& frame, const Inst& inst);
  void run_call_function(Frame& frame, const Inst& inst);
  void run_call_instance(Frame& frame, const Inst& inst);
  void run_object(Frame& frame, const Inst& inst);
  void run_call_method(Frame& frame, const Inst& inst);
  void run_call_virtual(Frame& frame, const Inst& inst);
  void run_call_reference(Frame& frame, const Inst& inst);
  // The instance that the first operand names and that is a `type`; null after a trap.
  Variable* referenced(Frame& frame, const Inst& inst, TypeId type);
  // Runs a method on `instance`; its arguments lie in the frame of `named`.
  void call_method(Frame& frame, const Inst& inst, PouId named, PouId target, Variable* instance);
  void call_body(Frame& frame, const Inst& inst, TypeId type, Variable* instance);
  void run_native(Frame& frame, const Inst& inst);
  Outcome compute(const Frame& frame, const Inst& inst) const;

  void run_handle(Frame& frame, const Inst& inst);
  bool too_deep(const Pou& pou) const;

  // What a place names; nothing (no root) after a trap.
  Address locate(Frame& frame, const Inst& inst, PlaceId place);
  Address locate_target(Frame& frame, const Inst& inst, const Place& place);
  Address locate_base(Frame& frame, const Place& place);
  // Takes the steps of `place` from number `first` on.
  bool walk(const Frame& frame, const Inst& inst, const Place& place, size_t first, Address& at);
  void enter_member(Address& at, uint32_t number) const;
  // The handle moved along the steps of a place of base kTarget that need nothing resolved.
  std::optional<uint64_t> moved(const Frame& frame, const Inst& inst, const Place& place);
  uint64_t load_bits(const Address& at) const;
  void store_bits(const Address& at, uint64_t bits);
  void copy(const Address& to, const Address& from);
  void set_text(const Address& to, std::string_view text);
  void set_units(const Address& to, const std::vector<uint8_t>& units);
  std::vector<uint8_t> units_of(const Address& string) const;
  // The frame in which the arguments of the next call are written.
  Frame& next_callee(Frame& frame, PouId pou);
  Variable& constant(const Place& place);
  bool follow(const Inst& inst, Address& at);
  std::optional<uint64_t> element(const Frame& frame, const Inst& inst, const Place& place,
                                  size_t& step, TypeId array);

  uint64_t bits(const Frame& frame, ValueId value) const { return frame.values[value.index].bits; }
  bool alive(const Address& address) const;
  void trap(const Inst& inst, TrapKind kind, std::string text);
  void trap_again(const Inst& inst, uint32_t kind);

  const Program& program_;
  const Layouts* layouts_;
  References* references_;
  uint32_t task_ = 0;
  Variables variables_;
  Variable& globals_;
  std::map<std::pair<uint32_t, uint32_t>, std::unique_ptr<Variable>> constants_;
  std::unordered_map<TypeId, PouId> pou_of_type_;
  std::vector<const Frame*> stack_;
  uint64_t next_serial_ = 1;
  int64_t now_ns_ = 0;
  uint64_t* budget_ = nullptr;
  std::optional<EvalTrap> trap_;
  std::optional<EvalTrap> caught_;
};

}  // namespace ir
