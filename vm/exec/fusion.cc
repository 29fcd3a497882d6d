#include "vm/exec/fusion.h"

#include <algorithm>

namespace vm {
namespace {

template <class Bases>
constexpr ir::Base base_of(const Bases& written, uint8_t source) {
  return static_cast<ir::Base>(source < operand::v0 ? source : written[source - operand::v0]);
}
constexpr uint32_t source_bits(uint8_t source) {
  return source < operand::v0 ? 0 : source - operand::v0 + 1u;
}

template <class... S>
constexpr Fusion fusion_of() {
  static_assert(sizeof...(S) <= kMaxSteps);
  Fusion out;
  constexpr auto kBases = written_bases<S...>();
  const auto add = [&](ir::Opcode op, uint8_t A, uint8_t B, uint8_t C) {
    const uint32_t number =
        handler_number(op, base_of(kBases, A), base_of(kBases, B), base_of(kBases, C));
    out.keys[out.length++] =
        number | source_bits(A) << 16 | source_bits(B) << 20 | source_bits(C) << 24;
  };
  (add(S::kOp, S::kA, S::kB, S::kC), ...);
  return out;
}

constexpr size_t kFusionCount = 0
#define FUSION(...) +1
#include "vm/exec/fusions.def"
#undef FUSION
    ;
static_assert(kFirstFused + kFusionCount <= kHandlerLimit,
              "the table of handlers has no more room");

}  // namespace

namespace fusion_rows {

constexpr std::array<Fusion, kFusionCount> all_fusions() {
  return {{
#define FUSION(part, ...) fusion_of<__VA_ARGS__>(),
#include "vm/exec/fusions.def"
#undef FUSION
  }};
}

}  // namespace fusion_rows

namespace {

bool comes_before(const Fusion& x, const Fusion& y) {
  return std::lexicographical_compare(x.keys.begin(), x.keys.begin() + x.length, y.keys.begin(),
                                      y.keys.begin() + y.length);
}

constexpr size_t count_steps() {
  size_t steps = 0;
  for (const Fusion& row : fusion_rows::all_fusions()) steps += row.length;
  return steps;
}

// The rows without what is empty of most: in the program they take two fifths of the bytes so.
struct PackedFusions {
  std::array<uint8_t, kFusionCount> lengths{};
  std::array<StepKey, count_steps()> keys{};
};
constexpr PackedFusions packed_fusions() {
  PackedFusions out;
  size_t row = 0;
  size_t step = 0;
  for (const Fusion& fusion : fusion_rows::all_fusions()) {
    out.lengths[row++] = fusion.length;
    for (size_t k = 0; k < fusion.length; ++k) out.keys[step++] = fusion.keys[k];
  }
  return out;
}
constexpr PackedFusions kFusions = packed_fusions();

std::array<Fusion, kFusionCount> sorted_fusions() {
  std::array<Fusion, kFusionCount> rows;
  const StepKey* key = kFusions.keys.data();
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].handler = static_cast<uint16_t>(kFirstFused + i);
    rows[i].length = kFusions.lengths[i];
    for (size_t k = 0; k < rows[i].length; ++k) rows[i].keys[k] = *key++;
  }
  std::sort(rows.begin(), rows.end(), comes_before);
  return rows;
}

StepLine::Place place_of(const ir::Field& field, ir::Base base, uint16_t offset) {
  return {static_cast<uint8_t>(base), static_cast<uint8_t>(ir::class_size(field.cls)), offset};
}

bool overlap(const StepLine::Place& x, const StepLine::Place& y) {
  return x.base == y.base && x.offset < y.offset + y.size && y.offset < x.offset + x.size;
}

bool takes_random_place(uint64_t seed, size_t unit) {
  const uint64_t h = (seed + unit) * 0x9e3779b97f4a7c15u;
  return (h >> 40 & 1) != 0;
}

// What a dispatch costs, and what is saved by each step that a fusion takes after a back edge.
constexpr uint32_t kDispatch = 10;
constexpr uint32_t kBehindLoop = 4;

}  // namespace

std::span<const Fusion> fusions() {
  static const std::array<Fusion, kFusionCount> rows = sorted_fusions();
  return rows;
}

StepLine::StepLine(std::span<const ir::Unit> code) : units_(code.size()) {
  for (uint32_t i = 0; i < code.size(); ++i) {
    const ir::Unit& u = code[i];
    const ir::Opcode op = u.opcode();
    const ir::OpcodeRow& row = ir::opcode_row(op);
    Unit& out = units_[i];
    const StepFacts& facts = kStepFacts[static_cast<size_t>(op)];
    out.handler = static_cast<uint16_t>(handler_number(op, u.base_a(), u.base_b(), u.base_c()));
    out.units = row.extended ? 2 : 1;
    out.is_step = facts.is_step;
    out.stores = facts.stores;
    out.next = i + out.units;
    if (row.a.is_near() && row.a.reads()) out.a = place_of(row.a, u.base_a(), u.a);
    if (row.b.is_near()) out.b = place_of(row.b, u.base_b(), u.b);
    if (row.c.is_near()) out.c = place_of(row.c, u.base_c(), u.c);
    if (row.a.is_near() && row.a.writes()) out.written = place_of(row.a, u.base_a(), u.a);
    if (row.b.kind == ir::FieldKind::kRel32) {
      out.target = i + 1 + static_cast<uint32_t>(u.bc());
      out.jumps = row.ends;
      out.may_jump = !row.ends;
      if (out.jumps) out.next = out.target;
    }
    out.ends = row.calls || (row.ends && !out.jumps);
    if (row.extended && ++i < code.size()) units_[i].units = 0;
  }
}

void StepLine::leave_out(uint32_t first, uint32_t units) {
  for (uint32_t i = first; i < first + units; ++i) units_[i].is_step = false;
}

uint32_t StepWalk::source(const StepLine::Place& place) const {
  if (place.size == 0) return 0;
  for (uint32_t k = length_; k-- > 0;) {
    const StepLine::Unit& earlier = line_[taken_[k]];
    if (earlier.stores) return 0;
    if (earlier.written.size == 0 || !overlap(earlier.written, place)) continue;
    const bool same = earlier.written.offset == place.offset && earlier.written.size == place.size;
    return same ? k + 1 : 0;
  }
  return 0;
}

bool StepWalk::take(StepKey& key) {
  if (is_over_ || length_ == kMaxSteps || next_ >= line_.size()) return false;
  const StepLine::Unit& unit = line_[next_];
  if (!unit.is_step) return false;
  key = unit.handler | source(unit.a) << 16 | source(unit.b) << 20 | source(unit.c) << 24;
  if (goes_back_) ++behind_back_;
  if (unit.jumps && unit.next <= next_) {
    is_over_ = goes_back_;  // once around is enough
    goes_back_ = true;
  }
  taken_[length_++] = next_;
  is_over_ = is_over_ || unit.ends;
  next_ = unit.next;
  return true;
}

FusionTree::FusionTree(std::span<const Fusion> table) : nodes_(1), first_(kHandlerLimit, 0) {
  struct Rows {  // that begin with the steps of a node
    uint32_t first, behind, depth;
  };
  std::vector<Rows> rows = {{0, static_cast<uint32_t>(table.size()), 0}};
  for (uint32_t n = 0; n < nodes_.size(); ++n) {
    auto [at, behind, depth] = rows[n];
    if (at < behind && table[at].length == depth) nodes_[n].row = at++;
    nodes_[n].first = static_cast<uint32_t>(nodes_.size());
    while (at < behind) {
      const uint32_t first = at;
      const StepKey key = table[at].keys[depth];
      while (at < behind && table[at].keys[depth] == key) ++at;
      const auto place = std::find_if(nodes_.begin() + nodes_[n].first, nodes_.end(),
                                      [&](const Node& o) { return o.order > order_of(key); });
      rows.insert(rows.begin() + (place - nodes_.begin()), {first, at, depth + 1});
      nodes_.insert(place, {order_of(key), kNoFusion, 0, 0});
    }
    nodes_[n].behind = static_cast<uint32_t>(nodes_.size());
  }
  for (uint32_t n = nodes_[0].first; n < nodes_[0].behind; ++n) {
    first_[nodes_[n].order >> 16] = static_cast<uint16_t>(n);
  }
}

const FusionTree::Node* FusionTree::next_step(const Node& node, StepWalk& walk) const {
  uint32_t handler = 0;
  if (node.first == node.behind || !walk.next_handler(handler)) return nullptr;
  const auto before = [](const Node& n, uint32_t order) { return n.order < order; };
  const auto end = nodes_.begin() + node.behind;
  auto at = std::lower_bound(nodes_.begin() + node.first, end, order_of(handler), before);
  if (at == end || at->order >> 16 != handler) return nullptr;
  StepKey key = 0;
  walk.take(key);
  at = std::lower_bound(at, end, order_of(key), before);
  return at == end || at->order != order_of(key) ? nullptr : &*at;
}

std::vector<uint32_t> choose_fusions(const StepLine& line, const FusionTree& tree) {
  std::vector<uint32_t> chosen(line.size(), kNoFusion);
  std::vector<uint32_t> cost(size_t{line.size()} + 1, 0);
  for (uint32_t i = line.size(); i-- > 0;) {
    if (line.is_extension(i)) continue;
    const StepLine::Unit& unit = line[i];
    const bool back = unit.jumps && unit.next <= i;
    cost[i] = kDispatch + (back || unit.next > line.size() ? 0 : cost[unit.next]);
    const FusionTree::Node* node = unit.is_step ? tree.first_step(unit.handler) : nullptr;
    if (node == nullptr) continue;
    StepWalk walk(line, i);
    StepKey key = 0;
    walk.take(key);  // no step before it: its handler
    while ((node = tree.next_step(*node, walk)) != nullptr) {
      if (node->row == kNoFusion) continue;
      uint32_t with = kDispatch;
      if (!walk.goes_back()) {
        with += walk.next() > line.size() ? 0 : cost[walk.next()];
      } else {
        with -= std::min(with - 1, kBehindLoop * walk.behind_back());
      }
      if (with > cost[i]) continue;
      cost[i] = with;
      chosen[i] = node->row;
    }
  }
  return chosen;
}

void fuse(const StepLine& line, std::span<ir::Unit> prepared, uint64_t seed) {
  const std::span<const Fusion> table = fusions();
  static const FusionTree tree(table);
  const std::vector<uint32_t> chosen = choose_fusions(line, tree);
  for (uint32_t i = 0; i < line.size(); ++i) {
    if (chosen[i] == kNoFusion || (seed != 0 && takes_random_place(seed, i))) continue;
    prepared[i].op = table[chosen[i]].handler;
  }
}

}  // namespace vm
