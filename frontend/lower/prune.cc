// Blocks are put into the order in which they were written, which is source order.
// What nothing reaches is removed, with the values and places only it used: later
// phases refuse unreachable code.
#include "frontend/lower/builder.h"

namespace frontend {
namespace {

using ir::BlockId;
using ir::ValueId;

std::vector<bool> reachable_blocks(const ir::Pou& pou) {
  std::vector<bool> seen(pou.blocks.size());
  std::vector<uint32_t> work{0};
  seen[0] = true;
  while (!work.empty()) {
    const ir::Block& block = pou.blocks[work.back()];
    work.pop_back();
    if (block.insts.empty()) continue;
    for (const ir::Target& target : block.insts.back().targets) {
      if (seen[target.block.index]) continue;
      seen[target.block.index] = true;
      work.push_back(target.block.index);
    }
  }
  return seen;
}

// Are values and places numbered in order of their appearance? They are made in that order, but for
// parameters of blocks; what a block that goes has made leaves gaps.
bool has_gaps(const ir::Pou& pou, const std::vector<bool>& live) {
  for (size_t b = 0; b < live.size(); ++b) {
    if (!pou.blocks[b].params.empty()) return true;
    if (live[b]) continue;
    for (const ir::Inst& inst : pou.blocks[b].insts) {
      if (inst.result.valid() || inst.place.valid()) return true;
    }
  }
  return false;
}

// Gives values and places new numbers in order of their appearance.
class Renumber {
 public:
  explicit Renumber(ir::Pou& pou)
      : pou_(pou), values_(pou.values.size()), places_(pou.places.size()) {}

  void run() {
    for (ir::Block& block : pou_.blocks) {
      for (ValueId& param : block.params) define(param);
      for (ir::Inst& inst : block.insts) {
        if (inst.result.valid()) define(inst.result);
      }
    }
    for (ir::Block& block : pou_.blocks) {
      for (ir::Inst& inst : block.insts) rewrite(inst);
    }
    pou_.values = std::move(new_values_);
    pou_.places = std::move(new_places_);
  }

 private:
  void define(ValueId& value) {
    values_[value.index] = ValueId(static_cast<uint32_t>(new_values_.size()));
    new_values_.push_back(pou_.values[value.index]);
    value = values_[value.index];
  }
  void use(ValueId& value) {
    if (value.valid()) value = values_[value.index];
  }
  void use(ir::PlaceId& id) {
    if (!id.valid()) return;
    ir::PlaceId& renamed = places_[id.index];
    if (!renamed.valid()) {
      ir::Place place = std::move(pou_.places[id.index]);
      use(place.value);
      for (ir::Step& step : place.steps) use(step.value);
      renamed = ir::PlaceId(static_cast<uint32_t>(new_places_.size()));
      new_places_.push_back(std::move(place));
    }
    id = renamed;
  }
  void rewrite(ir::Inst& inst) {
    for (ValueId& operand : inst.operands) use(operand);
    use(inst.place);
    use(inst.place2);
    for (ir::Target& target : inst.targets) {
      for (ValueId& arg : target.args) use(arg);
    }
  }

  ir::Pou& pou_;
  std::vector<ValueId> values_;
  std::vector<ir::PlaceId> places_;
  std::vector<ir::Value> new_values_;
  std::vector<ir::Place> new_places_;
};

}  // namespace

void Builder::finish() {
  if (current_.valid()) ret();
  std::vector<bool> live = reachable_blocks(pou_);
  const bool gaps = has_gaps(pou_, live);
  std::vector<BlockId> renamed(live.size());
  std::vector<ir::Block> blocks;
  blocks.reserve(pou_.blocks.size());
  bool in_order = true;
  for (BlockId id : order_) {
    if (!live[id.index]) continue;
    in_order = in_order && id.index == blocks.size();
    renamed[id.index] = BlockId(static_cast<uint32_t>(blocks.size()));
    blocks.push_back(std::move(pou_.blocks[id.index]));
  }
  in_order = in_order && blocks.size() == live.size();
  pou_.blocks = std::move(blocks);
  if (in_order) return;
  for (ir::Block& block : pou_.blocks) {
    if (block.handler.valid()) block.handler = renamed[block.handler.index];
    for (ir::Target& target : block.insts.back().targets) {
      target.block = renamed[target.block.index];
    }
  }
  if (gaps) Renumber(pou_).run();
}

}  // namespace frontend
