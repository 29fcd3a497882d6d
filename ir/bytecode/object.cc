// Canonical form of objects. What is left out on purpose: source lines and the
// file, so that moving a POU in its file or a comment before it does not make
// another POU of it (E1).
#include "ir/bytecode/object.h"

#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"

namespace ir {
namespace {

constexpr size_t kTypesKept = 24;

class Canonical {
 public:
  Canonical(const Object& object, const Program& program, const PouNames& names)
      : object_(object), program_(program), names_(names), types_(program.types) {}

  base::Bytes bytes() {
    out_.text(fold_name(object_.name));
    out_.u8(static_cast<uint8_t>(object_.kind));
    type(object_.self);
    out_.u32(object_.recursion_depth);
    table(object_.slots, &Canonical::slot);
    table(object_.places, &Canonical::place);
    table(object_.constants, &Canonical::constant);
    table(object_.regions, &Canonical::region);
    table(object_.bounds, &Canonical::bound);
    table(object_.ranges, &Canonical::range);
    table(object_.callees, &Canonical::name);
    table(object_.code, &Canonical::unit);
    table(object_.merges, &Canonical::merge);
    return out_.take();
  }

 private:
  template <class T>
  void table(const std::vector<T>& entries, void (Canonical::*write)(const T&)) {
    out_.u32(static_cast<uint32_t>(entries.size()));
    for (const T& entry : entries) (this->*write)(entry);
  }

  void name(const std::string& text) {
    out_.u32(static_cast<uint32_t>(text.size()));
    base::fold_name(text, reinterpret_cast<char*>(out_.extend(text.size())));
  }
  // The text of a type that came before is taken from there.
  void type(TypeId id) {
    if (!id.valid()) return name("");
    for (const WrittenType& row : written_) {
      if (row.type == id) return copy(row);
    }
    const size_t begin = out_.size();
    name(types_.text(id));
    if (written_.size() < kTypesKept) written_.push_back({id, begin, out_.size() - begin});
  }
  struct WrittenType {
    TypeId type;
    size_t begin;
    size_t size;
  };
  void copy(const WrittenType& row) {
    uint8_t* const to = out_.extend(row.size);
    std::memcpy(to, out_.bytes().data() + row.begin, row.size);
  }
  void region(const Region& region) {
    type(region.type);
    out_.u8(region.dim);
  }

  const Pou* callee_of(const Slot& slot) const {
    const auto found = names_.find(fold_name(object_.callees[slot.callee]));
    return found == names_.end() ? nullptr : &program_.pous[found->second.index];
  }

  void slot(const Slot& slot) {
    out_.u8(static_cast<uint8_t>(slot.kind));
    out_.u8(static_cast<uint8_t>(slot.local));
    out_.boolean(slot.aggregate);
    out_.u8(static_cast<uint8_t>(slot.cls));
    region(slot.region);
    name(slot.name);
    if (slot.kind == SlotKind::kArg) {
      name(object_.callees[slot.callee]);
      const Pou* callee = callee_of(slot);
      const bool known = callee != nullptr && slot.param < callee->locals.size();
      name(known ? callee->locals[slot.param].name : "");
    }
    if (slot.kind == SlotKind::kNativeArg) out_.u32(slot.param);
  }

  Region root_of(const ObjectPlace& place) const {
    switch (place.root) {
      case PlaceRoot::kSelf:
        return {object_.self, 0};
      case PlaceRoot::kGlobal:
        return {program_.globals, 0};
      case PlaceRoot::kSlot:
        return object_.slots[place.slot].region;
      case PlaceRoot::kRegion:
      case PlaceRoot::kFixed:
        return place.region;
    }
    return place.region;
  }

  void place(const ObjectPlace& place) {
    out_.u8(static_cast<uint8_t>(place.root));
    out_.u32(place.slot);
    region(place.region);
    Region at = root_of(place);
    out_.u32(static_cast<uint32_t>(place.steps.size()));
    for (const Step& step : place.steps) {
      out_.u8(static_cast<uint8_t>(step.kind));
      if (step.kind == StepKind::kMember) {
        const Member& member = types_[at.type].members[step.index];
        name(member.name);
        at = {member.type, 0};
        continue;
      }
      out_.i64(step.constant_index);
      const Type& array = types_[at.type];
      ++at.dim;
      if (at.dim == array.dims.size() && !types_.is_instance(array.base)) at = {array.base, 0};
    }
    region(place.result);
  }

  void constant(const ObjectConstant& constant) {
    out_.blob(constant.bytes);
    out_.u8(static_cast<uint8_t>(constant.cls));
    type(constant.type);
    if (!constant.type.valid()) return;
    write_canonical(out_, types_, program_.constants, constant.type, constant.value);
  }

  void bound(const Bound& bound) {
    type(bound.array);
    out_.u8(bound.dim);
    name(bound.name);
  }
  void range(const Range& range) {
    out_.i64(range.low);
    out_.i64(range.high);
    name(range.name);
  }
  void unit(const Unit& unit) {
    out_.u64(uint64_t{unit.op} | uint64_t{unit.a} << 16 | uint64_t{unit.b} << 32 |
             uint64_t{unit.c} << 48);
  }
  void merge(const Merge& merge) {
    out_.u32(merge.unit);
    out_.u32(static_cast<uint32_t>(merge.slots.size()));
    for (uint16_t slot : merge.slots) out_.u16(slot);
  }

  const Object& object_;
  const Program& program_;
  const PouNames& names_;
  const TypeTable& types_;
  base::ByteWriter out_;
  std::vector<WrittenType> written_;
};

}  // namespace

PouNames pou_names(const Program& program) {
  PouNames names;
  names.reserve(program.pous.size());
  for (uint32_t i = 0; i < program.pous.size(); ++i) {
    names.try_emplace(fold_name(program.pous[i].name), PouId(i));
  }
  return names;
}

base::Bytes canonical_bytes(const Object& object, const Program& program) {
  return Canonical(object, program, pou_names(program)).bytes();
}

base::Digest identity(const Object& object, const Program& program, const PouNames& names) {
  return base::sha256(Canonical(object, program, names).bytes());
}

}  // namespace ir
