#include "vm/load/writers.h"

#include <algorithm>
#include <tuple>

#include "vm/load/writer_search.h"

namespace vm {
namespace {

using How = Writer::How;
using Kind = Origin::Kind;

}  // namespace

// Can the variable be what an address of that kind points to? References take any type, and so do
// VAR_IN_OUTs that they are bound to.
bool WriterSearch::fits(const Target& target, const AddressUse& unknown) const {
  if (target.retyped) return true;
  if (unknown.from != Kind::kInOut || target.overlaid || !unknown.region.type.valid()) {
    const bool text = unknown.from == Kind::kInOut && !target.overlaid;
    const ir::Kind kind = image_.types[target.type].kind;
    return !text || unknown.use != AddressUse::Use::kStored || kind == ir::Kind::kString ||
           kind == ir::Kind::kWstring;
  }
  const ir::TypeId wanted = unknown.region.type;
  const bool scalar = image_.types.is_scalar(wanted);
  for (const Around& around : target.around) {
    const uint64_t end = around.offset + (target.end - target.begin);
    const bool there = unknown.region.dim != 0 ||
                       (unknown.offset < end && around.offset < unknown.offset + unknown.size);
    if (!there) continue;
    if (scalar) {
      if (!image_.types.is_scalar(around.type)) continue;
      const ir::Class have = ir::class_of(image_.types.scalar(around.type));
      if (have == ir::class_of(image_.types.scalar(wanted))) return true;
    } else if (image_.types[wanted].kind == image_.types[around.type].kind) {
      return true;
    }
  }
  return false;
}

// Can an address from outside be that of the variable?
bool WriterSearch::reaches(const Target& target, const AddressUse& unknown) const {
  const bool escaped = unknown.from == Kind::kAnywhere ||
                       (unknown.from == Kind::kInOut ? target.in_out : target.referenced);
  return escaped && fits(target, unknown);
}

// What becomes of an address that left its POU once.
void WriterSearch::find_escapes(Target& target) const {
  target.referenced |= calculates_;
  for (bool changed = true; changed;) {
    changed = false;
    for (const AddressUse& unknown : unknown_) {
      if (unknown.use == AddressUse::Use::kStored) continue;
      const bool passed = unknown.use == AddressUse::Use::kPassed;
      const bool retypes = passed && unknown.from != Kind::kInOut && !target.retyped;
      bool& more = passed ? target.in_out : target.referenced;
      if ((more && !retypes) || !reaches(target, unknown)) continue;
      changed = more = true;
      target.retyped |= retypes;
    }
  }
}

// By POUs in their order; as many as can be asked for.
void WriterSearch::find_by_address(uint32_t target) {
  find_escapes(targets_[target]);
  uint32_t pou = UINT32_MAX;
  size_t pous = 0;
  for (const AddressUse& unknown : unknown_) {
    if (unknown.use != AddressUse::Use::kStored || !reaches(targets_[target], unknown)) continue;
    if (unknown.pou != pou && ++pous > kMostAddressPous) return;
    pou = unknown.pou;
    found_.push_back({target, unknown.pou, unknown.unit, How::kAddress});
  }
}

std::vector<Writer> WriterSearch::run(const std::vector<bool>* running) {
  for (uint32_t pou = 0; pou < image_.pous.size(); ++pou) look_at(pou);
  if (running != nullptr) {
    std::erase_if(found_, [&](const Writer& writer) { return !(*running)[writer.pou]; });
    std::erase_if(unknown_, [&](const AddressUse& unknown) {
      return unknown.use == AddressUse::Use::kStored && !(*running)[unknown.pou];
    });
  }
  for (uint32_t i = 0; i < targets_.size(); ++i) find_by_address(i);
  std::stable_sort(found_.begin(), found_.end(), [](const Writer& a, const Writer& b) {
    return std::tie(a.variable, a.pou, a.unit) < std::tie(b.variable, b.pou, b.unit);
  });
  return std::move(found_);
}

WriteEffects WriterSearch::effects(std::span<const uint32_t> pous) {
  for (const uint32_t pou : pous) look_at(pou);
  WriteEffects out;
  out.of_variables.resize(targets_.size());
  for (const Writer& writer : found_) out.of_variables[writer.variable] |= WriteEffects::kWrites;
  for (size_t i = 0; i < targets_.size(); ++i) {
    if (targets_[i].in_out) out.of_variables[i] |= WriteEffects::kPasses;
    if (targets_[i].referenced) out.of_variables[i] |= WriteEffects::kReferences;
  }
  for (const AddressUse& unknown : unknown_) {
    const uint64_t uses =
        static_cast<uint64_t>(unknown.use) << 8 | static_cast<uint64_t>(unknown.from);
    out.of_addresses.insert(
        {uses, unknown.region.type.index, unknown.region.dim, unknown.offset, unknown.size});
  }
  out.calculates = calculates_;
  return out;
}

bool WriteEffects::include(const WriteEffects& others) const {
  const auto has_all = [](uint8_t have, uint8_t wanted) { return (wanted & ~have) == 0; };
  return std::ranges::equal(of_variables, others.of_variables, has_all) &&
         std::ranges::includes(of_addresses, others.of_addresses) &&
         (calculates || !others.calculates);
}

WriteEffects write_effects(const ir::Image& image, std::span<const Variable> variables,
                           std::span<const uint32_t> pous) {
  return WriterSearch(image, variables).effects(pous);
}

std::vector<Writer> find_writers(const ir::Image& image, std::span<const Variable> variables,
                                 const std::vector<bool>* running) {
  return WriterSearch(image, variables).run(running);
}

}  // namespace vm
