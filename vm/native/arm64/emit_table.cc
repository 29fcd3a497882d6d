// A jump through a table of distances, which stands after the code.
#include "vm/native/arm64/emitter.h"

namespace vm::native::arm64 {

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
  const Place limit{Place::kConstant, false, false, 0, table.ways.size()};
  jump_if(width, Cond::kGeU, places_.blocks[b].in[0], limit, label_of(table.otherwise));
  a_.zero_extend(kScratch, value, width);
  a_.address_of(kAddressScratch, stub.label);
  a_.load(kScratch, {kAddressScratch, kScratch, 2, true, 0}, 4);
  a_.alu(Alu::kSub, kScratch, kAddressScratch, kScratch, 8);
  a_.jump_to(kScratch);
  table_stubs_.push_back(std::move(stub));
}

void Emitter::tables() {
  for (const TableStub& table : table_stubs_) {
    a_.bind(table.label);
    for (const Label entry : table.entries) a_.table_entry(table.label, entry);
  }
}

}  // namespace vm::native::arm64
