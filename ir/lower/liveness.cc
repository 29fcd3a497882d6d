#include "ir/lower/liveness.h"

namespace ir::codegen {
namespace {

struct Effects {
  RegisterSet reads;  // before any write in the block
  RegisterSet writes;
};

void add_results(const Machine& machine, RegisterSet& set) {
  for (uint32_t r = 0; r < machine.registers.size(); ++r) {
    if (machine.registers[r].result) set.add(r);
  }
}

Effects effects_of(const Machine& machine, const MachineBlock& block) {
  Effects effects{RegisterSet(machine.registers.size()), RegisterSet(machine.registers.size())};
  const auto read = [&](uint32_t r) {
    if (!effects.writes.has(r)) effects.reads.add(r);
  };
  for (const MachineInst& inst : block.insts) {
    for_each_register(inst, [&](uint32_t r, bool reads, bool) {
      if (reads) read(r);
    });
    for_each_register(inst, [&](uint32_t r, bool, bool writes) {
      if (writes) effects.writes.add(r);
    });
  }
  if (block.end.condition.is_register()) read(block.end.condition.index);
  return effects;
}

// live_in = reads or (live_out and not writes)
bool update_live(const Machine& machine, const Effects& effects, uint32_t position,
                 Liveness& liveness) {
  RegisterSet& out = liveness.live_out[position];
  for_each_successor(machine.blocks[position].end,
                     [&](uint32_t next) { out.unite(liveness.live_in[next]); });
  RegisterSet in = out;
  in.subtract(effects.writes);
  in.unite(effects.reads);
  return liveness.live_in[position].unite(in);
}

}  // namespace

bool RegisterSet::unite(const RegisterSet& other) {
  bool changed = false;
  for (size_t i = 0; i < words_.size(); ++i) {
    const uint64_t united = words_[i] | other.words_[i];
    changed |= united != words_[i];
    words_[i] = united;
  }
  return changed;
}

bool RegisterSet::intersect(const RegisterSet& other) {
  bool changed = false;
  for (size_t i = 0; i < words_.size(); ++i) {
    const uint64_t common = words_[i] & other.words_[i];
    changed |= common != words_[i];
    words_[i] = common;
  }
  return changed;
}

void RegisterSet::subtract(const RegisterSet& other) {
  for (size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
}

Liveness analyse_liveness(const Machine& machine, const RegisterSet& written_at_entry) {
  const size_t registers = machine.registers.size();
  const size_t blocks = machine.blocks.size();
  Liveness liveness;
  liveness.live_in.assign(blocks, RegisterSet(registers));
  liveness.live_out.assign(blocks, RegisterSet(registers));
  liveness.assigned_in.assign(blocks, RegisterSet(registers, true));
  std::vector<Effects> effects;
  for (const MachineBlock& block : machine.blocks) effects.push_back(effects_of(machine, block));
  for (size_t i = 0; i < blocks; ++i) {
    if (machine.blocks[i].end.kind == EndKind::kReturn) {
      add_results(machine, liveness.live_out[i]);
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = blocks; i-- > 0;) {
      changed |= update_live(machine, effects[i], static_cast<uint32_t>(i), liveness);
    }
  }
  liveness.assigned_in[0] = written_at_entry;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < blocks; ++i) {
      RegisterSet out = liveness.assigned_in[i];
      out.unite(effects[i].writes);
      for_each_successor(machine.blocks[i].end, [&](uint32_t next) {
        changed |= liveness.assigned_in[next].intersect(out);
      });
    }
  }
  return liveness;
}

}  // namespace ir::codegen
