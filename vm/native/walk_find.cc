#include <algorithm>

#include "vm/exec/context.h"
#include "vm/native/walk.h"

namespace vm::native {
namespace {

constexpr size_t kMostQuestions = 16;  // in front of one loop: variables by pointers

}  // namespace

bool Walk::find() {
  for (Block b = loop_.head; b <= loop_.last; ++b) {
    for (const uint32_t number : f_.blocks[b].nodes) {
      const Node& n = f_.nodes[number];
      if (n.op == Op::kCall || n.op == Op::kEnter) return false;
      if (n.op != Op::kResolve && n.op != Op::kMoveHandle) continue;
      if (n.exit == kNone || walker_of(n.in[0]) == kNone) return false;
      if (n.op == Op::kMoveHandle) walker_of(n.result);
      if (n.op != Op::kResolve) continue;
      resolved_.set(n.result, 0);
      any_ = true;
    }
  }
  if (!any_) return true;
  // What a turn brings may be a pointer that was not known yet: there are more of them then.
  for (uint32_t w = 0; w < walkers_.size(); ++w) {
    const uint32_t param = walkers_[w].param;
    if (param == kNone) continue;
    bool same = true;
    each_turn([&](End& end) { same &= walker_of(end.args[0][param]) == w; });
    if (!same) return false;
  }
  find_questions();
  return walkers_.size() <= kLoopReaches && walkers_.size() * questions_.size() <= kMostQuestions;
}

uint32_t Walk::walker_of(Val v) {
  if (const uint32_t* const known = walker_.find(v)) return *known;
  const uint32_t found = find_walker(v);
  return walker_[v] = found;
}

uint32_t Walk::find_walker(Val v) {
  const Value& value = f_.values[v];
  if (value.constant || value.width != 8 || value.floating) return kNone;
  if (!is_inside(v)) return add_walker(v, kNone);
  if (value.node == kNone) {
    const std::vector<Val>& params = f_.blocks[value.block].params;
    const auto at = std::find(params.begin(), params.end(), v);
    if (at == params.end()) return kNone;
    const auto index = static_cast<uint32_t>(at - params.begin());
    if (value.block == loop_.head) return add_walker(v, index);
    return walker_of_all_ways(value.block, index);
  }
  const Node& n = f_.nodes[value.node];
  switch (n.op) {
    case Op::kMoveHandle:
      return walker_of(n.in[0]);
    case Op::kSelect:
      return same(walker_of(n.in[1]), walker_of(n.in[2]));
    case Op::kSelectCmp:
      return same(walker_of(n.in[0]), walker_of(n.in[1]));
    default:
      return kNone;
  }
}

uint32_t Walk::walker_of_all_ways(Block block, uint32_t param) {
  uint32_t one = kNone;
  for (const auto& [from, way] : ways_[block]) {
    const uint32_t found = walker_of(f_.blocks[from].end.args[way][param]);
    if (found == kNone || (one != kNone && found != one)) return kNone;
    one = found;
  }
  return one;
}

uint32_t Walk::add_walker(Val handle, uint32_t param) {
  Walker w;
  w.handle = handle;
  w.param = param;
  w.site = static_cast<uint8_t>(kKnownReaches + walkers_.size());
  walkers_.push_back(w);
  return static_cast<uint32_t>(walkers_.size() - 1);
}

void Walk::find_questions() {
  std::vector<uint32_t> named = facts_.deferred(number_);
  if (stores()) {
    const std::vector<uint32_t>& reads = facts_.reads(number_);
    named.insert(named.end(), loop_.modified.begin(), loop_.modified.end());
    named.insert(named.end(), reads.begin(), reads.end());
    for (const Reload& reload : f_.blocks[front_].reloads) named.push_back(reload.variable);
  }
  for (const uint32_t v : named) {
    const Variable& variable = f_.variables[v];
    if (variable.slot || variable.constant) continue;
    add_question({variable.base, variable.offset, uint64_t{variable.offset} + variable.width});
    if (questions_.size() > kMostQuestions) return;
  }
}

void Walk::add_question(Question q) {
  std::erase_if(questions_, [&](const Question& other) {
    const bool touches = other.base == q.base && other.begin <= q.end && q.begin <= other.end;
    if (touches) q = {q.base, std::min(q.begin, other.begin), std::max(q.end, other.end)};
    return touches;
  });
  questions_.push_back(q);
}

bool Walk::stores() const {
  const auto is_resolved = [&](Val v) { return v != kNone && resolved_.find(v) != kNone; };
  for (Block b = loop_.head; b <= loop_.last; ++b) {
    for (const uint32_t number : f_.blocks[b].nodes) {
      const Node& n = f_.nodes[number];
      if (n.op != Op::kLoad && is_resolved(n.mem.index)) return true;
      if (std::any_of(std::begin(n.in), std::end(n.in), is_resolved)) return true;
    }
  }
  return false;
}

}  // namespace vm::native
