// All loops of a POU.
#include "vm/native/walk.h"

namespace vm::native {
namespace {

Ways ways_of(const Function& f) {
  Ways ways(f.blocks.size());
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const End& end = f.blocks[b].end;
    for (uint32_t way = 0; way < 2; ++way) {
      if (end.target[way] != kNone) ways[end.target[way]].push_back({b, way});
    }
  }
  return ways;
}

std::vector<uint32_t> count_uses(const Function& f) {
  std::vector<uint32_t> uses(f.values.size(), 0);
  const auto use = [&](Val v) {
    if (v != kNone) ++uses[v];
  };
  for (const BasicBlock& block : f.blocks) {
    for (const uint32_t number : block.nodes) {
      const Node& n = f.nodes[number];
      for (const Val v : n.in) use(v);
      use(n.mem.index);
      use(n.mem.pointer);
      if (n.exit == kNone) continue;
      for (const SlotValue& slot : f.exits[n.exit].slots) use(slot.value);
    }
    for (const Val v : block.end.in) use(v);
    for (const std::vector<Val>& args : block.end.args) {
      for (const Val v : args) use(v);
    }
    for (const Reload& reload : block.reloads) use(reload.value);
    for (const SlotValue& slot : block.dirty) use(slot.value);
    if (block.end.exit == kNone) continue;
    for (const SlotValue& slot : f.exits[block.end.exit].slots) use(slot.value);
  }
  return uses;
}

void rename(Function& f, const Renames& renames) {
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const auto change = [&](Val& v) {
      const Renamed* const found = renames.find(v);
      if (found != nullptr && (b < found->head || b > found->last)) v = found->to;
    };
    const auto exit = [&](uint32_t number) {
      if (number == kNone) return;
      for (SlotValue& slot : f.exits[number].slots) change(slot.value);
    };
    BasicBlock& block = f.blocks[b];
    for (const uint32_t number : block.nodes) {
      Node& n = f.nodes[number];
      for (Val& v : n.in) change(v);
      change(n.mem.index);
      change(n.mem.pointer);
      exit(n.exit);
    }
    for (Val& v : block.end.in) change(v);
    for (std::vector<Val>& args : block.end.args) {
      for (Val& v : args) change(v);
    }
    exit(block.end.exit);
    for (Reload& reload : block.reloads) change(reload.value);
    for (SlotValue& slot : block.dirty) change(slot.value);
  }
}

}  // namespace

bool walk_pointers(Function& f, const Facts& facts, std::vector<uint32_t>& unwalked) {
  std::vector<Walk> walks;
  Ways ways;
  bool all = true;
  const auto loops = static_cast<uint32_t>(facts.loops().size());
  for (uint32_t l = 0; l < loops; ++l) {
    if (!facts.is_walked(l)) continue;
    if (ways.empty()) ways = ways_of(f);
    walks.emplace_back(f, facts, ways, l);
    if (walks.back().find()) continue;
    unwalked.push_back(facts.blocks()[facts.loops()[l].head].first);
    all = false;
  }
  if (!all) return false;
  if (walks.empty()) return true;
  const std::vector<uint32_t> uses = count_uses(f);
  Renames renames;
  Constants constants(f);
  for (Walk& walk : walks) walk.change(uses, constants, renames);
  if (!renames.all().empty()) rename(f, renames);
  return true;
}

}  // namespace vm::native
