#include "ir/program/eval_machine.h"

#include <algorithm>
#include <array>

#include "base/limits.h"
#include "ir/program/ops.h"
#include "ir/types/handle.h"

namespace ir {

std::optional<EvalTrap> EvalMachine::run(Variable& instance, uint32_t task, int64_t now_ns,
                                         uint64_t& budget) {
  now_ns_ = now_ns;
  task_ = task;
  budget_ = &budget;
  trap_.reset();
  caught_ = {};
  const PouId pou = program_.pou_of_instance_type(instance.type);
  const std::unique_ptr<Frame> frame = make_frame(program_.pous[pou.index], &instance);
  run_frame(*frame);
  return trap_;
}

EvalResult EvalMachine::run_alone(const Pou& pou, uint32_t local, uint64_t& budget) {
  budget_ = &budget;
  trap_.reset();
  const std::unique_ptr<Frame> frame = make_frame(pou, nullptr);
  run_frame(*frame);
  const Variable& result = frame->locals[local];
  return {trap_, result.bits, std::string(variables_.text(result))};
}

std::unique_ptr<Frame> EvalMachine::make_frame(const Pou& pou, Variable* self) {
  auto frame = std::make_unique<Frame>();
  frame->pou = &pou;
  frame->self = self;
  frame->serial = next_serial_++;
  frame->values.resize(pou.values.size());
  for (const Local& local : pou.locals) {
    frame->locals.push_back(local.kind == LocalKind::kInOut ? variables_.make_slot(local.type)
                                                            : variables_.make(local.type));
  }
  return frame;
}

// Of several traps on the way out only the innermost is kept.
void EvalMachine::trap(const Inst& inst, TrapKind kind, std::string text) {
  if (!trap_) {
    trap_ = EvalTrap{kind, stack_.back()->pou->name, inst.line, std::move(text)};
  }
}

void EvalMachine::trap_again(const Inst& inst, uint32_t kind) {
  if (caught_ && static_cast<uint32_t>(caught_->kind) == kind) {
    trap_ = caught_;
  } else {
    trap(inst, kind < kTrapCount ? static_cast<TrapKind>(kind) : TrapKind::kAssert, "");
  }
}

bool EvalMachine::alive(const Address& address) const {
  if (address.root == nullptr || address.frame == 0) {
    return address.root != nullptr;
  }
  for (const Frame* frame : stack_) {
    if (frame->serial == address.frame) {
      return true;
    }
  }
  return false;
}

void EvalMachine::run_frame(Frame& frame) {
  frame.ran = true;
  stack_.push_back(&frame);
  for (BlockId block(0); block.valid();) {
    const BlockId ran = block;
    block = run_block(frame, block);
    if (trap_) {
      block = caught_by(frame, ran);
    }
  }
  stack_.pop_back();
  if (references_ != nullptr) {
    references_->leave(frame.serial);
  }
}

BlockId EvalMachine::caught_by(Frame& frame, BlockId block) {
  const BlockId handler = frame.pou->blocks[block.index].handler;
  if (!handler.valid() || !can_be_caught(trap_->kind)) {
    return BlockId();
  }
  caught_ = std::move(trap_);
  trap_.reset();
  frame.callee.reset();
  return handler;
}

static bool may_write(Op op) {
  return op == Op::kStore || op == Op::kCopy || op == Op::kInit || op == Op::kCallNative;
}

BlockId EvalMachine::run_block(Frame& frame, BlockId block) {
  for (const Inst& inst : frame.pou->blocks[block.index].insts) {
    if (*budget_ == 0) {
      trap(inst, TrapKind::kFuel, "");
    } else {
      --*budget_;
    }
    if (!trap_ && is_terminator(inst.op)) {
      return run_terminator(frame, inst);
    }
    if (!trap_) {
      run_inst(frame, inst);
      if (written && may_write(inst.op)) written();
    }
    if (trap_) {
      break;
    }
  }
  return BlockId();
}

BlockId EvalMachine::run_terminator(Frame& frame, const Inst& inst) {
  switch (inst.op) {
    case Op::kJump:
    case Op::kTry:
    case Op::kEndTry:
      return take(frame, inst.targets[0]);
    case Op::kBranch:
    case Op::kSwitch:
      return take(frame, taken_target(inst, bits(frame, inst.operands[0])));
    case Op::kTrap:
      trap(inst, inst.trap, "");
      return BlockId();
    case Op::kTrapAgain:
      trap_again(inst, static_cast<uint32_t>(bits(frame, inst.operands[0])));
      return BlockId();
    default:
      return BlockId();
  }
}

// All arguments are read before the first parameter changes: a block may pass its
// own parameters to itself.
BlockId EvalMachine::take(Frame& frame, const Target& target) {
  std::vector<EvalValue> args;
  for (const ValueId arg : target.args) {
    args.push_back(frame.values[arg.index]);
  }
  const std::vector<ValueId>& params = frame.pou->blocks[target.block.index].params;
  for (size_t i = 0; i < params.size(); ++i) {
    frame.values[params[i].index] = args[i];
  }
  return target.block;
}

void EvalMachine::run_inst(Frame& frame, const Inst& inst) {
  switch (inst.op) {
    case Op::kLoad:
    case Op::kStore:
    case Op::kCopy:
    case Op::kInit:
      return run_memory(frame, inst);
    case Op::kAddress:
    case Op::kString:
      return run_string_or_address(frame, inst);
    case Op::kHandle:
    case Op::kFlat:
    case Op::kUnflat:
      return run_handle(frame, inst);
    case Op::kCallFunction:
      return run_call_function(frame, inst);
    case Op::kCallInstance:
      return run_call_instance(frame, inst);
    case Op::kCallNative:
      return run_native(frame, inst);
    case Op::kThis:
    case Op::kIsType:
    case Op::kTrapKind:
    case Op::kCallMethod:
    case Op::kCallBody:
    case Op::kCallVirtual:
    case Op::kCallReference:
      return run_object(frame, inst);
    case Op::kAdvanceTime:
      now_ns_ =
          static_cast<int64_t>(static_cast<uint64_t>(now_ns_) + bits(frame, inst.operands[0]));
      return;
    default:
      break;
  }
  Outcome outcome = compute(frame, inst);
  if (outcome.trap) {
    trap(inst, *outcome.trap, std::move(outcome.text));
  } else {
    frame.values[inst.result.index].bits = outcome.bits;
  }
}

Outcome EvalMachine::compute(const Frame& frame, const Inst& inst) const {
  const auto operand = [&](size_t i) { return bits(frame, inst.operands[i]); };
  switch (inst.op) {
    case Op::kConst:
      return {canonical(inst.scalar, inst.imm), {}, {}};
    case Op::kTaskTime:
      return {static_cast<uint64_t>(now_ns_), {}, {}};
    case Op::kMoveHandle:
      return {references_->move(operand(0), operand(1)), {}, {}};
    case Op::kSizeOf: {
      const TypeLayout& layout = (*layouts_)[inst.type];
      const bool area = program_.types.is_instance(inst.type);
      return {area ? layout.used : layout.size, {}, {}};
    }
    default:
      break;
  }
  std::array<uint64_t, 3> operands{};
  for (size_t i = 0; i < inst.operands.size(); ++i) operands[i] = operand(i);
  return eval_operation(inst, frame.pou->values[inst.operands[0].index].scalar, operands);
}

bool EvalMachine::too_deep(const Pou& pou) const {
  const auto active = std::count_if(stack_.begin(), stack_.end(),
                                    [&pou](const Frame* frame) { return frame->pou == &pou; });
  return stack_.size() >= base::kMaxCallDepth ||
         (pou.recursion_depth != 0 && active >= static_cast<int64_t>(pou.recursion_depth));
}

void EvalMachine::run_call_function(Frame& frame, const Inst& inst) {
  Frame& callee = next_callee(frame, inst.pou);
  if (too_deep(*callee.pou)) {
    return trap(inst, TrapKind::kStack, callee.pou->name);
  }
  run_frame(callee);
}

void EvalMachine::run_call_instance(Frame& frame, const Inst& inst) {
  const Address instance = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  Variable* const entered =
      instance.variable->slot ? instance.variable->target.variable : instance.variable;
  call_body(frame, inst, entered->type, entered);
}

}  // namespace ir
