#include "ir/bytecode/bools.h"

#include <array>
#include <cstring>
#include <span>

#include "base/limits.h"
#include "ir/bytecode/regions.h"

namespace ir {
namespace {

// Counts of units of instructions, by opcode.
const std::array<uint8_t, kOpcodeCount>& unit_counts() {
  static const std::array<uint8_t, kOpcodeCount> kUnits = [] {
    std::array<uint8_t, kOpcodeCount> units{};
    for (uint32_t i = 0; i < kOpcodeCount; ++i) {
      units[i] = opcode_row(static_cast<Opcode>(i)).extended ? 2 : 1;
    }
    return units;
  }();
  return kUnits;
}

std::span<const Unit> code_of(const Image& image, const LinkedPou& pou) {
  return std::span(image.code).subspan(pou.first_unit, pou.unit_count);
}

bool same_code(std::span<const Unit> a, std::span<const Unit> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

// Through references, which may have been converted?
bool writes_through_references(const TypeTable& types, std::span<const Unit> code) {
  const std::array<uint8_t, kOpcodeCount>& units = unit_counts();
  for (size_t i = 0, next = 0; i < code.size(); i = next) {
    const Opcode op = code[i].opcode();
    next = i + units[static_cast<size_t>(op)];
    if (op < Opcode::RESOLVE || op > Opcode::RESOLVE_W) continue;
    // An instance is exactly that, or of a type that extends it.
    const bool plain =
        op == Opcode::RESOLVE && !types.is_instance(region_of_field(code[i + 1].x()).type);
    if (plain || op == Opcode::RESOLVE_S || op == Opcode::RESOLVE_W) return true;
  }
  return false;
}

}  // namespace

Bools::Bools(const Image& image, const Bools* known) : image_(image) {
  if (known != nullptr && stay_alike(known->image_, image)) {
    holds_ = known->holds_;
    stay_clean_ = known->stay_clean_;
    return;
  }
  holds_.resize(image.types.size(), Holds::kUnknown);
  stay_clean_ = !writes_as_others();
}

bool stay_alike(const Image& a, const Image& b) {
  if (!a.types.is_one_with(b.types) || a.pous.size() != b.pous.size()) return false;
  for (size_t i = 0; i < a.pous.size(); ++i) {
    const std::span<const Unit> before = code_of(a, a.pous[i]);
    const std::span<const Unit> after = code_of(b, b.pous[i]);
    if (same_code(before, after)) continue;
    if (writes_through_references(a.types, before) || writes_through_references(b.types, after)) {
      return false;
    }
  }
  return true;
}

// IDs and addresses, not the value itself.
bool Bools::is_slot(const Member& member) const {
  return member.section == Section::kInOut || image_.types.is_instance(member.type);
}

bool Bools::find(TypeId id, uint32_t depth) {
  Holds& known = holds_[id.index];
  if (known != Holds::kUnknown) return known == Holds::kYes;
  known = Holds::kNo;
  if (depth > base::kMaxNesting) return false;
  bool found = false;
  const Type& type = image_.types[id];
  if (image_.types.is_scalar(id)) {
    found = image_.types.scalar(id) == Scalar::kBool;
  } else if (type.kind == Kind::kArray) {
    found = !image_.types.is_instance(type.base) && find(type.base, depth + 1);
  }
  for (const Member& member : type.members) {
    if (!is_slot(member) && find(member.type, depth + 1)) found = true;
  }
  holds_[id.index] = found ? Holds::kYes : Holds::kNo;
  return found;
}

// Through members that overlap, or through references.
bool Bools::writes_as_others() {
  bool found = false;
  for (uint32_t i = 0; i < image_.types.size(); ++i) {
    const bool holds = find(TypeId(i), 0);
    found |= holds && image_.types.overlaps(TypeId(i));
  }
  // Every unit belongs to one POU.
  return found || writes_through_references(image_.types, image_.code);
}

uint64_t Bools::count_in(TypeId id, uint32_t depth) const {
  if (holds_[id.index] != Holds::kYes || depth > base::kMaxNesting) return 0;
  const Type& type = image_.types[id];
  if (image_.types.is_scalar(id)) return 1;
  if (type.kind == Kind::kArray) {
    const uint32_t stride = image_.layouts[type.base].size;
    return stride == 0 ? 0 : image_.layouts[id].size / stride * count_in(type.base, depth + 1);
  }
  uint64_t sum = 0;
  for (const Member& member : type.members) {
    if (!is_slot(member)) sum += count_in(member.type, depth + 1);
  }
  return sum;
}

uint64_t Bools::count() const {
  uint64_t sum = 0;
  for (size_t id = 0; id < image_.instances.size(); ++id) {
    const Instance& row = image_.instances[id];
    if (id == 0 || row.live) sum += count_in(row.type, 0);
  }
  return sum;
}

void Bools::normalise(TypeId type, uint8_t* value) const { normalise(type, value, 0); }

// What overlaps is no BOOL alone, and in no program whose BOOLs stay clean.
void Bools::normalise(TypeId id, uint8_t* value, uint32_t depth) const {
  if (holds_[id.index] != Holds::kYes || depth > base::kMaxNesting) return;
  const Type& type = image_.types[id];
  if (image_.types.overlaps(id)) return;
  if (image_.types.is_scalar(id)) return normalise_bools(value, 1);
  if (type.kind == Kind::kArray) {
    const uint32_t size = image_.layouts[id].size;
    const uint32_t stride = image_.layouts[type.base].size;
    if (image_.types.is_scalar(type.base)) return normalise_bools(value, size);
    for (uint32_t at = 0; stride != 0 && at < size; at += stride) {
      normalise(type.base, value + at, depth + 1);
    }
    return;
  }
  const std::vector<uint32_t>& offsets = image_.layouts[id].member_offsets;
  for (size_t i = 0; i < type.members.size(); ++i) {
    const Member& member = type.members[i];
    if (!is_slot(member)) normalise(member.type, value + offsets[i], depth + 1);
  }
}

void Bools::normalise_all(uint8_t* memory) const {
  for (size_t id = 0; id < image_.instances.size(); ++id) {
    const Instance& row = image_.instances[id];
    if (id == 0 || row.live) normalise(row.type, memory + row.data);
  }
}

void normalise_bools(uint8_t* at, size_t count) {
  for (size_t i = 0; i < count; ++i) at[i] = at[i] != 0 ? 1 : 0;
}

}  // namespace ir
