// Control flow: branches that go one way only, jumps to jumps, jumps to a branch that is decided
// already, blocks with one way in and one way out. Unreachable blocks go.
#include <algorithm>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"
#include "ir/program/ops.h"

namespace ir::opt {
namespace {

constexpr int kBranchRounds = 3;
constexpr int kMaxHops = 16;  // through jumps to jumps

class Branches {
 public:
  explicit Branches(Pou& pou) : pou_(pou), constants_(pou) {}

  bool run() {
    bool any = false;
    for (int round = 0; round < kBranchRounds; ++round) {
      uses_.clear();
      find_handlers();
      find_positions();
      changed_ = false;
      for (Block& block : pou_.blocks) straighten(block);
      const bool straightened = changed_;
      if (straightened || (round == 0 && unreachable_)) remove_unreachable();
      join_blocks();
      any = any || changed_;
      if (!straightened) return any;
    }
    return any;
  }

 private:
  void find_handlers() {
    handlers_.assign(pou_.blocks.size(), false);
    for (const Block& block : pou_.blocks) {
      if (block.handler.valid()) handlers_[block.handler.index] = true;
    }
  }

  void find_positions() {
    position_.assign(pou_.blocks.size(), 0);
    uint32_t next = 0;
    for (const uint32_t b : reverse_post_order(pou_)) position_[b] = ++next;
    unreachable_ = next != pou_.blocks.size();
    loops_.assign(pou_.blocks.size(), false);
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      for (const Target& target : pou_.blocks[b].insts.back().targets) {
        if (position_[target.block.index] <= position_[b]) loops_[target.block.index] = true;
      }
    }
  }

  void become_jump(Inst& end, Target target) {
    Inst jump;
    jump.op = Op::kJump;
    jump.line = end.line;
    jump.targets.push_back(std::move(target));
    end = std::move(jump);
    changed_ = true;
  }

  static bool decides(Op op) { return op == Op::kBranch || op == Op::kSwitch; }

  void straighten(Block& block) {
    Inst& end = block.insts.back();
    if (decides(end.op) && !names_loop(block)) decide(end);
    for (size_t t = 0; t < end.targets.size(); ++t) {
      const bool handler = end.op == Op::kTry && t == 1;
      if (!handler) pass_jumps(end, end.targets[t]);
    }
    if (decides(end.op) && !names_loop(block)) decide(end);
    if (end.op == Op::kJump) pass_decided_branches(end);
  }

  // WHILE TRUE: the trap of an endless loop names the line of its condition, which is nowhere else.
  bool names_loop(const Block& block) const {
    const size_t number = static_cast<size_t>(&block - pou_.blocks.data());
    return loops_[number] && std::all_of(block.insts.begin(), block.insts.end() - 1,
                                         [](const Inst& inst) { return inst.op == Op::kConst; });
  }

  void decide(Inst& end) {
    if (const std::optional<uint64_t> bits = constants_[end.operands[0]]) {
      return become_jump(end, taken_target(end, *bits));
    }
    const Target& first = end.targets[0];
    const bool same = std::all_of(end.targets.begin(), end.targets.end(), [&](const Target& way) {
      return way.block == first.block && way.args == first.args;
    });
    if (same) become_jump(end, first);
  }

  // Nothing but a jump, and constants that nobody uses.
  bool only_jumps(BlockId id) {
    const Block& block = pou_.blocks[id.index];
    if (id.index == 0 || handlers_[id.index] || !block.params.empty()) return false;
    const Inst& end = block.insts.back();
    return end.op == Op::kJump && end.targets[0].args.empty() && only_unused_before_end(block);
  }

  bool only_unused_before_end(const Block& block) {
    for (size_t i = 0; i + 1 < block.insts.size(); ++i) {
      const Inst& inst = block.insts[i];
      if (inst.op != Op::kConst || uses_of(inst.result) != 0) return false;
    }
    return true;
  }

  // Counted when first asked for in a round.
  uint32_t& uses_of(ValueId value) {
    if (uses_.empty()) uses_ = count_uses(pou_);
    return uses_[value.index];
  }

  // A jump backwards stays after the body of its loop, for the verifier of bytecode looks for
  // calls in between; fuel ends there, and the trap names its line.
  void pass_jumps(Inst& end, Target& target) {
    for (int hop = 0; hop < kMaxHops && only_jumps(target.block); ++hop) {
      const Inst& jump = pou_.blocks[target.block.index].insts.back();
      const BlockId next = jump.targets[0].block;
      const bool back = position_[next.index] <= position_[target.block.index];
      if (next == target.block || (back && end.op != Op::kJump)) return;
      if (back) end.line = jump.line;
      target.block = next;
      changed_ = true;
    }
  }

  // To a block that only branches on a parameter, which is a constant on this way.
  void pass_decided_branches(Inst& end) {
    for (int hop = 0; hop < kMaxHops; ++hop) {
      const Target& way = end.targets[0];
      const Block& next = pou_.blocks[way.block.index];
      const Inst& branch = next.insts.back();
      if (next.insts.size() != 1 || !decides(branch.op) || handlers_[way.block.index]) return;
      if (next.params.empty() || !used_only_at_end(next)) return;
      const ValueId condition = argument(next, way, branch.operands[0]);
      const std::optional<uint64_t> bits = constants_[condition];
      if (!bits || condition == branch.operands[0]) return;
      Target taken = taken_target(branch, *bits);
      for (ValueId& arg : taken.args) arg = argument(next, way, arg);
      for (const ValueId arg : way.args) --uses_of(arg);
      for (const ValueId arg : taken.args) ++uses_of(arg);
      end.targets[0] = std::move(taken);
      changed_ = true;
    }
  }

  static ValueId argument(const Block& block, const Target& way, ValueId value) {
    for (size_t i = 0; i < block.params.size(); ++i) {
      if (block.params[i] == value) return way.args[i];
    }
    return value;
  }

  // The parameters of `block`, so that a way may lead past it.
  bool used_only_at_end(const Block& block) {
    for (const ValueId param : block.params) {
      uint32_t here = 0;
      for_each_operand(block.insts.back(), [&](ValueId value) { here += value == param; });
      if (uses_of(param) != here) return false;
    }
    return true;
  }

  // A block joins the one that jumps to it when nobody else does.
  void join_blocks() {
    const Entries entries = count_entries(pou_);
    Replacements same(pou_);
    bool joined = false;
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      for (;;) {
        Block& block = pou_.blocks[b];
        const Inst& end = block.insts.back();
        if (end.op != Op::kJump) break;
        const uint32_t next_number = end.targets[0].block.index;
        Block& next = pou_.blocks[next_number];
        const bool joins = next_number != b && next_number != 0 &&
                           entries.count[next_number] == 1 && !handlers_[next_number] &&
                           next.handler == block.handler;
        if (!joins) break;
        for (size_t i = 0; i < next.params.size(); ++i) {
          same.replace(next.params[i], end.targets[0].args[i]);
        }
        block.insts.pop_back();
        move_insts(block, next);
        changed_ = true;
        joined = true;
      }
    }
    if (!joined) return;
    same.apply(pou_);
    remove_unreachable();
  }

  // `from` stays as a block that nobody enters.
  static void move_insts(Block& to, Block& from) {
    to.insts.insert(to.insts.end(), std::make_move_iterator(from.insts.begin()),
                    std::make_move_iterator(from.insts.end()));
    from.insts.assign(1, Inst());
    from.params.clear();
  }

  void remove_unreachable() {
    std::vector<BlockId> number(pou_.blocks.size());
    const std::vector<uint32_t> order = reverse_post_order(pou_);
    if (order.size() == pou_.blocks.size()) return;
    for (const uint32_t b : order) number[b] = BlockId(0);
    std::vector<Block> kept;
    for (uint32_t b = 0; b < pou_.blocks.size(); ++b) {
      if (!number[b].valid()) continue;
      number[b] = BlockId(static_cast<uint32_t>(kept.size()));
      kept.push_back(std::move(pou_.blocks[b]));
    }
    for (Block& block : kept) {
      if (block.handler.valid()) block.handler = number[block.handler.index];
      for (Target& target : block.insts.back().targets) {
        target.block = number[target.block.index];
      }
    }
    pou_.blocks = std::move(kept);
    find_handlers();
    changed_ = true;
  }

  Pou& pou_;
  Constants constants_;
  std::vector<uint32_t> uses_;
  std::vector<bool> handlers_;
  std::vector<uint32_t> position_;  // in reverse post order, as the round began
  std::vector<bool> loops_;         // is jumped to backwards
  bool unreachable_ = false;        // there are such blocks, as the round began
  bool changed_ = false;
};

}  // namespace

bool simplify_branches(const Program&, Pou& pou) {
  return pou.blocks.size() > 1 && Branches(pou).run();
}

}  // namespace ir::opt
