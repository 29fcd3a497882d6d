// Scalar locals of the frame that nobody else can see. A store that is overwritten, or never read,
// goes. Where one store reaches every load, the loads are its value.
#include <algorithm>
#include <bit>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"

namespace ir::opt {
namespace {

constexpr size_t kMaxTracked = 512;  // locals; sets of them are kept for every block
constexpr uint32_t kUntracked = 0xffffffffu;

class LocalSet {
 public:
  explicit LocalSet(size_t size = 0) : words_((size + 63) / 64) {}
  bool has(uint32_t i) const { return (words_[i / 64] >> (i % 64) & 1) != 0; }
  void add(uint32_t i) { words_[i / 64] |= uint64_t{1} << (i % 64); }
  void remove(uint32_t i) { words_[i / 64] &= ~(uint64_t{1} << (i % 64)); }
  void unite(const LocalSet& other) {
    for (size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  }
  friend bool operator==(const LocalSet&, const LocalSet&) = default;

 private:
  std::vector<uint64_t> words_;
};

class Stores {
 public:
  Stores(const Program& program, Pou& pou)
      : program_(program), pou_(pou), facts_(program, pou), tracked_(pou.locals.size()) {}

  bool run() {
    track();
    if (count_ == 0) return false;
    remove_unread();
    use_single_stores();
    return changed_;
  }

 private:
  // Locals of scalar type that are only loaded and stored as a whole.
  void track() {
    std::vector<bool> whole(pou_.locals.size(), true);
    for (const Block& block : pou_.blocks) {
      for (const Inst& inst : block.insts) {
        for (const PlaceId id : {inst.place, inst.place2}) {
          if (!id.valid() || pou_.places[id.index].base != PlaceBase::kLocal) continue;
          if (!is_simple(inst.op)) whole[pou_.places[id.index].base_index] = false;
        }
      }
    }
    for (uint32_t i = 0; i < pou_.locals.size(); ++i) {
      const Local& local = pou_.locals[i];
      const bool scalar = program_.types.is_scalar(local.type);
      const bool good = scalar && local.kind != LocalKind::kInOut && whole[i] &&
                        !facts_.local_escapes(i) && count_ < kMaxTracked;
      tracked_[i] = good ? count_++ : kUntracked;
    }
  }

  // A check only has the name of what it guards.
  static bool is_simple(Op op) { return is_access(op) || op == Op::kCheckRange; }
  static bool is_access(Op op) { return op == Op::kLoad || op == Op::kStore || op == Op::kInit; }

  // The tracked local that `inst` loads or stores.
  uint32_t local_of(const Inst& inst) const {
    if (!is_access(inst.op)) return kUntracked;
    const Place& place = pou_.places[inst.place.index];
    return place.base == PlaceBase::kLocal ? tracked_[place.base_index] : kUntracked;
  }

  // --- stores that nobody reads ------------------------------------------------------

  void find_live() {
    LocalSet at_return(count_);
    for (uint32_t i = 0; i < pou_.locals.size(); ++i) {
      const LocalKind kind = pou_.locals[i].kind;
      const bool result = kind == LocalKind::kOutput || kind == LocalKind::kReturn;
      if (result && tracked_[i] != kUntracked) at_return.add(tracked_[i]);
    }
    at_return_ = at_return;
    live_in_.assign(pou_.blocks.size(), LocalSet(count_));
    std::vector<uint32_t> order = reverse_post_order(pou_);
    std::reverse(order.begin(), order.end());
    for (bool changed = true; changed;) {
      changed = false;
      for (const uint32_t b : order) {
        LocalSet live = walk(b, [](size_t) {});
        if (live == live_in_[b]) continue;
        live_in_[b] = std::move(live);
        changed = true;
      }
    }
  }

  // What is live at the block's beginning. Visits stores that nobody reads.
  template <class Visit>
  LocalSet walk(uint32_t b, Visit unread) const {
    const Block& block = pou_.blocks[b];
    LocalSet live(count_);
    if (block.insts.back().op == Op::kReturn) live = at_return_;
    for (const Target& target : block.insts.back().targets) {
      live.unite(live_in_[target.block.index]);
    }
    // A trap anywhere in the block may lead to its handler.
    const LocalSet* handler = block.handler.valid() ? &live_in_[block.handler.index] : nullptr;
    if (handler != nullptr) live.unite(*handler);
    for (size_t i = block.insts.size(); i-- > 0;) {
      const Inst& inst = block.insts[i];
      const uint32_t local = local_of(inst);
      if (local == kUntracked) continue;
      if (inst.op == Op::kLoad) {
        live.add(local);
        continue;
      }
      if (!live.has(local)) unread(i);
      if (handler == nullptr || !handler->has(local)) live.remove(local);
    }
    return live;
  }

  void remove_unread() {
    find_live();
    for (const uint32_t b : reverse_post_order(pou_)) {
      std::vector<size_t> unread;
      walk(b, [&unread](size_t i) { unread.push_back(i); });
      if (unread.empty()) continue;
      changed_ = true;
      std::vector<Inst>& insts = pou_.blocks[b].insts;
      std::vector<Inst> kept;
      for (size_t i = 0; i < insts.size(); ++i) {
        if (!unread.empty() && unread.back() == i) {
          unread.pop_back();
        } else {
          kept.push_back(std::move(insts[i]));
        }
      }
      insts = std::move(kept);
    }
  }

  // --- locals with one store ----------------------------------------------------------

  struct Writer {
    uint32_t count = 0;
    uint32_t block = 0;
    size_t index = 0;
    ValueId value;
    bool reaches_all = true;
  };

  void use_single_stores() {
    std::vector<Writer> writers(count_);
    for (uint32_t i = 0; i < pou_.locals.size(); ++i) {
      if (tracked_[i] != kUntracked && pou_.locals[i].kind != LocalKind::kTemp) {
        writers[tracked_[i]].count = 2;  // the caller writes or reads it
      }
    }
    for_each_access([&](const Inst& inst, uint32_t local, uint32_t block, size_t index) {
      if (inst.op == Op::kLoad) return;
      Writer& writer = writers[local];
      writer.count += inst.op == Op::kStore ? 1 : 2;
      if (inst.op == Op::kStore) writer = {writer.count, block, index, inst.operands[0], true};
    });
    const bool any = std::any_of(writers.begin(), writers.end(),
                                 [](const Writer& writer) { return writer.count == 1; });
    if (!any) return;
    const Dominators dominators(pou_);
    for_each_access([&](const Inst& inst, uint32_t local, uint32_t block, size_t index) {
      Writer& writer = writers[local];
      if (inst.op != Op::kLoad || writer.count != 1) return;
      const bool reaches =
          writer.block == block ? writer.index < index : dominators.dominates(writer.block, block);
      if (!reaches) writer.reaches_all = false;
    });
    replace_loads(writers);
  }

  template <class Visit>
  void for_each_access(Visit visit) const {
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      const std::vector<Inst>& insts = pou_.blocks[b].insts;
      for (size_t i = 0; i < insts.size(); ++i) {
        const uint32_t local = local_of(insts[i]);
        if (local != kUntracked) visit(insts[i], local, b, i);
      }
    }
  }

  void replace_loads(const std::vector<Writer>& writers) {
    Replacements same(pou_);
    for (Block& block : pou_.blocks) {
      std::erase_if(block.insts, [&](const Inst& inst) {
        const uint32_t local = local_of(inst);
        if (local == kUntracked || writers[local].count != 1 || !writers[local].reaches_all) {
          return false;
        }
        changed_ = true;
        if (inst.op == Op::kLoad) same.replace(inst.result, writers[local].value);
        return true;
      });
    }
    same.apply(pou_);
  }

  const Program& program_;
  Pou& pou_;
  Facts facts_;
  std::vector<uint32_t> tracked_;  // number of the local in the sets
  uint32_t count_ = 0;
  bool changed_ = false;
  LocalSet at_return_;
  std::vector<LocalSet> live_in_;
};

}  // namespace

bool remove_stores(const Program& program, Pou& pou) {
  return !pou.locals.empty() && Stores(program, pou).run();
}

}  // namespace ir::opt
