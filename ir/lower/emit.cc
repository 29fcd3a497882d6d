#include "ir/lower/emit.h"

#include <algorithm>

namespace ir::codegen {
namespace {

class Emitter {
 public:
  Emitter(const Machine& machine, const Liveness& liveness, Object& object)
      : machine_(machine), liveness_(liveness), object_(object) {}

  base::Status run() {
    const size_t blocks = machine_.blocks.size();
    starts_.resize(blocks);
    jumped_to_.resize(blocks, false);
    for (uint32_t position = 0; position < blocks; ++position) emit_block(position);
    if (too_many_) return base::Error{base::Refusal::kTooMany, too_many_text()};
    patch_jumps();
    add_merges();
    return base::Ok{};
  }

 private:
  struct Jump {
    uint32_t unit;
    uint32_t target;  // position of a block
  };

  std::string too_many_text() const {
    return "POU `" + object_.name +
           "` uses more than 65,535 variables, constants or temporaries (" +
           std::to_string(object_.slots.size()) + " slots, " +
           std::to_string(object_.places.size()) + " places, " +
           std::to_string(object_.constants.size()) + " constants). Divide it into several POUs.";
  }

  uint32_t here() const { return static_cast<uint32_t>(object_.code.size()); }

  void mark_line(uint32_t line) {
    if (line == 0 || (!object_.lines.empty() && object_.lines.back().line == line)) return;
    object_.lines.push_back({here(), line});
  }

  uint32_t number_of(const Operand& operand) const {
    switch (operand.kind) {
      case OperandKind::kRegister:
        return machine_.registers[operand.index].slot;
      case OperandKind::kPlace:
        return operand.base == Base::kFrame
                   ? static_cast<uint32_t>(object_.slots.size()) + operand.index
                   : operand.index;
      default:
        return operand.index;
    }
  }

  static Base base_of(const Operand& operand) {
    if (operand.kind == OperandKind::kConstant) return Base::kConst;
    return operand.kind == OperandKind::kPlace ? operand.base : Base::kFrame;
  }

  // BASE fields say only the base, their offset is in the extension.
  uint16_t field(const Field& field, const Operand& operand) {
    if (operand.none() || field.kind == FieldKind::kBase) return 0;
    const uint32_t number = number_of(operand);
    too_many_ |= number > 0xffff;
    return static_cast<uint16_t>(number);
  }

  void emit_inst(const MachineInst& inst) {
    const OpcodeRow& row = opcode_row(inst.op);
    mark_line(inst.line);
    Unit unit = Unit::make(inst.op, base_of(inst.a), base_of(inst.b), base_of(inst.c));
    unit.a = field(row.a, inst.a);
    if (row.b.kind == FieldKind::kBc32) {
      unit.set_bc(inst.b.index);
    } else {
      unit.b = field(row.b, inst.b);
      unit.c = field(row.c, inst.c);
    }
    object_.code.push_back(unit);
    if (row.extended) object_.code.push_back(Unit::extension(inst.x, inst.y));
  }

  void emit_block(uint32_t position) {
    starts_[position] = here();
    const MachineBlock& block = machine_.blocks[position];
    for (const MachineInst& inst : block.insts) emit_inst(inst);
    mark_line(block.end.line);
    switch (block.end.kind) {
      case EndKind::kJump:
        go(position, block.end.taken);
        break;
      case EndKind::kBranch:
        emit_branch(position, block.end);
        break;
      case EndKind::kSwitch:
        for (const uint32_t entry : block.end.table) jump(Unit::make(Opcode::JMP), entry);
        go(position, block.end.taken);
        break;
      case EndKind::kTry:
        jump(Unit::make(Opcode::TRY), block.end.other);
        go(position, block.end.taken);
        break;
      case EndKind::kEndTry:
        object_.code.push_back(Unit::make(Opcode::END_TRY));
        go(position, block.end.taken);
        break;
      case EndKind::kInst:
        break;
      case EndKind::kReturn:
        object_.code.push_back(Unit::make(Opcode::RET));
        break;
      case EndKind::kTrap: {
        Unit unit = Unit::make(Opcode::TRAP);
        unit.a = static_cast<uint16_t>(block.end.trap);
        object_.code.push_back(unit);
        break;
      }
    }
  }

  void go(uint32_t from, uint32_t to) {
    if (to == from + 1) return;
    const MachineBlock& next = machine_.blocks[to];
    if (next.insts.empty() && next.end.kind == EndKind::kReturn) {
      object_.code.push_back(Unit::make(Opcode::RET));
      return;
    }
    jump(Unit::make(to > from ? Opcode::JMP : Opcode::LOOP), to);
  }

  void jump(Unit unit, uint32_t to) {
    jumped_to_[to] = true;
    jumps_.push_back({here(), to});
    object_.code.push_back(unit);
  }

  // Conditional jumps go forwards; order_blocks() sees to it that one side does.
  void emit_branch(uint32_t position, const BlockEnd& end) {
    const bool to_taken =
        end.taken > position && (end.other <= position || end.other == position + 1);
    const Opcode op = to_taken ? Opcode::JT : Opcode::JF;
    Unit unit = Unit::make(op, base_of(end.condition));
    unit.a = field(opcode_row(op).a, end.condition);
    jump(unit, to_taken ? end.taken : end.other);
    go(position, to_taken ? end.other : end.taken);
  }

  void patch_jumps() {
    for (const Jump& jump : jumps_) {
      const int64_t distance = int64_t{starts_[jump.target]} - (int64_t{jump.unit} + 1);
      object_.code[jump.unit].set_bc(static_cast<uint32_t>(static_cast<int32_t>(distance)));
    }
  }

  // Two blocks can start at one unit when the first is empty; both agree then,
  // because nothing happens between them.
  void add_merges() {
    for (uint32_t position = 0; position < starts_.size(); ++position) {
      if (!jumped_to_[position]) continue;
      Merge merge = merge_at(position);
      if (!object_.merges.empty() && object_.merges.back().unit == merge.unit) {
        object_.merges.pop_back();
      }
      object_.merges.push_back(std::move(merge));
    }
  }

  Merge merge_at(uint32_t position) const {
    Merge merge;
    merge.unit = starts_[position];
    RegisterSet held = liveness_.live_in[position];
    for (uint32_t i = 0; i < liveness_.registers.size(); ++i) {
      if (machine_.registers[liveness_.registers[i]].pinned) held.add(i);
    }
    held.intersect(liveness_.assigned_in[position]);
    held.for_each([&](uint32_t i) {
      const uint32_t r = liveness_.registers[i];
      merge.slots.push_back(static_cast<uint16_t>(machine_.registers[r].slot));
    });
    std::sort(merge.slots.begin(), merge.slots.end());
    merge.slots.erase(std::unique(merge.slots.begin(), merge.slots.end()), merge.slots.end());
    return merge;
  }

  const Machine& machine_;
  const Liveness& liveness_;
  Object& object_;
  std::vector<uint32_t> starts_;
  std::vector<bool> jumped_to_;
  std::vector<Jump> jumps_;
  bool too_many_ = false;
};

}  // namespace

base::Status emit_object(const Machine& machine, const Liveness& liveness, Object& object) {
  return Emitter(machine, liveness, object).run();
}

}  // namespace ir::codegen
