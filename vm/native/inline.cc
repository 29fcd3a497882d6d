#include "vm/native/inline.h"

#include <algorithm>
#include <optional>

#include "base/check.h"
#include "ir/bytecode/image.h"
#include "vm/native/facts.h"
#include "vm/native/recipes.h"

namespace vm::native {
namespace {

constexpr uint32_t kMostUnits = 96;

bool may_leave(const Function& body) {
  return std::any_of(body.blocks.begin(), body.blocks.end(), [&](const BasicBlock& block) {
    return block.end.kind == EndKind::kExit ||
           std::any_of(block.nodes.begin(), block.nodes.end(),
                       [&](uint32_t n) { return body.nodes[n].exit != kNone; });
  });
}

class Inliner {
 public:
  Inliner(Function& f, const std::function<Callee(uint32_t)>& callee_of)
      : f_(f), callee_of_(callee_of) {}

  std::vector<uint32_t> run() {
    const auto count = static_cast<Block>(f_.blocks.size());
    first_.resize(count);
    last_.resize(count);
    blocks_.reserve(2 * size_t{count});
    for (Block b = 0; b < count; ++b) split(b);
    if (bodies_.empty()) {
      f_.blocks = std::move(blocks_);  // as they were
      return {};
    }
    // The blocks' own ways: from their last part to the others' first.
    for (Block b = 0; b < count; ++b) {
      BasicBlock& end = blocks_[last_[b]];
      for (Block& to : end.end.target) {
        if (to != kNone) to = first_[to];
      }
    }
    for (Value& value : f_.values) {
      if (value.node == kNone && value.block < count) value.block = first_[value.block];
    }
    f_.blocks = std::move(blocks_);
    for (Loop& loop : f_.loops) {
      loop.head = first_[loop.head];
      loop.last = last_[loop.last];
    }
    for (Block b = 0; b < f_.blocks.size(); ++b) {
      for (const uint32_t n : f_.blocks[b].nodes) {
        if (f_.nodes[n].result != kNone) f_.values[f_.nodes[n].result].block = b;
      }
    }
    for (const auto& [param, block] : parameters_) f_.values[param].block = block;
    std::sort(bodies_.begin(), bodies_.end());
    bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
    return std::move(bodies_);
  }

 private:
  void split(Block b) {
    BasicBlock old = std::move(f_.blocks[b]);
    first_[b] = static_cast<Block>(blocks_.size());
    const bool whole = std::none_of(old.nodes.begin(), old.nodes.end(), [&](uint32_t n) {
      return f_.nodes[n].op == Op::kCall && f_.calls[f_.nodes[n].call].inlined;
    });
    if (whole) {
      last_[b] = first_[b];
      blocks_.push_back(std::move(old));
      return;
    }
    BasicBlock part;
    part.unit = old.unit;
    part.params = std::move(old.params);
    part.loop = old.loop;
    part.head = old.head;
    part.reloads = std::move(old.reloads);
    part.dirty = std::move(old.dirty);
    for (const uint32_t n : old.nodes) {
      const bool inlined = f_.nodes[n].op == Op::kCall && f_.calls[f_.nodes[n].call].inlined;
      if (!inlined) {
        part.nodes.push_back(n);
        continue;
      }
      if (f_.calls[f_.nodes[n].call].targets.empty()) {
        part.nodes.push_back(n);
        copy_one(n, std::move(part), old.loop);
      } else {
        copy_several(n, std::move(part), old.unit, old.loop);
      }
      part = BasicBlock();
      part.unit = old.unit;
      part.loop = old.loop;
    }
    part.end = std::move(old.end);
    last_[b] = static_cast<Block>(blocks_.size());
    blocks_.push_back(std::move(part));
  }

  void copy_one(uint32_t call_node, BasicBlock part, uint32_t loop) {
    const Callee body = callee_of_(f_.calls[f_.nodes[call_node].call].known);
    const Block begin = static_cast<Block>(blocks_.size()) + 1;
    part.end.kind = EndKind::kJump;
    part.end.target[0] = begin;
    blocks_.push_back(std::move(part));
    copy(call_node, body, loop, begin + static_cast<Block>(body.function->blocks.size()));
  }

  // A block asks for each type; then there is one that leaves, and the bodies, each with one in
  // front that enters it.
  void copy_several(uint32_t call_node, BasicBlock part, uint32_t unit, uint32_t loop) {
    const Call call = f_.calls[f_.nodes[call_node].call];
    f_.nodes[call_node].dead = true;
    std::vector<std::pair<uint32_t, Block>> enters;  // POU, the block that enters it
    const auto miss = static_cast<Block>(blocks_.size() + call.targets.size());
    Block next = miss + 1;
    const auto enter_of = [&](uint32_t pou) {
      for (const auto& [known, block] : enters) {
        if (known == pou) return block;
      }
      enters.push_back({pou, next});
      next += 1 + static_cast<Block>(callee_of_(pou).function->blocks.size());
      return enters.back().second;
    };
    const Val type = f_.nodes[call_node].in[3];
    for (size_t i = 0; i < call.targets.size(); ++i) {
      part.end.kind = EndKind::kBranch;
      part.end.cond = Cond::kEq;
      part.end.width = 4;
      part.end.in[0] = type;
      part.end.in[1] = static_cast<Val>(f_.values.size());
      f_.values.push_back({false, 4, true, call.targets[i].type, kNone, 0});
      part.end.target[0] = enter_of(call.targets[i].pou);
      part.end.target[1] = static_cast<Block>(blocks_.size()) + 1;
      blocks_.push_back(std::move(part));
      part = BasicBlock();
      part.unit = unit;
      part.loop = loop;
    }
    part.end.kind = EndKind::kExit;
    part.end.exit = call.miss;
    blocks_.push_back(std::move(part));
    for (const auto& [pou, block] : enters) {
      BasicBlock enter;
      enter.unit = unit;
      enter.loop = loop;
      enter.nodes.push_back(enter_node(call_node, call, pou));
      enter.end.kind = EndKind::kJump;
      enter.end.target[0] = block + 1;
      blocks_.push_back(std::move(enter));
      copy(blocks_.back().nodes[0], callee_of_(pou), loop, next);
    }
  }

  // A node, exit and call of its own for each body.
  uint32_t enter_node(uint32_t call_node, const Call& several, uint32_t pou) {
    Node node = f_.nodes[call_node];
    node.dead = false;
    node.in[3] = kNone;
    node.call = static_cast<uint32_t>(f_.calls.size());
    Call call = several;
    call.kind = CallKind::kMethod;
    call.known = pou;
    call.targets.clear();
    f_.calls.push_back(std::move(call));
    Exit exit = f_.exits[node.exit];
    node.exit = static_cast<uint32_t>(f_.exits.size());
    f_.exits.push_back(std::move(exit));
    f_.nodes.push_back(node);
    return static_cast<uint32_t>(f_.nodes.size() - 1);
  }

  // The callee's blocks; its returns lead to `behind`.
  void copy(uint32_t call_node, const Callee& body, uint32_t loop, Block behind) {
    const Function& g = *body.function;
    bodies_.push_back(f_.calls[f_.nodes[call_node].call].known);
    Node& call = f_.nodes[call_node];
    call.op = Op::kEnter;
    step_ = f_.calls[call.call].frame_step;
    own_ = f_.calls[call.call].kind == CallKind::kOwn;
    // An instance that lies in a known place needs no pointer but for leaving there.
    const bool leaves = may_leave(g);
    const bool has_instance = call.in[1] != kNone || call.mem.inside;
    near_.reset();
    if (call.mem.inside && call.mem.index == kNone) near_ = call.mem.disp;
    pointer_ = kNone;
    if (!leaves) call.in[0] = kNone;
    if (has_instance && (!near_ || leaves)) {
      pointer_ = static_cast<Val>(f_.values.size());
      f_.values.push_back({false, 8, false, 0, call_node, 0});
      call.result = pointer_;
    }
    Inlined inlined;
    inlined.call = call.call;
    inlined.units = body.units;
    inlined.has_instance = has_instance;
    inlined.leaves = leaves;
    f_.inlined.push_back(inlined);
    const Val id = call.in[0];
    value_of_.assign(g.values.size(), kNone);
    const auto begin = static_cast<Block>(blocks_.size());
    for (Val v = 0; v < g.values.size(); ++v) {
      value_of_[v] = static_cast<Val>(f_.values.size());
      f_.values.push_back(g.values[v]);
      f_.values.back().node = kNone;
      f_.values.back().home = kNone;  // a variable of the body's own
    }
    const auto exits = static_cast<uint32_t>(f_.exits.size());
    for (const Exit& exit : g.exits) {
      Exit made = exit;
      for (SlotValue& slot : made.slots) {
        slot.offset += step_;
        slot.value = value_of_[slot.value];
      }
      made.inlined = static_cast<uint32_t>(f_.inlined.size() - 1);
      const std::vector<SlotValue>& callers = f_.exits[f_.nodes[call_node].exit].slots;
      made.slots.insert(made.slots.end(), callers.begin(), callers.end());
      if (has_instance && leaves) {
        made.slots.push_back({0, 4, id});
        made.slots.push_back({0, 8, pointer_});
      }
      f_.exits.push_back(std::move(made));
    }
    for (Block b = 0; b < g.blocks.size(); ++b) {
      BasicBlock block;
      block.loop = loop;
      block.unit = f_.blocks.empty() ? 0 : g.blocks[b].unit;
      for (const Val param : g.blocks[b].params) {
        block.params.push_back(value_of_[param]);
        parameters_.push_back({value_of_[param], begin + b});
      }
      for (const uint32_t n : g.blocks[b].nodes) block.nodes.push_back(node(g.nodes[n], exits));
      block.end = g.blocks[b].end;
      End& end = block.end;
      for (Val& v : end.in) v = mapped(v);
      for (std::vector<Val>& args : end.args) {
        for (Val& v : args) v = mapped(v);
      }
      for (Block& to : end.target) {
        if (to != kNone) to += begin;
      }
      if (end.kind == EndKind::kReturn) {
        end = End();
        end.kind = EndKind::kJump;
        end.target[0] = behind;
      } else if (end.exit != kNone) {
        end.exit += exits;
      }
      blocks_.push_back(std::move(block));
    }
  }

  Val mapped(Val v) const { return v == kNone ? kNone : value_of_[v]; }

  uint32_t node(Node n, uint32_t exits) {
    base::check(n.op != Op::kHelper, "a body asks no handler");
    for (Val& v : n.in) v = mapped(v);
    n.mem.index = mapped(n.mem.index);
    n.mem.pointer = mapped(n.mem.pointer);
    if (n.mem.base == MemBase::kFrame) n.mem.disp += step_;
    if (n.mem.base == MemBase::kSelf && near_) {
      n.mem.disp += *near_;
      n.mem.inside = true;
    } else if (n.mem.base == MemBase::kSelf && !own_) {
      n.mem.base = MemBase::kPointer;
      n.mem.pointer = pointer_;
    }
    n.variable = kNone;
    n.kills = kNone;
    if (n.exit != kNone) n.exit += exits;
    const auto number = static_cast<uint32_t>(f_.nodes.size());
    if (n.result != kNone) {
      n.result = value_of_[n.result];
      f_.values[n.result].node = number;
    }
    f_.nodes.push_back(n);
    return number;
  }

  Function& f_;
  const std::function<Callee(uint32_t)>& callee_of_;
  std::vector<BasicBlock> blocks_;
  std::vector<Block> first_, last_;
  std::vector<uint32_t> bodies_;
  std::vector<std::pair<Val, Block>> parameters_;
  std::vector<Val> value_of_;
  uint32_t step_ = 0;
  bool own_ = false;
  Val pointer_ = kNone;
  std::optional<int64_t> near_;  // the callee's instance lies so far from the own one
};

}  // namespace

bool is_small(const ir::LinkedPou& pou, std::span<const ir::Unit> code) {
  if (pou.unit_count > kMostUnits || pou.recursion_depth != 0) return false;
  for (uint32_t i = 0; i < code.size(); ++i) {
    const ir::Unit& unit = code[i];
    const ir::Opcode op = unit.opcode();
    const ir::OpcodeRow& row = ir::opcode_row(op);
    const Shape shape = recipe_of(op).shape;
    const bool flow = op == ir::Opcode::JT || op == ir::Opcode::JF || op == ir::Opcode::JMP ||
                      op == ir::Opcode::RET || is_switch(op);
    if (row.calls || row.backward || (shape == Shape::kHelper && !flow)) return false;
    const bool constant_place =
        (row.b.kind == ir::FieldKind::kBase && unit.base_b() == ir::Base::kConst) ||
        (row.c.kind == ir::FieldKind::kBase && unit.base_c() == ir::Base::kConst);
    const bool narrow_rotation = shape == Shape::kShift && recipe_of(op).width < 4;
    if (constant_place || narrow_rotation) return false;  // they may need a handler
    if (row.extended) ++i;
  }
  return true;
}

std::vector<uint32_t> inline_calls(Function& function,
                                   const std::function<Callee(uint32_t)>& callee_of) {
  const bool has_some = std::any_of(function.calls.begin(), function.calls.end(),
                                    [](const Call& call) { return call.inlined; });
  if (!has_some) return {};
  return Inliner(function, callee_of).run();
}

}  // namespace vm::native
