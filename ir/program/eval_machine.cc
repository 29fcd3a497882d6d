#include "ir/program/eval_machine.h"

#include "base/limits.h"
#include "ir/program/ops.h"

namespace ir {

std::optional<EvalTrap> EvalMachine::run(Variable& instance, int64_t now_ns, uint64_t& budget) {
  now_ns_ = now_ns;
  budget_ = &budget;
  trap_.reset();
  const PouId pou = program_.pou_of_instance_type(instance.type);
  const std::unique_ptr<Frame> frame = make_frame(program_.pous[pou.index], &instance);
  run_frame(*frame);
  return trap_;
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

bool EvalMachine::alive(const Address& address) const {
  if (address.variable == nullptr || address.frame == 0) {
    return address.variable != nullptr;
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
    block = run_block(frame, block);
  }
  stack_.pop_back();
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
      return take(frame, inst.targets[0]);
    case Op::kBranch:
      return take(frame, inst.targets[bits(frame, inst.operands[0]) != 0 ? 0 : 1]);
    case Op::kTrap:
      trap(inst, inst.trap, "");
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
    case Op::kCallFunction:
      return run_call_function(frame, inst);
    case Op::kCallInstance:
      return run_call_instance(frame, inst);
    case Op::kCallNative:
      return run_native(frame, inst);
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
    case Op::kNeg:
    case Op::kAbs:
    case Op::kSqrt:
    case Op::kNot:
      return {eval_unary(inst.op, inst.scalar, operand(0)), {}, {}};
    case Op::kShl:
    case Op::kShr:
    case Op::kRol:
    case Op::kRor:
      return {
          eval_shift(inst.op, inst.scalar, operand(0), static_cast<uint32_t>(operand(1))), {}, {}};
    case Op::kSelect:
      return {operand(operand(0) != 0 ? 2 : 1), {}, {}};
    case Op::kWrap:
    case Op::kToFloat:
    case Op::kRound:
    case Op::kTrunc:
    case Op::kToBool:
    case Op::kBits:
      return eval_conversion(inst.op, frame.pou->values[inst.operands[0].index].scalar, inst.scalar,
                             operand(0));
    case Op::kCheckRange:
      return eval_check_range(inst.scalar, operand(0), inst.low, inst.high);
    case Op::kCheckStep:
      return operand(0) != 0 ? Outcome{operand(0), {}, {}} : Outcome{0, TrapKind::kForStep, "BY 0"};
    default:
      return eval_binary(inst.op, inst.scalar, operand(0), operand(1));
  }
}

void EvalMachine::run_call_function(Frame& frame, const Inst& inst) {
  Frame& callee = next_callee(frame, inst.pou);
  if (stack_.size() >= base::kMaxCallDepth) {
    return trap(inst, TrapKind::kStack, callee.pou->name);
  }
  run_frame(callee);
}

void EvalMachine::run_call_instance(Frame& frame, const Inst& inst) {
  const Address instance = locate(frame, inst, inst.place);
  if (trap_) {
    return;
  }
  frame.callee.reset();
  const auto [known, is_new] = pou_of_type_.try_emplace(instance.variable->type);
  if (is_new) {
    known->second = program_.pou_of_instance_type(instance.variable->type);
  }
  if (!known->second.valid()) {
    return trap(inst, TrapKind::kInstance, program_.types.text(instance.variable->type));
  }
  const Pou& pou = program_.pous[known->second.index];
  if (stack_.size() >= base::kMaxCallDepth) {
    return trap(inst, TrapKind::kStack, pou.name);
  }
  run_frame(*make_frame(pou, instance.variable));
}

}  // namespace ir
