// A jump through a table of distances, which stands after the code.
#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {

Label Emitter::label_of(const JumpTable::Way& way) {
  if (places_.blocks[way.block].edges[way.target].empty()) {
    return blocks_[f_.blocks[way.block].end.target[way.target]];
  }
  edges_.push_back({a_.label(), way.block, way.target});
  return edges_.back().label;
}

void Emitter::jump_by_table(Block b, const JumpTable& table) {
  const uint8_t width = f_.blocks[b].end.width;
  const uint8_t value = integer_register(places_.blocks[b].in[0]);
  TableStub stub{a_.label(), {}};
  for (size_t i = 0; i < table.ways.size(); ++i) {
    const bool same = i != 0 && table.ways[i] == table.ways[i - 1];
    stub.entries.push_back(same ? stub.entries.back() : label_of(table.ways[i]));
  }
  a_.alu_imm(Alu::kCmp, Operand::of(value), field(table.ways.size(), width), width);
  a_.jump_if(Condition::kAboveOrEqual, label_of(table.otherwise));
  // A second scratch register: one that something else may need after the jump.
  const uint8_t at = value == kRax ? kRcx : kRax;
  a_.bits_to_float(kFloatScratch, at, 8);
  a_.zero_extend(kScratch, Operand::of(value), width);
  a_.address_of(at, stub.label);
  a_.load_signed(kScratch, Operand::of(Address{at, kScratch, 4, true, 0}), 4);
  a_.alu(Alu::kAdd, kScratch, Operand::of(at), 8);
  a_.float_to_bits(at, kFloatScratch, 8);
  a_.jump_to(kScratch);
  table_stubs_.push_back(std::move(stub));
}

void Emitter::tables() {
  for (const TableStub& table : table_stubs_) {
    a_.bind(table.label);
    for (const Label entry : table.entries) a_.table_entry(table.label, entry);
  }
}

}  // namespace vm::native::x64
