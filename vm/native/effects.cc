// Calls that a body stands in the place of, and what those bodies do to the caller's variables.
#include <algorithm>

#include "vm/native/facts.h"

namespace vm::native {
namespace {

using ir::Opcode;

constexpr size_t kMostEffectNodes = 200'000;  // of one POU with everything in it
// An execution that was interrupted in a body goes on in machine code after a call or at a loop;
// so one call in so many stays one.
constexpr uint32_t kCallsBetween = 32;

bool any_overlaps(const std::vector<std::pair<uint64_t, uint64_t>>& parts, const Variable& v) {
  return std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
    return v.offset < part.second && part.first < uint64_t{v.offset} + v.width;
  });
}

}  // namespace

Effects effects_of(const Function& body) {
  Effects out;
  for (const Node& n : body.nodes) {
    if (n.op == Op::kNative) out.reads.everywhere = out.writes.everywhere = true;
    if (n.dead || (n.op != Op::kLoad && n.op != Op::kStore)) continue;
    Effects::Use& use = n.op == Op::kLoad ? out.reads : out.writes;
    if (n.mem.base == MemBase::kSelf) use.own_instance = true;
    if (n.mem.inside) use.everywhere = true;
    if (n.mem.base != MemBase::kData) continue;
    if (n.mem.index != kNone) {
      use.everywhere = true;
    } else {
      const auto begin = static_cast<uint64_t>(n.mem.disp);
      use.data.push_back({begin, begin + n.width});
    }
  }
  return out;
}

uint32_t Facts::callee(uint32_t i) const {
  const ir::Unit& unit = code_[i];
  switch (unit.opcode()) {
    case Opcode::CALL:
    case Opcode::CALL_OWN:
      return unit.c;
    case Opcode::CALL_INST:
    case Opcode::CALL_INST_AT:
      return called_body(*image_, *common_, *pou_, unit);
    case Opcode::CALL_METHOD:
    case Opcode::CALL_METHOD_AT:
    case Opcode::CALL_METHOD_REF:
      return extension(i).x();
    case Opcode::CALL_REF: {
      const std::vector<ir::TypeId>* const kinds = kinds_called(i);
      const bool one = kinds != nullptr && kinds->size() == 1;
      return one ? common_->body_of[kinds->front().index] : kNone;
    }
    default:
      return kNone;
  }
}

// What may stand in the place of the call; false: something may run that has no body.
bool Facts::find_body(const BodyOf& body_of, uint32_t i, std::vector<InPlace>& out) const {
  const Opcode op = code_[i].opcode();
  if (op == Opcode::CALL_VIRTUAL) {
    for (const ir::LinkedOverride& row : common_->targets_of(extension(i).x())) {
      out.push_back({body_of(row.target), row.target, row.type});
    }
  } else if (const uint32_t number = callee(i); number != kNone) {
    out.push_back({body_of(number), number, {}});
  }
  return !out.empty() && std::all_of(out.begin(), out.end(), [&](const InPlace& here) {
    return here.body != nullptr && image_->pous[here.pou].recursion_depth == 0;
  });
}

void Facts::find_bodies(const BodyOf& body_of) {
  if (!body_of) return;
  size_t nodes = code_.size();
  uint32_t calls = 0;
  std::vector<InPlace> found;
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    const Opcode op = code_[i].opcode();
    if (!is_call(op) || nodes > kMostEffectNodes) continue;
    const bool of_instance =
        op == Opcode::CALL_INST || op == Opcode::CALL_INST_AT || op == Opcode::CALL_REF;
    if (of_instance && recursive_bodies()) continue;
    if (op == Opcode::CALL_VIRTUAL && recursive_methods()) continue;
    if (op == Opcode::CALL_METHOD_REF && kinds_called(i) == nullptr) continue;
    found.clear();
    if (!find_body(body_of, i, found)) continue;
    if (loop_of_[block_at_[i]] == kNone && ++calls % kCallsBetween == 0) continue;
    for (const InPlace& here : found) nodes += here.body->function.nodes.size();
    bodies_[i] = found;
  }
}

std::span<const InPlace> Facts::bodies_at(uint32_t unit) const {
  const std::vector<InPlace>* const found = bodies_.find(unit);
  return found == nullptr ? std::span<const InPlace>() : std::span<const InPlace>(*found);
}

bool may_share_instance(const ir::Image& image, const ir::LinkedPou& a, const ir::LinkedPou& b) {
  if (!a.self.valid() || !b.self.valid()) return false;
  return image.types.is_a(a.self, b.self) || image.types.is_a(b.self, a.self);
}

// The callee's frame is its own, from the arguments on.
void Facts::used_by_body(uint32_t pou, const Effects::Use& use, std::vector<uint32_t>& out) const {
  const bool own = use.own_instance && may_share_instance(*image_, *pou_, image_->pous[pou]);
  for (uint32_t v = 0; v < variables_.size(); ++v) {
    const Variable& variable = variables_[v];
    if (variable.slot || variable.constant) continue;
    const bool next_frame = variable.base == MemBase::kFrame && variable.offset >= pou_->frame_size;
    const bool named = variable.base == MemBase::kData && any_overlaps(use.data, variable);
    const bool self = own && variable.base == MemBase::kSelf;
    if (use.everywhere || next_frame || named || self) out.push_back(v);
  }
}

}  // namespace vm::native
