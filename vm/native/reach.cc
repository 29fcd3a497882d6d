// What loads and stores through addresses may reach, and what that leaves to registers.
#include <algorithm>

#include "ir/bytecode/regions.h"
#include "stdlib/native/natives.h"
#include "vm/native/facts.h"
#include "vm/native/host.h"

namespace vm::native {
namespace {

using ir::Opcode;

constexpr size_t kMostParts = 6;
constexpr size_t kMostDeferred = 24;  // of one loop: every exit of it stores them

bool loads_through(Opcode op) { return op >= Opcode::LD_B && op <= Opcode::LD_F64; }
bool stores_through(Opcode op) {
  return (op >= Opcode::ST_B && op <= Opcode::ST_F64) || op == Opcode::ST_REF_AT ||
         op == Opcode::COPY || op == Opcode::SCOPY || op == Opcode::WCOPY;
}
// A text that is the result is written through the first argument.
bool native_writes(const ir::Unit& unit) { return stdlib::native_row(unit.c).result == 'v'; }
// Does the unit put an address or a string into a frame slot?
bool makes_address(const ir::Unit& unit) {
  const ir::Field& field = ir::opcode_row(unit.opcode()).a;
  const bool address =
      field.cls == ir::Class::kA || field.cls == ir::Class::kS || field.cls == ir::Class::kW;
  return address && field.is_near() && field.writes() && unit.base_a() == ir::Base::kFrame;
}

}  // namespace

bool Reach::join(const Reach& other) {
  if (everything) return false;
  if (other.everything) return everything = true;
  bool changed = other.own_instance && !own_instance;
  own_instance |= other.own_instance;
  for (const Part& part : other.parts) {
    if (std::find(parts.begin(), parts.end(), part) != parts.end()) continue;
    changed = true;
    if (parts.size() == kMostParts) return everything = true;
    parts.push_back(part);
  }
  return changed;
}

// What the address or string that the unit makes may point to.
Reach Facts::reach_of_unit(uint32_t i) const {
  const ir::Unit& unit = code_[i];
  const ir::Unit& more = extension(i);
  const Opcode op = unit.opcode();
  Reach reach;
  const auto of_slot = [&](ir::Base base, uint32_t offset) {
    const Reach* const found = base == ir::Base::kFrame ? reach_.find(offset) : nullptr;
    return found != nullptr ? *found : Reach{true, false, {}};
  };
  const auto size_of = [&](uint32_t field) {
    return uint64_t{ir::region_size(image_->types, image_->layouts, ir::region_of_field(field))};
  };
  if (op >= Opcode::INDEX_PLACE_I8 && op <= Opcode::INDEX_PLACE_U64) {
    const ir::LinkedBound& bound = image_->bounds[more.x()];
    reach.parts.push_back({unit.base_c(), more.y(), more.y() + bound.count * bound.stride});
  } else if (op >= Opcode::INDEX_I8 && op <= Opcode::INDEX_U64) {
    return of_slot(unit.base_c(), unit.c);
  } else if (op == Opcode::LEA) {
    reach.parts.push_back({unit.base_b(), more.x(), more.x() + size_of(more.y())});
  } else if (op == Opcode::LEA_AT || op == Opcode::MOV_A || op == Opcode::MOV_S ||
             op == Opcode::MOV_W || op == Opcode::STR_AT || op == Opcode::WSTR_AT) {
    return of_slot(unit.base_b(), unit.b);
  } else if (op == Opcode::STR || op == Opcode::WSTR) {
    const uint64_t unit_size = op == Opcode::STR ? 1 : 2;
    reach.parts.push_back(
        {unit.base_b(), more.x(), more.x() + (uint64_t{more.y()} + 1) * unit_size});
  } else if (op == Opcode::INST) {
    // What is inside of an instance is not the instance itself; a global one may be it.
    reach.own_instance = unit.base_b() != ir::Base::kSelf;
  } else if (op == Opcode::RESOLVE && resolves_instance(i)) {
    reach.own_instance = may_be_own(ir::region_of_field(more.x()).type);
  } else if (op == Opcode::INST_AT) {
    const Reach from = of_slot(unit.base_b(), unit.b);
    reach.own_instance = from.everything || from.own_instance || from.parts.empty();
    for (const Reach::Part& part : from.parts) {
      reach.own_instance |= part.base != ir::Base::kSelf;
    }
  } else {
    reach.everything = true;
  }
  return reach;
}

void Facts::find_reach() {
  // Addresses that come from outside: in-out parameters.
  for (const ir::FrameSlot& slot : pou_->slots) {
    if (slot.kind == ir::SlotKind::kParam && !slot.aggregate) {
      reach_[slot.offset].everything = true;
    }
  }
  // What a unit writes points nowhere until that unit is looked at.
  std::vector<uint32_t> makers;
  for (uint32_t i = 0; i < code_.size(); i = next(i)) {
    if (!makes_address(code_[i])) continue;
    makers.push_back(i);
    reach_[code_[i].a];
  }
  for (bool changed = !makers.empty(); changed;) {
    changed = false;
    for (const uint32_t i : makers) {
      const Reach reach = reach_of_unit(i);
      changed |= reach_[code_[i].a].join(reach);
    }
  }
  find_targets();
}

// Values with slots inside are seldom, and the interpreter knows where they may lie.
bool Facts::follows_bytes(uint32_t i) const {
  constexpr uint64_t kMostBytes = uint64_t{1} << 30;  // that a displacement takes
  if (!host::kFollowsHandles || code_[i].opcode() != Opcode::RESOLVE) return false;
  const ir::TypeId type = ir::region_of_field(extension(i).x()).type;
  const uint64_t size = image_->layouts[type].size;
  const bool fits = size != 0 && size < kMostBytes && extension(i).y() < kMostBytes;
  return fits && !has_slots(type);  // as those of instances have
}

// Innermost loops that follow pointers and call nothing.
void Facts::find_walked(const std::vector<uint32_t>& unwalked) {
  std::vector<bool> outer(loops_.size(), false);
  for (const Loop& loop : loops_) {
    if (loop.parent != kNone) outer[loop.parent] = true;
  }
  for (uint32_t l = 0; l < loops_.size(); ++l) {
    const uint32_t first = blocks_[loops_[l].head].first;
    if (outer[l] || std::ranges::find(unwalked, first) != unwalked.end()) continue;
    bool follows = false;
    bool calls = false;
    for (uint32_t i = first; i < blocks_[loops_[l].last].behind; i = next(i)) {
      calls |= is_call(code_[i].opcode());
      follows |= follows_bytes(i);
    }
    walked_[l] = follows && !calls;
  }
}

// What stores write, and copies read, each where it stands: of the slot with the address the last
// unit in front says where that is.
void Facts::find_targets() {
  NumberTable made_by;  // unit, by offset of a frame slot
  bool walks = false;
  const auto at = [&](uint32_t slot) {
    const uint32_t near = made_by.find(slot);
    if (near != kNone && walks && follows_bytes(near)) return Reach();
    if (near != kNone) return reach_of_unit(near);
    const Reach* const any = reach_.find(slot);
    return any == nullptr ? Reach{true, false, {}} : *any;
  };
  for (const UnitRange& block : blocks_) {
    made_by.clear();
    walks = is_walked(loop_of_[block_at_[block.first]]);
    for (uint32_t i = block.first; i < block.behind; i = next(i)) {
      const ir::Unit& unit = code_[i];
      const Opcode op = unit.opcode();
      if (stores_through(op)) targets_[i] = at(unit.a);
      if (op == Opcode::COPY || (walks && loads_through(op))) sources_[i] = at(unit.b);
      if (op == Opcode::NATIVE && native_writes(unit)) targets_[i] = at(unit.a * 8u);
      if (is_call(op) || op == Opcode::NATIVE) made_by.clear();  // the next frame is used
      if (makes_address(unit)) made_by.set(unit.a, i);
    }
  }
}

namespace {

constexpr uint64_t kWidest = 8;  // bytes of a variable

bool is_reached(const Reach& reach, const Variable& variable) {
  return std::any_of(reach.parts.begin(), reach.parts.end(), [&](const Reach::Part& part) {
    return base_of(part.base) == variable.base && variable.offset < part.end &&
           part.begin < uint64_t{variable.offset} + variable.width;
  });
}

}  // namespace

void Facts::killed(uint32_t i, std::vector<uint32_t>& out) const {
  for (const InPlace& here : bodies_at(i)) used_by_body(here.pou, here.body->effects.writes, out);
  if (has_body(i)) return;
  if (const Reach* const target = targets_.find(i)) touched(*target, out);
  if (code_[i].opcode() != Opcode::NATIVE) return;
  // The result lies in the first slot.
  const uint32_t result = code_[i].a * 8u;
  for (uint32_t v = 0; v < variables_.size(); ++v) {
    const Variable& variable = variables_[v];
    if (variable.base == MemBase::kFrame && variable.offset < result + 8 &&
        result < variable.offset + variable.width) {
      out.push_back(v);
    }
  }
}

void Facts::seen(uint32_t i, std::vector<uint32_t>& out) const {
  const Opcode op = code_[i].opcode();
  for (const InPlace& here : bodies_at(i)) used_by_body(here.pou, here.body->effects.reads, out);
  const Reach* const source = sources_.find(i);
  if (source != nullptr) return touched(*source, out);
  if (!loads_through(op)) return;
  const Reach* const found = reach_.find(code_[i].b);
  touched(found == nullptr ? Reach{true, false, {}} : *found, out);
}

uint32_t Facts::copied_bytes(uint32_t i) const {
  return ir::region_size(image_->types, image_->layouts, ir::region_of_field(extension(i).x()));
}

bool Facts::may_overlap(uint32_t i) const {
  const Reach& to = *targets_.find(i);
  const Reach& from = *sources_.find(i);
  const auto is_unknown = [](const Reach& reach) {
    return reach.everything || reach.own_instance || reach.parts.empty();  // of an instance inside
  };
  if (is_unknown(to) || is_unknown(from)) return true;
  for (const Reach::Part& a : to.parts) {
    for (const Reach::Part& b : from.parts) {
      if (a.base == b.base && a.begin < b.end && b.begin < a.end) return true;
      // The frame is apart from everything else.
      const bool apart = (a.base == ir::Base::kFrame) != (b.base == ir::Base::kFrame);
      if (a.base != b.base && !apart) return true;
    }
  }
  return false;
}

// Variables where an address may point to, in their order.
void Facts::touched(const Reach& reach, std::vector<uint32_t>& out) const {
  const auto is_in_memory = [this](uint32_t v) {
    return !variables_[v].slot && !variables_[v].constant;
  };
  if (reach.everything || reach.own_instance) {
    for (uint32_t v = 0; v < variables_.size(); ++v) {
      const bool may = reach.everything || variables_[v].base == MemBase::kSelf ||
                       is_reached(reach, variables_[v]);
      if (may && is_in_memory(v)) out.push_back(v);
    }
    return;
  }
  const auto first = static_cast<ptrdiff_t>(out.size());
  for (const Reach::Part& part : reach.parts) {
    const MemBase base = base_of(part.base);
    // No part is wider than the widest scalar.
    const uint64_t begin = part.begin < kWidest ? 0 : part.begin - kWidest + 1;
    auto v = std::lower_bound(by_place_.begin(), by_place_.end(), std::pair(base, begin),
                              [this](uint32_t a, const std::pair<MemBase, uint64_t>& place) {
                                const Variable& variable = variables_[a];
                                if (variable.base != place.first)
                                  return variable.base < place.first;
                                return uint64_t{variable.offset} < place.second;
                              });
    for (; v != by_place_.end() && variables_[*v].base == base; ++v) {
      if (variables_[*v].offset >= part.end) break;
      if (is_reached(reach, variables_[*v]) && is_in_memory(*v)) out.push_back(*v);
    }
  }
  std::sort(out.begin() + first, out.end());
  out.erase(std::unique(out.begin() + first, out.end()), out.end());
}

bool Facts::writes_memory(uint32_t i) const {
  const Opcode op = code_[i].opcode();
  return stores_through(op) || op == Opcode::NATIVE || has_body(i);
}

// Only of innermost loops without calls: nothing but their own code is executed until they end, or
// are left by an exit, which stores what is newer than memory. A BOOL may be any byte until
// something writes it.
void Facts::find_deferred() {
  loop_deferred_.resize(loops_.size());
  std::vector<bool> outer(loops_.size(), false);
  for (const Loop& loop : loops_) {
    if (loop.parent != kNone) outer[loop.parent] = true;
  }
  std::vector<uint32_t> seen_there;
  for (uint32_t l = 0; l < loops_.size(); ++l) {
    if (outer[l] || loop_calls_[l]) continue;
    const Loop& loop = loops_[l];
    seen_there.clear();
    for (uint32_t i = blocks_[loop.head].first; i < blocks_[loop.last].behind; i = next(i)) {
      seen(i, seen_there);
    }
    std::sort(seen_there.begin(), seen_there.end());
    for (const uint32_t v : loop.modified) {
      Variable& variable = variables_[v];
      const bool shared = variable.base == MemBase::kSelf || variable.base == MemBase::kData;
      if (!shared || variable.boolean || variable.constant || !overlaps_[v].empty()) continue;
      if (!live_in(loop.head, v) || killed_in(l, v)) continue;
      if (std::binary_search(seen_there.begin(), seen_there.end(), v)) continue;
      if (loop_deferred_[l].size() == kMostDeferred) break;
      loop_deferred_[l].push_back(v);
      variable.deferred = true;
    }
  }
}

}  // namespace vm::native
