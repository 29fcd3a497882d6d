#include "ir/lower/liveness.h"

#include <array>
#include <span>

namespace ir::codegen {
namespace {

struct Effects {
  RegisterSet reads;  // before any write in the block
  RegisterSet writes;
};

struct Access {
  uint32_t r;
  bool write;
};

// What all blocks read and write, one after the other. An instruction reads before it writes.
struct Accesses {
  explicit Accesses(const Machine& machine) {
    begins.push_back(0);
    for (const MachineBlock& block : machine.blocks) {
      for (const MachineInst& inst : block.insts) add(inst);
      if (block.end.condition.is_register()) all.push_back({block.end.condition.index, false});
      begins.push_back(all.size());
    }
  }
  std::span<const Access> of(size_t block) const {
    return std::span(all).subspan(begins[block], begins[block + 1] - begins[block]);
  }

  std::vector<Access> all;
  std::vector<size_t> begins;

 private:
  void add(const MachineInst& inst) {
    std::array<uint32_t, 3> written{};
    size_t count = 0;
    for_each_register(inst, [&](uint32_t r, bool reads, bool writes) {
      if (reads) all.push_back({r, false});
      if (writes) written[count++] = r;
    });
    for (size_t i = 0; i < count; ++i) all.push_back({written[i], true});
  }
};

class Analysis {
 public:
  explicit Analysis(const Machine& machine) : machine_(machine), blocks_(machine.blocks.size()) {
    const Accesses accesses(machine);
    find_tracked(accesses);
    effects_.reserve(blocks_);
    for (size_t b = 0; b < blocks_; ++b) effects_.push_back(effects_of(accesses.of(b)));
  }

  Liveness run(const std::vector<uint32_t>& written_at_entry) {
    liveness_.live_in.assign(blocks_, empty_set());
    liveness_.live_out.assign(blocks_, empty_set());
    liveness_.assigned_in.assign(blocks_, RegisterSet(liveness_.registers.size(), true));
    find_live();
    RegisterSet at_entry = empty_set();
    for (uint32_t r : written_at_entry) at_entry.add(number_[r]);
    find_assigned(std::move(at_entry));
    return std::move(liveness_);
  }

 private:
  RegisterSet empty_set() const { return RegisterSet(liveness_.registers.size()); }

  // A temporary that one block writes before it reads is nobody else's business.
  void find_tracked(const Accesses& accesses) {
    std::vector<uint32_t> home(machine_.registers.size(), kNoNumber);
    std::vector<bool> tracked(machine_.registers.size());
    for (uint32_t r = 0; r < tracked.size(); ++r) {
      tracked[r] = machine_.registers[r].slot != kNoNumber;
    }
    for (uint32_t b = 0; b < blocks_; ++b) {
      for (const auto [r, write] : accesses.of(b)) {
        if (home[r] == kNoNumber && write) home[r] = b;
        if (home[r] != b) tracked[r] = true;
      }
    }
    number_.assign(tracked.size(), kNoNumber);
    for (uint32_t r = 0; r < tracked.size(); ++r) {
      if (!tracked[r]) continue;
      number_[r] = static_cast<uint32_t>(liveness_.registers.size());
      liveness_.registers.push_back(r);
    }
  }

  Effects effects_of(std::span<const Access> accesses) const {
    Effects effects{empty_set(), empty_set()};
    for (const auto [r, write] : accesses) {
      const uint32_t number = number_[r];
      if (number == kNoNumber) continue;
      if (write) {
        effects.writes.add(number);
      } else if (!effects.writes.has(number)) {
        effects.reads.add(number);
      }
    }
    return effects;
  }

  void find_live() {
    for (size_t b = 0; b < blocks_; ++b) {
      if (machine_.blocks[b].end.kind != EndKind::kReturn) continue;
      for (uint32_t i = 0; i < liveness_.registers.size(); ++i) {
        if (machine_.registers[liveness_.registers[i]].result) liveness_.live_out[b].add(i);
      }
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t b = blocks_; b-- > 0;) changed |= update_live(b);
    }
  }

  // live_in = reads or (live_out and not writes). What a handler reads is live throughout the
  // blocks of its try: a trap may come before any of their writes.
  bool update_live(size_t b) {
    RegisterSet& out = liveness_.live_out[b];
    const uint32_t handler = machine_.blocks[b].handler;
    for_each_successor(machine_.blocks[b].end,
                       [&](uint32_t next) { out.unite(liveness_.live_in[next]); });
    if (handler != kNoNumber) out.unite(liveness_.live_in[handler]);
    scratch_ = out;
    scratch_.subtract(effects_[b].writes);
    scratch_.unite(effects_[b].reads);
    if (handler != kNoNumber) scratch_.unite(liveness_.live_in[handler]);
    return liveness_.live_in[b].unite(scratch_);
  }

  void find_assigned(RegisterSet at_entry) {
    liveness_.assigned_in[0] = std::move(at_entry);
    for (bool changed = true; changed;) {
      changed = false;
      for (size_t b = 0; b < blocks_; ++b) {
        scratch_ = liveness_.assigned_in[b];
        scratch_.unite(effects_[b].writes);
        for_each_successor(machine_.blocks[b].end, [&](uint32_t next) {
          changed |= liveness_.assigned_in[next].intersect(scratch_);
        });
      }
    }
  }

  const Machine& machine_;
  size_t blocks_;
  std::vector<uint32_t> number_;  // register -> element of the sets
  std::vector<Effects> effects_;
  RegisterSet scratch_;  // keeps its memory
  Liveness liveness_;
};

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

Liveness analyse_liveness(const Machine& machine, const std::vector<uint32_t>& written_at_entry) {
  return Analysis(machine).run(written_at_entry);
}

}  // namespace ir::codegen
