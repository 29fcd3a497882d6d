// Block parameters that get the same value, or the same constant, on every way.
#include <algorithm>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"

namespace ir::opt {
namespace {

constexpr int kCopyRounds = 3;  // one parameter may wait for another

class Copies {
 public:
  explicit Copies(Pou& pou) : pou_(pou), constants_(pou), same_(pou), found_(pou.values.size()) {}

  bool run() {
    bool changed = true;
    for (int round = 0; round < kCopyRounds && changed; ++round) {
      changed = false;
      found_.assign(pou_.values.size(), {});
      for (const Block& block : pou_.blocks) {
        for (const Target& target : block.insts.back().targets) look_at(target);
      }
      for (Block& block : pou_.blocks) {
        for (const ValueId param : block.params) changed |= decide(block, param);
      }
    }
    if (same_.empty()) return false;
    drop_replaced();
    same_.apply(pou_);
    return true;
  }

 private:
  struct Found {
    ValueId value;  // the only argument so far that is not the parameter itself
    bool several = false;
  };

  bool equal(ValueId a, ValueId b) const {
    return a == b || (constants_.known(a) && constants_.known(b) && constants_[a] == constants_[b]);
  }

  void look_at(const Target& target) {
    const std::vector<ValueId>& params = pou_.blocks[target.block.index].params;
    for (size_t i = 0; i < params.size(); ++i) {
      const ValueId arg = same_(target.args[i]);
      if (arg == params[i]) continue;
      Found& found = found_[params[i].index];
      if (!found.value.valid()) found.value = arg;
      if (!equal(found.value, arg)) found.several = true;
    }
  }

  bool decide(Block& block, ValueId param) {
    const Found& found = found_[param.index];
    if (!found.value.valid() || found.several || same_(param) != param) return false;
    ValueId value = found.value;
    // A constant of its own: that of one way need not stand on the others.
    if (const std::optional<uint64_t> bits = constants_[value]) {
      const Scalar scalar = pou_.values[param.index].scalar;
      const uint32_t line = block.insts.front().line;
      value = new_value(pou_, scalar);
      block.insts.insert(block.insts.begin(), constant_inst(scalar, value, *bits, line));
      constants_.set(value, *bits);
      found_.resize(pou_.values.size());
    }
    same_.replace(param, value);
    return true;
  }

  void drop_replaced() {
    const auto gone = [this](ValueId param) { return same_(param) != param; };
    for (Block& block : pou_.blocks) {
      for (Target& target : block.insts.back().targets) {
        const std::vector<ValueId>& params = pou_.blocks[target.block.index].params;
        ValueList kept;
        for (size_t i = 0; i < params.size(); ++i) {
          if (!gone(params[i])) kept.push_back(target.args[i]);
        }
        target.args = std::move(kept);
      }
    }
    for (Block& block : pou_.blocks) std::erase_if(block.params, gone);
  }

  Pou& pou_;
  Constants constants_;
  Replacements same_;
  std::vector<Found> found_;
};

}  // namespace

bool propagate_copies(const Program&, Pou& pou) {
  const bool any = std::any_of(pou.blocks.begin(), pou.blocks.end(),
                               [](const Block& block) { return !block.params.empty(); });
  return any && Copies(pou).run();
}

}  // namespace ir::opt
