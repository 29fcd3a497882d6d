// Branches around a few operations become selections: a wrong guess of the machine costs more.
#include <algorithm>

#include "vm/native/loops.h"

namespace vm::native {
namespace {

constexpr size_t kMostNodes = 4;  // of one way

class Chooser {
 public:
  explicit Chooser(Function& f) : f_(f), ways_in_(f.blocks.size(), 0) {
    for (const BasicBlock& block : f.blocks) {
      for (const Block to : block.end.target) {
        if (to != kNone) ++ways_in_[to];
      }
    }
  }

  void run() {
    for (Block b = static_cast<Block>(f_.blocks.size()); b-- > 0;) diamond(b);  // inner ones first
  }

 private:
  // Nothing but what may be done in vain; stores come last.
  bool is_cheap(Block b, Block join) const {
    const BasicBlock& block = f_.blocks[b];
    if (ways_in_[b] != 1 || block.head || !block.params.empty()) return false;
    if (block.end.kind != EndKind::kJump || block.end.target[0] != join) return false;
    size_t nodes = 0;
    bool stores = false;
    for (const uint32_t n : block.nodes) {
      const Node& node = f_.nodes[n];
      if (node.op == Op::kStore) {
        if (node.variable == kNone || node.kills != kNone || f_.values[node.in[0]].floating) {
          return false;
        }
        stores = true;
        continue;
      }
      if (stores || ++nodes > kMostNodes) return false;
      switch (node.op) {
        case Op::kAdd:
        case Op::kSub:
        case Op::kAnd:
        case Op::kOr:
        case Op::kXor:
        case Op::kNot:
        case Op::kNeg:
        case Op::kSext:
        case Op::kZext:
        case Op::kCompare:
        case Op::kNotBool:
        case Op::kSelectCmp:
          break;
        case Op::kShl:
        case Op::kShr:
        case Op::kSar:
          if (!f_.values[node.in[1]].constant) return false;
          break;
        default:
          return false;
      }
    }
    return true;
  }

  // Where both ways meet: after both, or one leads past the other. kNone: nowhere near.
  Block join_of(const End& end) const {
    for (uint32_t i = 0; i < 2; ++i) {
      const Block way = end.target[i];
      const Block other = end.target[1 - i];
      const Block join = f_.blocks[way].end.target[0];
      if (join == kNone || join <= way || !is_cheap(way, join)) continue;
      if (other == join || (join > other && is_cheap(other, join))) return join;
    }
    return kNone;
  }

  std::vector<uint32_t> stores_of(Block b, Block join) const {
    std::vector<uint32_t> out;
    if (b == join) return out;
    for (const uint32_t n : f_.blocks[b].nodes) {
      if (f_.nodes[n].op == Op::kStore) out.push_back(n);
    }
    return out;
  }

  Val select(Block b, const End& end, Val yes, Val no) {
    if (yes == no) return yes;
    Node node;
    node.op = Op::kSelectCmp;
    node.width = f_.values[yes].width;
    node.from = end.width;
    node.cond = end.cond;
    node.in[0] = yes;
    node.in[1] = no;
    node.in[2] = end.in[0];
    node.in[3] = end.in[1];
    node.unit = f_.blocks[b].unit;
    node.result = static_cast<Val>(f_.values.size());
    const auto number = static_cast<uint32_t>(f_.nodes.size());
    f_.values.push_back({false, node.width, false, 0, number, b});
    f_.nodes.push_back(node);
    f_.blocks[b].nodes.push_back(number);
    return node.result;
  }

  void diamond(Block b) {
    const End end = f_.blocks[b].end;
    if (end.kind != EndKind::kBranch || end.compare != Op::kCompare) return;
    const Block yes = end.target[0];
    const Block no = end.target[1];
    if (yes <= b || no <= b || yes == no) return;
    const Block join = join_of(end);
    if (join == kNone || f_.blocks[join].head) return;
    for (uint32_t i = 0; i < 2; ++i) {
      if (end.target[i] != join && !end.args[i].empty()) return;
    }
    const std::vector<uint32_t> first = stores_of(yes, join);
    const std::vector<uint32_t> second = stores_of(no, join);
    if (first.size() != second.size() || first.size() > 2) return;
    for (size_t i = 0; i < first.size(); ++i) {
      if (f_.nodes[first[i]].variable != f_.nodes[second[i]].variable) return;
    }
    const std::vector<Val> yes_args = yes == join ? end.args[0] : f_.blocks[yes].end.args[0];
    const std::vector<Val> no_args = no == join ? end.args[1] : f_.blocks[no].end.args[0];
    for (size_t i = 0; i < yes_args.size(); ++i) {
      if (f_.values[yes_args[i]].floating && yes_args[i] != no_args[i]) return;
    }
    if (yes_args.size() > 2) return;
    for (const Block way : {yes, no}) {
      if (way == join) continue;
      for (const uint32_t n : f_.blocks[way].nodes) {
        if (f_.nodes[n].op == Op::kStore) continue;
        f_.blocks[b].nodes.push_back(n);
        f_.values[f_.nodes[n].result].block = b;
      }
    }
    std::vector<Val> args;
    for (size_t i = 0; i < yes_args.size(); ++i) {
      args.push_back(select(b, end, yes_args[i], no_args[i]));
    }
    for (size_t i = 0; i < first.size(); ++i) {
      const Val yes_value = f_.nodes[first[i]].in[0];
      const Val no_value = f_.nodes[second[i]].in[0];
      Val value = kNone;
      for (size_t k = 0; k < args.size(); ++k) {
        if (yes_args[k] == yes_value && no_args[k] == no_value) value = args[k];
      }
      if (value == kNone) value = select(b, end, yes_value, no_value);
      Node store = f_.nodes[first[i]];
      store.in[0] = value;
      f_.blocks[b].nodes.push_back(static_cast<uint32_t>(f_.nodes.size()));
      f_.nodes.push_back(store);
    }
    // The ways stay as blocks that nothing leads to.
    End made;
    made.kind = EndKind::kJump;
    made.target[0] = join;
    made.args[0] = std::move(args);
    f_.blocks[b].end = std::move(made);
    for (const Block way : {yes, no}) {
      if (way == join) continue;
      f_.blocks[way].nodes.clear();
      f_.blocks[way].end = End();
      f_.blocks[way].end.kind = EndKind::kUnreachable;
    }
    --ways_in_[join];
  }

  Function& f_;
  std::vector<uint32_t> ways_in_;
};

}  // namespace

void choose(Function& function) { Chooser(function).run(); }

}  // namespace vm::native
