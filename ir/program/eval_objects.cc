// References to instances, methods, virtual calls.
#include <algorithm>

#include "base/limits.h"
#include "ir/program/eval_machine.h"

namespace ir {

void EvalMachine::run_object(Frame& frame, const Inst& inst) {
  switch (inst.op) {
    case Op::kThis:
      frame.values[inst.result.index].bits = references_->handle_of_instance(*frame.self);
      return;
    case Op::kTrapKind:
      frame.values[inst.result.index].bits =
          static_cast<uint64_t>(caught_ ? caught_->kind : TrapKind::kDivisionByZero);
      return;
    case Op::kIsType: {
      const Variable* instance = references_->instance_of(bits(frame, inst.operands[0]));
      frame.values[inst.result.index].bits =
          instance != nullptr && program_.types.is_a(instance->type, inst.type);
      return;
    }
    case Op::kCallMethod:
      return run_call_method(frame, inst);
    case Op::kCallBody:
      return call_body(frame, inst, program_.pous[inst.pou.index].self, frame.self);
    case Op::kCallVirtual:
      return run_call_virtual(frame, inst);
    default:
      return run_call_reference(frame, inst);
  }
}

Variable* EvalMachine::referenced(Frame& frame, const Inst& inst, TypeId type) {
  Variable* const instance = references_->instance_of(bits(frame, inst.operands[0]));
  if (instance != nullptr && program_.types.is_a(instance->type, type)) {
    return instance;
  }
  trap(inst, TrapKind::kReference, "");
  return nullptr;
}

void EvalMachine::run_call_method(Frame& frame, const Inst& inst) {
  Variable* instance = frame.self;
  if (inst.place.valid()) {
    instance = locate(frame, inst, inst.place).variable;
  } else if (!inst.operands.empty()) {
    instance = referenced(frame, inst, program_.pous[inst.pou.index].self);
  }
  if (trap_) {
    return;
  }
  instance = instance->slot ? instance->target.variable : instance;
  call_method(frame, inst, inst.pou, inst.pou, instance);
}

void EvalMachine::run_call_virtual(Frame& frame, const Inst& inst) {
  Variable* const instance = referenced(frame, inst, program_.pous[inst.pou.index].self);
  if (instance == nullptr) {
    return;
  }
  const auto row =
      std::find_if(program_.overrides.begin(), program_.overrides.end(), [&](const Override& each) {
        return each.type == instance->type && each.prototype == inst.pou;
      });
  if (row == program_.overrides.end()) {
    return trap(inst, TrapKind::kReference, "");
  }
  call_method(frame, inst, inst.pou, row->target, instance);
}

void EvalMachine::run_call_reference(Frame& frame, const Inst& inst) {
  if (Variable* const instance = referenced(frame, inst, inst.type)) {
    call_body(frame, inst, instance->type, instance);
  }
}

// The caller writes arguments and reads results by the locals of `named`, whose
// parameters are those of `target`; what is no parameter is the target's own.
void EvalMachine::call_method(Frame& frame, const Inst& inst, PouId named, PouId target,
                              Variable* instance) {
  Frame& arguments = next_callee(frame, named);
  const Pou& pou = program_.pous[target.index];
  if (too_deep(pou)) {
    return trap(inst, TrapKind::kStack, pou.name);
  }
  arguments.self = instance;
  if (target == named) {
    return run_frame(arguments);
  }
  const std::unique_ptr<Frame> callee = make_frame(pou, instance);
  for (size_t i = 0; i < pou.locals.size() && pou.locals[i].kind != LocalKind::kTemp; ++i) {
    std::swap(callee->locals[i], arguments.locals[i]);
  }
  arguments.ran = true;
  run_frame(*callee);
  for (size_t i = 0; i < pou.locals.size() && pou.locals[i].kind != LocalKind::kTemp; ++i) {
    std::swap(callee->locals[i], arguments.locals[i]);
  }
}

void EvalMachine::call_body(Frame& frame, const Inst& inst, TypeId type, Variable* instance) {
  frame.callee.reset();
  const auto [known, is_new] = pou_of_type_.try_emplace(type);
  if (is_new) {
    known->second = program_.pou_of_instance_type(type);
  }
  if (!known->second.valid()) {
    return trap(inst, TrapKind::kInstance, program_.types.text(type));
  }
  const Pou& pou = program_.pous[known->second.index];
  if (too_deep(pou)) {
    return trap(inst, TrapKind::kStack, pou.name);
  }
  run_frame(*make_frame(pou, instance));
}

}  // namespace ir
