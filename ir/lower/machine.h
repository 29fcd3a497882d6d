// Code between selection and emission: bytecode instructions over an unlimited
// number of registers. A register is a scalar frame slot to be: a temporary whose
// slot the allocator picks, or a named local whose slot is fixed.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/object.h"

namespace ir::codegen {

inline constexpr uint32_t kNoNumber = 0xffffffffu;

enum class OperandKind : uint8_t {
  kEmpty,
  kRegister,   // index: Machine::registers
  kSlot,       // index: Object::slots; argument slots of the next frame
  kPlace,      // index: Object::places, relative to `base`
  kConstant,   // index: Object::constants
  kImmediate,  // index: the field itself
};

struct Operand {
  OperandKind kind = OperandKind::kEmpty;
  Base base = Base::kFrame;
  uint32_t index = 0;

  static Operand reg(uint32_t i) { return {OperandKind::kRegister, Base::kFrame, i}; }
  static Operand slot(uint32_t i) { return {OperandKind::kSlot, Base::kFrame, i}; }
  static Operand place(Base base, uint32_t i) { return {OperandKind::kPlace, base, i}; }
  static Operand constant(uint32_t i) { return {OperandKind::kConstant, Base::kConst, i}; }
  static Operand immediate(uint32_t i) { return {OperandKind::kImmediate, Base::kFrame, i}; }
  bool none() const { return kind == OperandKind::kEmpty; }
  bool is_register() const { return kind == OperandKind::kRegister; }
  friend bool operator==(const Operand&, const Operand&) = default;
};

struct MachineInst {
  Opcode op = Opcode::RET;
  Operand a, b, c;
  uint32_t x = 0;  // fields of the extension that are no operand's place
  uint32_t y = 0;
  uint32_t line = 0;
};

struct Register {
  Class cls = Class::kB;
  Region region;              // kA: what it points to
  uint32_t slot = kNoNumber;  // fixed slot of a named local
  bool pinned = false;        // its address was taken: it lives from its first write on
  bool single_use = false;
  bool result = false;  // read by the caller after the return
};

// kSwitch: the last instruction is a SWITCH.
enum class EndKind : uint8_t { kJump, kBranch, kSwitch, kReturn, kTrap, kTry, kEndTry, kInst };

struct BlockEnd {
  EndKind kind = EndKind::kReturn;  // kInst: the last instruction leads nowhere
  Operand condition;                // kBranch; TRUE: taken
  uint32_t taken = 0;  // position of a block; kJump, kEndTry, the body of kTry, no entry of kSwitch
  uint32_t other = 0;  // position of a block, kBranch; the handler of kTry
  uint32_t trap = 0;
  uint32_t line = 0;
  std::vector<uint32_t> table = {};  // kSwitch: positions of blocks after this one
};

struct MachineBlock {
  std::vector<MachineInst> insts;
  BlockEnd end;
  uint32_t handler = kNoNumber;  // position: where its traps go on
};

struct Machine {
  std::vector<Register> registers;
  std::vector<MachineBlock> blocks;  // in order of emission
};

// Calls visit(register, reads, writes) for every register operand.
template <class Visit>
void for_each_register(const MachineInst& inst, Visit visit) {
  const OpcodeRow& row = opcode_row(inst.op);
  const Field* fields[] = {&row.a, &row.b, &row.c};
  const Operand* operands[] = {&inst.a, &inst.b, &inst.c};
  for (int i = 0; i < 3; ++i) {
    if (operands[i]->is_register()) {
      visit(operands[i]->index, fields[i]->reads(), fields[i]->writes());
    }
  }
}

template <class Visit>
void for_each_successor(const BlockEnd& end, Visit visit) {
  const bool leaves = end.kind == EndKind::kReturn || end.kind == EndKind::kTrap;
  if (leaves || end.kind == EndKind::kInst) return;
  visit(end.taken);
  if (end.kind == EndKind::kBranch || end.kind == EndKind::kTry) visit(end.other);
  for (const uint32_t entry : end.table) visit(entry);
}

}  // namespace ir::codegen
