#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/verify_code.h"

namespace ir::verification {
namespace {

std::string at_text(uint32_t offset) { return " at offset " + std::to_string(offset); }

}  // namespace

// Reads come before writes.
bool CodeVerifier::plain(const OpcodeChecks& checks) {
  const OperandCheck& a = checks.a;
  const OperandCheck& b = checks.b;
  const OperandCheck& c = checks.c;
  return (!b.reads || operand(b.cls, u_.base_b(), u_.b, false)) &&
         (!c.reads || operand(c.cls, u_.base_c(), u_.c, false)) &&
         (!a.reads || operand(a.cls, u_.base_a(), u_.a, false)) &&
         (!a.writes || operand(a.cls, u_.base_a(), u_.a, true));
}

bool CodeVerifier::scalar_access(Place place, Class cls, bool write) {
  if (place.base == Base::kFrame) return frame_scalar(place.offset, cls, write);
  if (place.base == Base::kConst) {
    return write ? fail(Refusal::kBadTyping, "a constant is written")
                 : pool_scalar(place.offset, cls);
  }
  const uint32_t shown = place.offset;
  const bool self = place.base == Base::kSelf;
  const std::optional<Region> root = root_region(place);
  if (!root) return false;
  if (const ScalarPlace* const scalar = context_.regions.scalar_at(*root, place.offset)) {
    if (write && !self && scalar->flags.output) {
      facts_.written_outputs.push_back({shown, class_size(cls)});
    }
    return check_access(*scalar, cls, write);
  }
  if (!leaf_access(*root, place.offset, cls, write, self ? "self" : "global")) return false;
  if (write && !self) {
    const auto leaf = context_.regions.leaf_at(*root, place.offset);
    if (leaf && leaf->output) facts_.written_outputs.push_back({shown, class_size(cls)});
  }
  return true;
}

// The region that a self or global place is inside of; makes its offset relative to it.
std::optional<Region> CodeVerifier::root_region(Place& place) {
  if (place.base == Base::kSelf) {
    if (pou_.self.valid()) return Region{pou_.self, 0};
    fail(Refusal::kBadReference, "a function has no variables of its own");
    return std::nullopt;
  }
  if (place.offset < globals_begin_) {
    fail_at(Refusal::kBadReference, "no global", place.offset);
    return std::nullopt;
  }
  place.offset -= globals_begin_;
  return Region{image_.globals, 0};
}

bool CodeVerifier::leaf_access(Region region, uint32_t offset, Class cls, bool write,
                               const char* base) {
  if (const ScalarPlace* const scalar = context_.regions.scalar_at(region, offset)) {
    return check_access(*scalar, cls, write);
  }
  const auto fits = [&](const Leaf& leaf) {
    return leaf.kind == LeafKind::kScalar && leaf.begin == offset &&
           class_of(image_.types.scalar(leaf.type)) == cls;
  };
  std::optional<Leaf> leaf = context_.regions.leaf_at(region, offset, fits);
  if (!leaf) leaf = context_.regions.leaf_at(region, offset);  // to say what is there
  if (!leaf || leaf->kind != LeafKind::kScalar || leaf->begin != offset) {
    const std::string what = std::string("no ") + base + " scalar";
    return fail_at(Refusal::kBadReference, what.c_str(), offset);
  }
  const Class have = class_of(image_.types.scalar(leaf->type));
  return check_access({leaf->begin, have, {leaf->constant, leaf->input, leaf->output}}, cls, write);
}

bool CodeVerifier::check_access(const ScalarPlace& there, Class cls, bool write) {
  if (there.cls != cls) {
    const std::string classes = " has class " + std::string(class_name(there.cls)) +
                                ", needed is " + std::string(class_name(cls));
    return fail_at(Refusal::kBadTyping, "the variable", there.offset, classes.c_str());
  }
  if (write && there.flags.input) return fail(Refusal::kBadIoAccess, "an input is written");
  if (write && there.flags.constant) return fail(Refusal::kBadReference, "a CONSTANT is written");
  return true;
}

// They lie in the pool.
void CodeVerifier::uses_pool(uint32_t offset, uint64_t size) {
  facts_.constants.push_back({offset, static_cast<uint32_t>(size)});
}

// However many units name them, in whatever order.
void CodeVerifier::join_constants() {
  std::vector<Extent>& named = facts_.constants;
  std::sort(named.begin(), named.end(),
            [](const Extent& a, const Extent& b) { return a.offset < b.offset; });
  size_t count = 0;
  for (const Extent& extent : named) {
    const uint64_t end = uint64_t{extent.offset} + extent.size;
    Extent* const last = count == 0 ? nullptr : &named[count - 1];
    if (last == nullptr || uint64_t{last->offset} + last->size < extent.offset) {
      named[count++] = extent;
    } else if (uint64_t{last->offset} + last->size < end) {
      last->size = static_cast<uint32_t>(end - last->offset);
    }
  }
  named.resize(count);
  named.shrink_to_fit();
}

bool CodeVerifier::pool_scalar(uint32_t offset, Class cls) {
  if (uint64_t{offset} + class_size(cls) > image_.pool.size()) {
    return fail_at(Refusal::kBadReference, "no constant", offset);
  }
  uses_pool(offset, class_size(cls));
  if (cls == Class::kB && image_.pool[offset] > 1) {
    return fail(Refusal::kBadTyping, "a BOOL constant is neither 0 nor 1");
  }
  return true;
}

uint32_t CodeVerifier::slot_at(uint32_t offset) const {
  if (offset < frame_.size()) {
    const uint32_t slot = frame_[offset] & kNoSlot;
    return slot == kNoSlot ? kNone : slot;
  }
  const auto behind =
      std::upper_bound(slots_.begin(), slots_.end(), offset,
                       [](uint32_t at, const FrameSlot& slot) { return at < slot.offset; });
  return behind == slots_.begin() ? kNone : static_cast<uint32_t>(behind - slots_.begin() - 1);
}

uint32_t CodeVerifier::scalar_slot(uint32_t offset, Class cls) const {
  if (offset < frame_.size()) {
    return frame_[offset] >> kClassShift == number_of(cls) ? frame_[offset] & kNoSlot : kNone;
  }
  const uint32_t slot = slot_at(offset);
  if (slot == kNone) return kNone;
  const FrameSlot& s = slots_[slot];
  return s.offset == offset && !s.aggregate && s.cls == cls ? slot : kNone;
}

void CodeVerifier::mark_written(uint32_t slot, bool read_only, uint32_t outgoing) {
  states_[slot] = {epoch_, outgoing, read_only};
}

bool CodeVerifier::frame_scalar(uint32_t offset, Class cls, bool write) {
  if (offset >= pou_.frame_size) return next_scalar(offset - pou_.frame_size, cls, write);
  const uint32_t slot = slot_at(offset);
  if (slot != kNone && slots_[slot].aggregate) {
    const FrameSlot& s = slots_[slot];
    return leaf_access(s.region, offset - s.offset, cls, write, "frame");
  }
  if (slot == kNone || slots_[slot].offset != offset || slots_[slot].cls != cls) {
    return fail_without_slot(Refusal::kBadTyping, cls, offset);
  }
  if (write) {
    mark_written(slot, false, 0);
  } else if (!is_written(slot)) {
    return fail_at(Refusal::kReadBeforeWrite, "the slot", offset, " holds no value yet");
  }
  return true;
}

std::optional<Pointer> CodeVerifier::read_pointer(uint32_t offset, Class cls) {
  const uint32_t slot = offset < pou_.frame_size ? scalar_slot(offset, cls) : kNone;
  if (slot == kNone) {
    fail_without_slot(Refusal::kBadReferenceSlot, cls, offset);
    return std::nullopt;
  }
  if (!is_written(slot)) {
    fail_at(Refusal::kReadBeforeWrite, "the slot", offset, " holds no value yet");
    return std::nullopt;
  }
  return Pointer{slots_[slot].region, states_[slot].read_only, states_[slot].outgoing};
}

bool CodeVerifier::write_pointer(uint32_t offset, Class cls, const Pointer& pointer) {
  if (offset >= pou_.frame_size) return put_pointer(offset - pou_.frame_size, cls, pointer);
  const uint32_t slot = scalar_slot(offset, cls);
  if (slot == kNone) {
    return fail_without_slot(Refusal::kBadReferenceSlot, cls, offset);
  }
  if (cls == Class::kA && !context_.regions.same(pointer.region, slots_[slot].region)) {
    return fail(Refusal::kBadTyping, "the slot" + at_text(offset) + " is for addresses of " +
                                         image_.types.text(slots_[slot].region.type) + ", not of " +
                                         image_.types.text(pointer.region.type));
  }
  if (!outlives_traps(slot, pointer)) return false;
  mark_written(slot, pointer.read_only, pointer.outgoing);
  return true;
}

// The address of `place`, where a region of type `wanted` must be.
std::optional<Pointer> CodeVerifier::point_to(Place place, Region wanted) {
  const auto bad = [&]() -> std::optional<Pointer> {
    fail(Refusal::kBadReference,
         "there is no " + image_.types.text(wanted.type) + at_text(place.offset));
    return std::nullopt;
  };
  if (place.base == Base::kConst) {
    if (!pool_region(wanted, place.offset, 0)) return std::nullopt;
    return Pointer{wanted, true, 0};
  }
  if (place.base != Base::kFrame) {
    const std::optional<Region> root = root_region(place);
    if (!root) return std::nullopt;
    const auto flags = context_.regions.find(*root, place.offset, wanted);
    if (!flags) return bad();
    return Pointer{wanted, flags->constant || flags->input, 0};
  }
  if (place.offset >= pou_.frame_size) {
    if (context_.facts[wanted.type.index].has_slots || image_.types.is_instance(wanted.type)) {
      return bad();
    }
    ways_.push_back({place.offset - pou_.frame_size, true, Class::kB, wanted, kNone, false,
                     context_.regions.size(wanted)});
    return Pointer{wanted, false, static_cast<uint32_t>(ways_.size())};
  }
  const uint32_t slot = slot_at(place.offset);
  if (slot == kNone) return bad();
  const FrameSlot& s = slots_[slot];
  if (s.aggregate) {
    if (!context_.regions.find(s.region, place.offset - s.offset, wanted)) return bad();
    return Pointer{wanted, false, 0};
  }
  const bool same = place.offset == s.offset && image_.types.is_scalar(wanted.type) &&
                    class_of(image_.types.scalar(wanted.type)) == s.cls;
  if (!same) return bad();
  if (!is_written(slot)) {
    fail_at(Refusal::kReadBeforeWrite, "the slot", place.offset, " holds no value yet");
    return std::nullopt;
  }
  return Pointer{wanted, false, 0};
}

// A string of at least that capacity that begins at `offset`.
std::optional<Leaf> CodeVerifier::string_at(Region region, uint32_t offset, Class cls,
                                            uint32_t capacity) const {
  const Kind kind = cls == Class::kS ? Kind::kString : Kind::kWstring;
  return context_.regions.leaf_at(region, offset, [&](const Leaf& leaf) {
    return leaf.kind == LeafKind::kStringByte && leaf.begin == offset &&
           image_.types[leaf.type].kind == kind && image_.types[leaf.type].capacity >= capacity;
  });
}

std::optional<Pointer> CodeVerifier::point_to_string(Place place, Class cls, uint32_t capacity) {
  const auto check_leaf = [&](Region region, uint32_t offset) -> std::optional<Pointer> {
    const std::optional<Leaf> leaf = string_at(region, offset, cls, capacity);
    if (leaf) return Pointer{{}, leaf->constant || leaf->input, 0};
    fail(Refusal::kBadReference,
         "no string of capacity " + std::to_string(capacity) + at_text(place.offset));
    return std::nullopt;
  };
  if (place.base == Base::kConst) {
    if (!pool_string(place.offset, cls, capacity)) return std::nullopt;
    return Pointer{{}, true, 0};
  }
  if (place.base != Base::kFrame) {
    const std::optional<Region> root = root_region(place);
    if (!root) return std::nullopt;
    return check_leaf(*root, place.offset);
  }
  if (place.offset >= pou_.frame_size) {
    if (capacity > base::kMaxStringCapacity) {
      fail(Refusal::kBadReference, "a string of capacity " + std::to_string(capacity));
      return std::nullopt;
    }
    const uint32_t unit = cls == Class::kS ? 1 : 2;
    ways_.push_back(
        {place.offset - pou_.frame_size, true, cls, {}, capacity, false, (capacity + 1) * unit});
    return Pointer{{}, false, static_cast<uint32_t>(ways_.size())};
  }
  const uint32_t slot = slot_at(place.offset);
  if (slot != kNone && slots_[slot].aggregate) {
    return check_leaf(slots_[slot].region, place.offset - slots_[slot].offset);
  }
  fail_at(Refusal::kBadReference, "no string", place.offset);
  return std::nullopt;
}

// A value of the region's type in the constant pool: inside it, BOOLs 0 or 1, strings
// ended, nothing that is an ID or an address.
bool CodeVerifier::pool_region(Region region, uint32_t offset, uint32_t depth) {
  if (uint64_t{offset} + context_.regions.size(region) > image_.pool.size()) {
    return fail(Refusal::kBadReference, "no constant of " +
                                            std::to_string(context_.regions.size(region)) +
                                            " bytes" + at_text(offset));
  }
  uses_pool(offset, context_.regions.size(region));
  const Type& type = image_.types[region.type];
  if (type.kind == Kind::kGlobals || image_.types.is_instance(region.type) ||
      context_.facts[region.type.index].has_slots || depth > base::kMaxNesting) {
    return fail(Refusal::kBadReferenceSlot, "a constant holds an instance or a reference");
  }
  if (type.kind == Kind::kString) return pool_string(offset, Class::kS, type.capacity);
  if (type.kind == Kind::kWstring) return pool_string(offset, Class::kW, type.capacity);
  if (context_.image.types.overlaps(region.type)) return true;
  if (type.kind == Kind::kStruct) {
    const std::vector<uint32_t>& offsets = image_.layouts[region.type].member_offsets;
    for (size_t i = 0; i < type.members.size(); ++i) {
      if (!pool_region({type.members[i].type, 0}, offset + offsets[i], depth + 1)) return false;
    }
    return true;
  }
  if (type.kind == Kind::kArray) {
    const bool plain =
        image_.types.is_scalar(type.base) && image_.types.scalar(type.base) != Scalar::kBool;
    const uint32_t stride = image_.layouts[type.base].size;
    const uint32_t size = context_.regions.size(region);
    for (uint32_t at = 0; !plain && stride != 0 && at < size; at += stride) {
      if (!pool_region({type.base, 0}, offset + at, depth + 1)) return false;
    }
    return true;
  }
  return pool_scalar(offset, class_of(image_.types.scalar(region.type)));
}

bool CodeVerifier::pool_string(uint32_t offset, Class cls, uint32_t capacity) {
  const uint32_t unit = cls == Class::kS ? 1 : 2;
  if (capacity > base::kMaxStringCapacity ||
      uint64_t{offset} + (uint64_t{capacity} + 1) * unit > image_.pool.size()) {
    return fail(Refusal::kBadReference,
                "no constant string of capacity " + std::to_string(capacity) + at_text(offset));
  }
  uses_pool(offset, (uint64_t{capacity} + 1) * unit);
  for (uint32_t i = 0; i <= capacity; ++i) {
    const uint8_t* at = &image_.pool[offset + i * unit];
    if (at[0] == 0 && at[unit - 1] == 0) return true;
  }
  return fail(Refusal::kBadTyping, "the constant string" + at_text(offset) + " has no end");
}

}  // namespace ir::verification
