// Rules of single instructions: what each operation takes and gives, and that
// everything that it refers to exists.
#include <string>

#include "ir/program/ops.h"
#include "ir/program/text_names.h"
#include "ir/program/verify_memory.h"
#include "ir/program/verify_parts.h"
#include "stdlib/native/natives.h"

namespace ir {
namespace {

bool is_numeric(Scalar s) { return is_integer(s) || is_float(s); }
bool is_bits(Scalar s) { return is_integer(s) || s == Scalar::kBool; }
bool is_plain(Scalar s) { return is_numeric(s) || s == Scalar::kBool; }

class InstVerifier {
 public:
  InstVerifier(const Program& program, const Pou& pou, const Definitions& definitions)
      : program_(program), pou_(pou), memory_(program, pou, definitions) {}

  // The first reason found; empty when the instruction is right.
  std::string check(const Inst& inst) {
    reason_.clear();
    check_form(inst);
    if (reason_.empty()) {
      check_operation(inst);
    }
    return reason_;
  }

 private:
  void fail(const std::string& why) {
    if (reason_.empty()) {
      reason_ = why;
    }
  }
  void require(bool holds, const char* why) {
    if (!holds) {
      fail(why);
    }
  }

  Scalar scalar_of(ValueId value) const { return pou_.values[value.index].scalar; }
  Scalar operand(const Inst& inst, size_t i) const { return scalar_of(inst.operands[i]); }

  // Numbers of operands, targets and results, and ids in range.
  void check_form(const Inst& inst) {
    const int operands = op_operand_count(inst.op);
    require(operands < 0 || inst.operands.size() == static_cast<size_t>(operands),
            "number of operands");
    for (const ValueId value : inst.operands) {
      require(value.index < pou_.values.size(), "an operand is no value");
    }
    require(op_has_result(inst.op) || !inst.result.valid(), "it has no result");
    require(inst.result.valid() || !op_has_result(inst.op) || inst.op == Op::kCallNative,
            "it needs a result");
    if (inst.result.valid() && reason_.empty()) {
      require(scalar_of(inst.result) == result_scalar(inst), "its result has another type");
    }
    require(inst.targets.size() == target_count(inst), "number of targets");
    for (const Target& target : inst.targets) {
      check_target(target);
    }
  }

  void check_target(const Target& target) {
    if (target.block.index >= pou_.blocks.size()) {
      return fail("jump to a block that does not exist");
    }
    const std::vector<ValueId>& params = pou_.blocks[target.block.index].params;
    require(params.size() == target.args.size(), "number of block arguments");
    for (size_t i = 0; i < target.args.size() && reason_.empty(); ++i) {
      require(target.args[i].index < pou_.values.size(), "a block argument is no value");
      if (reason_.empty()) {
        require(scalar_of(target.args[i]) == scalar_of(params[i]),
                "a block argument has another type than the parameter");
      }
    }
  }

  void require_operands(const Inst& inst, bool fits) {
    require(fits, "the operation is not defined for its type");
    for (const ValueId value : inst.operands) {
      require(scalar_of(value) == inst.scalar, "operand of another type");
    }
  }

  void check_operation(const Inst& inst) {
    switch (inst.op) {
      case Op::kConst:
        require(is_plain(inst.scalar), "constant of an address or string");
        break;
      case Op::kLoad:
      case Op::kStore:
      case Op::kCopy:
      case Op::kInit:
      case Op::kAddress:
      case Op::kString:
      case Op::kHandle:
      case Op::kCallInstance:
        fail(memory_.check(inst));
        break;
      case Op::kShl:
      case Op::kShr:
      case Op::kRol:
      case Op::kRor:
        require(is_integer(inst.scalar) && operand(inst, 0) == inst.scalar &&
                    operand(inst, 1) == Scalar::kU32,
                "a shift takes an integer of its type and a u32");
        break;
      case Op::kSelect:
        require(is_plain(inst.scalar) && operand(inst, 0) == Scalar::kBool &&
                    operand(inst, 1) == inst.scalar && operand(inst, 2) == inst.scalar,
                "select takes a bool and two values of its type");
        break;
      case Op::kWrap:
      case Op::kToFloat:
      case Op::kRound:
      case Op::kTrunc:
      case Op::kToBool:
      case Op::kBits:
        require(conversion_fits(inst.op, operand(inst, 0), inst.scalar),
                "there is no such conversion");
        break;
      case Op::kCallFunction:
        require(inst.pou.index < program_.pous.size() &&
                    program_.pous[inst.pou.index].kind == PouKind::kFunction,
                "call of something that is no function");
        break;
      case Op::kCallNative:
        check_native(inst);
        break;
      case Op::kThis:
        require(inst.scalar == Scalar::kU64 && types().is_instance(pou_.self),
                "there is no own instance, or its reference is not u64");
        break;
      case Op::kTrapKind:
        require(inst.scalar == Scalar::kU32, "the kind of a trap is u32");
        break;
      case Op::kIsType:
        check_reference(inst);
        require(types().contains(inst.type) &&
                    (types()[inst.type].kind == Kind::kInterface || types().is_instance(inst.type)),
                "the type is no block and no interface");
        break;
      case Op::kCallReference:
        check_reference(inst);
        require(types().is_instance(inst.type), "the type is no block");
        break;
      case Op::kCallMethod:
      case Op::kCallVirtual:
      case Op::kCallBody:
        check_method_call(inst);
        break;
      case Op::kMoveHandle:
        require(inst.scalar == Scalar::kU64 && operand(inst, 0) == Scalar::kU64 &&
                    (operand(inst, 1) == Scalar::kU64 || operand(inst, 1) == Scalar::kI64),
                "a handle is u64 and moves by a u64 or i64");
        break;
      case Op::kFlat:
        require(inst.scalar == Scalar::kU32 && operand(inst, 0) == Scalar::kU64,
                "flat takes a u64 and gives a u32");
        break;
      case Op::kUnflat:
        require(inst.scalar == Scalar::kU64 && operand(inst, 0) == Scalar::kU32,
                "unflat takes a u32 and gives a u64");
        break;
      case Op::kSizeOf:
        require(inst.scalar == Scalar::kU32 && program_.types.contains(inst.type),
                "size_of gives a u32 and needs a type");
        break;
      case Op::kTaskTime:
        require(inst.scalar == Scalar::kI64, "the task's time is i64");
        break;
      case Op::kAdvanceTime:
        require(operand(inst, 0) == Scalar::kI64, "time advances by an i64");
        break;
      case Op::kBranch:
        require(operand(inst, 0) == Scalar::kBool, "a branch takes a bool");
        break;
      case Op::kSwitch:
        require_operands(inst, is_integer(inst.scalar));
        require(inst.low <= inst.high && fits_switch(inst.scalar, inst.low) &&
                    fits_switch(inst.scalar, inst.high),
                "the range of a switch is empty, or beyond its type or i32");
        break;
      case Op::kTrapAgain:
        require(operand(inst, 0) == Scalar::kU32, "the kind of a trap is u32");
        break;
      case Op::kTrap:
        require(static_cast<uint32_t>(inst.trap) < kTrapCount, "unknown trap");
        break;
      default:
        check_arithmetic(inst);
    }
  }

  const TypeTable& types() const { return program_.types; }

  void check_reference(const Inst& inst) {
    require(operand(inst, 0) == Scalar::kU64, "a reference is u64");
  }

  void check_method_call(const Inst& inst) {
    if (inst.pou.index >= program_.pous.size()) {
      return fail("call of a POU that does not exist");
    }
    const Pou& callee = program_.pous[inst.pou.index];
    if (inst.op == Op::kCallBody) {
      require(callee.kind == PouKind::kFunctionBlock && pou_.self.valid() &&
                  callee.self != pou_.self && types().is_a(pou_.self, callee.self),
              "the POU is no base of this one");
      return;
    }
    require(callee.kind == PouKind::kMethod, "call of something that is no method");
    require(inst.op == Op::kCallVirtual || types().is_instance(callee.self),
            "methods of interfaces are called as virtual ones");
    require(inst.operands.size() + inst.place.valid() <= 1, "number of operands");
    if (!inst.operands.empty()) {
      return check_reference(inst);
    }
    if (inst.place.valid() && reason_.empty()) {
      return fail(memory_.check(inst));
    }
    require(pou_.self.valid() && types().is_a(pou_.self, callee.self),
            "the own instance has no such method");
  }

  static bool conversion_fits(Op op, Scalar from, Scalar to) {
    switch (op) {
      case Op::kWrap:
        return is_bits(from) && is_integer(to);
      case Op::kToFloat:
        return is_numeric(from) && is_float(to);
      case Op::kRound:
      case Op::kTrunc:
        return is_float(from) && is_integer(to);
      case Op::kToBool:
        return is_integer(from) && to == Scalar::kBool;
      default:
        return is_plain(from) && is_plain(to) && scalar_size(from) == scalar_size(to) &&
               from != Scalar::kBool && to != Scalar::kBool;
    }
  }

  void check_arithmetic(const Inst& inst) {
    switch (inst.op) {
      case Op::kAdd:
      case Op::kSub:
      case Op::kMul:
      case Op::kDiv:
      case Op::kNeg:
      case Op::kAbs:
      case Op::kMin:
      case Op::kMax:
      case Op::kLt:
      case Op::kLe:
        require_operands(inst, is_numeric(inst.scalar));
        break;
      case Op::kMod:
      case Op::kCheckRange:
      case Op::kCheckStep:
        require_operands(inst, is_integer(inst.scalar));
        break;
      case Op::kSqrt:
        require_operands(inst, is_float(inst.scalar));
        break;
      case Op::kAnd:
      case Op::kOr:
      case Op::kXor:
      case Op::kNot:
        require_operands(inst, is_bits(inst.scalar));
        break;
      case Op::kEq:
      case Op::kNe:
        require_operands(inst, is_plain(inst.scalar));
        break;
      default:
        break;
    }
  }

  void check_native(const Inst& inst) {
    if (inst.native >= stdlib::native_count()) {
      return fail("there is no such native function");
    }
    const stdlib::NativeRow& row = stdlib::native_row(inst.native);
    require(row.arguments.size() == inst.operands.size(), "number of arguments");
    for (size_t i = 0; i < inst.operands.size() && reason_.empty(); ++i) {
      require(operand(inst, i) == stdlib::native_scalar(row.arguments[i]),
              "argument of another type");
    }
    if (row.result == 'v') {
      require(!inst.result.valid(), "the native function has no result");
      require(reason_.empty() && !inst.operands.empty() && memory_.writable(inst.operands[0]),
              "the result would be written into a constant");
    } else {
      require(inst.scalar == stdlib::native_scalar(row.result), "result of another type");
    }
  }

  const Program& program_;
  const Pou& pou_;
  MemoryVerifier memory_;
  std::string reason_;
};

class PouVerifier {
 public:
  PouVerifier(const Program& program, const Pou& pou)
      : pou_(pou),
        definitions_(pou.values.size()),
        defined_(pou.values.size()),
        insts_(program, pou, definitions_) {}

  base::Status verify() {
    if (pou_.blocks.empty() || !pou_.blocks[0].params.empty()) {
      return not_verified("POU " + pou_.name + ": the entry block is missing or has parameters");
    }
    if (base::Status status = collect_definitions(); !status.ok()) {
      return status;
    }
    for (size_t b = 0; b < pou_.blocks.size(); ++b) {
      if (base::Status status = check_block(b); !status.ok()) {
        return status;
      }
    }
    return base::Ok{};
  }

 private:
  bool define(ValueId value) {
    if (value.index >= defined_.size() || defined_[value.index]) {
      return false;
    }
    defined_[value.index] = true;
    return true;
  }

  base::Status collect_definitions() {
    for (size_t b = 0; b < pou_.blocks.size(); ++b) {
      for (const ValueId param : pou_.blocks[b].params) {
        if (!define(param)) {
          return not_verified("POU " + pou_.name + ", b" + std::to_string(b) +
                              ": a parameter is no value, or defined twice");
        }
      }
      const std::vector<Inst>& insts = pou_.blocks[b].insts;
      for (size_t i = 0; i < insts.size(); ++i) {
        if (insts[i].result.valid() && !define(insts[i].result)) {
          return not_verified(inst_place(pou_, b, i) + "its result is no value, or defined twice");
        }
        if (insts[i].result.valid()) {
          definitions_[insts[i].result.index] = &insts[i];
        }
      }
    }
    return base::Ok{};
  }

  base::Status check_block(size_t b) {
    const std::vector<Inst>& insts = pou_.blocks[b].insts;
    if (insts.empty()) {
      return not_verified("POU " + pou_.name + ", b" + std::to_string(b) + " is empty");
    }
    for (size_t i = 0; i < insts.size(); ++i) {
      if (is_terminator(insts[i].op) != (i + 1 == insts.size())) {
        return not_verified(inst_place(pou_, b, i) +
                            "a block has exactly one terminator, at its end");
      }
      if (const std::string reason = insts_.check(insts[i]); !reason.empty()) {
        return not_verified(inst_place(pou_, b, i) + reason);
      }
    }
    return base::Ok{};
  }

  const Pou& pou_;
  Definitions definitions_;
  std::vector<bool> defined_;
  InstVerifier insts_;
};

}  // namespace

base::Status verify_instructions(const Program& program, const Pou& pou) {
  return PouVerifier(program, pou).verify();
}

std::string inst_place(const Pou& pou, size_t block, size_t inst) {
  const Inst& at = pou.blocks[block].insts[inst];
  return "POU " + pou.name + ", b" + std::to_string(block) + ", instruction " +
         std::to_string(inst) + " (" + std::string(op_name(at.op)) + ", line " +
         std::to_string(at.line) + "): ";
}

}  // namespace ir
