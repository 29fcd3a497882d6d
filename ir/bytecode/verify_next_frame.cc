// Arguments and results (V12). Between two calls the next frame is a list of what was
// put there; at the call everything on the list must fit the callee's parameters, and
// all of its inputs must be on the list. From then on its results can be read.
#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/call_needs.h"
#include "ir/bytecode/verify_code.h"
#include "stdlib/native/natives.h"

namespace ir::verification {
namespace {

constexpr uint32_t kNativeSlotBytes = 8;
constexpr size_t kLookBack = 8;  // an argument is changed right after it was put

bool is_result_kind(LocalKind kind) {
  return kind == LocalKind::kOutput || kind == LocalKind::kReturn;
}

}  // namespace

bool CodeVerifier::put(Outgoing out) {
  const uint64_t end = uint64_t{out.offset} + out.size;
  if (end > uint64_t{base::kMaxFrameBytes}) {
    return fail(Refusal::kBadFrame,
                "writes at " + std::to_string(out.offset) + " of the next frame");
  }
  pending_begin_ = std::min<uint64_t>(pending_begin_, out.offset);
  pending_end_ = std::max(pending_end_, end);
  pending_.push_back(out);
  return true;
}

bool CodeVerifier::overlaps_pending(uint64_t begin, uint64_t end) const {
  if (end <= pending_begin_ || begin >= pending_end_) return false;
  return std::any_of(pending_.begin(), pending_.end(), [&](const Outgoing& out) {
    return begin < uint64_t{out.offset} + out.size && out.offset < end;
  });
}

bool CodeVerifier::next_scalar(uint32_t offset, Class cls, bool write) {
  const Outgoing out{offset, false, cls, {}, kNone, false, class_size(cls)};
  if (write) return put(out);
  if (is_result(out)) return true;
  const size_t first = pending_.size() - std::min(pending_.size(), kLookBack);
  for (size_t i = first; i < pending_.size(); ++i) {
    const Outgoing& put_before = pending_[i];
    if (!put_before.aggregate && put_before.offset == offset && put_before.cls == cls) return true;
  }
  return fail(Refusal::kReadBeforeWrite,
              "there is no result at " + std::to_string(offset) + " of the next frame");
}

bool CodeVerifier::put_pointer(uint32_t offset, Class cls, const Pointer& pointer) {
  if (pointer.outgoing != 0) {
    return fail(Refusal::kBadCall, "an argument refers to another argument");
  }
  return put({offset, false, cls, pointer.region, kNone, pointer.read_only, class_size(cls)});
}

const FrameSlot* CodeVerifier::callee_slot(const LinkedPou& callee, uint32_t offset) const {
  const auto behind =
      std::upper_bound(callee.slots.begin(), callee.slots.end(), offset,
                       [](uint32_t at, const FrameSlot& slot) { return at < slot.offset; });
  if (behind == callee.slots.begin() || (behind - 1)->kind != SlotKind::kParam) return nullptr;
  return &*(behind - 1);
}

bool CodeVerifier::fits(const Outgoing& out, const FrameSlot& slot) const {
  const uint32_t offset = out.offset - slot.offset;
  if (!slot.aggregate) {
    if (out.aggregate || offset != 0 || out.cls != slot.cls) return false;
    if (out.cls != Class::kA) return true;
    return !out.read_only && context_.regions.same(out.region, slot.region);
  }
  if (out.aggregate && out.capacity == kNone) {
    return context_.regions.find(slot.region, offset, out.region).has_value();
  }
  if (out.aggregate) return string_at(slot.region, offset, out.cls, out.capacity).has_value();
  const auto same_class = [&](const Leaf& leaf) {
    return leaf.begin == offset && leaf.kind == LeafKind::kScalar &&
           class_of(image_.types.scalar(leaf.type)) == out.cls;
  };
  return context_.regions.leaf_at(slot.region, offset, same_class).has_value();
}

bool CodeVerifier::is_result(const Outgoing& wanted) const {
  if (results_.of == ResultsOf::kNobody ||
      overlaps_pending(wanted.offset, uint64_t{wanted.offset} + wanted.size)) {
    return false;
  }
  if (results_.of == ResultsOf::kNative) {
    const char letter = stdlib::native_row(results_.number).result;
    return !wanted.aggregate && wanted.offset == 0 && letter != 'v' &&
           class_of(stdlib::native_scalar(letter)) == wanted.cls;
  }
  const FrameSlot* slot = callee_slot(image_.pous[results_.number], wanted.offset);
  return slot != nullptr && is_result_kind(slot->local) && fits(wanted, *slot);
}

bool CodeVerifier::end_of_arguments(const char* where) {
  if (pending_.empty()) return true;
  return fail(Refusal::kBadCall, "arguments are put into the next frame, but " +
                                     std::string(where) + " comes before their call");
}

bool CodeVerifier::check_frame() {
  if (u_.a == pou_.frame_size / 8) return true;
  return fail(Refusal::kBadFrame, "the callee's frame would begin at " + std::to_string(u_.a * 8u) +
                                      ", this one ends at " + std::to_string(pou_.frame_size));
}

bool CodeVerifier::check_call() {
  if (!check_frame()) return false;
  const bool exists = u_.c < image_.pous.size() && image_.pous[u_.c].unit_count != 0 &&
                      image_.pous[u_.c].kind == PouKind::kFunction;
  if (!exists) return fail(Refusal::kBadCall, "there is no function " + std::to_string(u_.c));
  facts_.callees.push_back(u_.c);
  return pass_arguments(u_.c);
}

// What is in the next frame are exactly the arguments of that POU; then come its results.
bool CodeVerifier::pass_arguments(uint32_t pou) {
  const LinkedPou& callee = image_.pous[pou];
  facts_.parameters_of.push_back(pou);
  std::vector<bool>& given = room_.given;
  given.assign(callee.slots.size(), false);
  for (const Outgoing& out : pending_) {
    const FrameSlot* slot = callee_slot(callee, out.offset);
    if (slot == nullptr || !fits(out, *slot)) {
      return fail(Refusal::kBadCall, "what lies at " + std::to_string(out.offset) +
                                         " of the next frame is no argument of `" + callee.name +
                                         "`");
    }
    given[static_cast<size_t>(slot - callee.slots.data())] = true;
  }
  for (size_t i = 0; i < callee.slots.size(); ++i) {
    const FrameSlot& slot = callee.slots[i];
    const bool needed = slot.kind == SlotKind::kParam && !slot.aggregate &&
                        (slot.local == LocalKind::kInput || slot.local == LocalKind::kInOut);
    if (needed && !given[i]) {
      return fail(Refusal::kBadCall,
                  "argument `" + slot.name + "` of `" + callee.name + "` is missing");
    }
  }
  pending_.clear();
  pending_begin_ = ~uint64_t{0};
  pending_end_ = 0;
  results_ = {ResultsOf::kFunction, pou};
  return true;
}

bool CodeVerifier::check_native() {
  if (u_.a != pou_.frame_size / 8) {
    return fail(Refusal::kBadFrame, "the arguments would begin at " + std::to_string(u_.a * 8u));
  }
  if (u_.c >= stdlib::native_count()) {
    return fail(Refusal::kBadCall, "there is no native function " + std::to_string(u_.c));
  }
  const stdlib::NativeRow& row = stdlib::native_row(u_.c);
  const auto count = static_cast<uint32_t>(row.arguments.size());
  uint64_t given = 0;
  for (const Outgoing& out : pending_) {
    const uint32_t number = out.offset / kNativeSlotBytes;
    const bool good = !out.aggregate && out.offset % kNativeSlotBytes == 0 && number < count &&
                      class_of(stdlib::native_scalar(row.arguments[number])) == out.cls;
    if (!good) {
      return fail(Refusal::kBadCall, "what lies at " + std::to_string(out.offset) +
                                         " of the next frame is no argument of " +
                                         std::string(row.name));
    }
    // A string result is written through the first argument.
    const bool string = out.cls == Class::kS || out.cls == Class::kW;
    if (number == 0 && row.result == 'v' && string && out.read_only) {
      return fail(Refusal::kBadReference, "an input or a constant is written");
    }
    given |= uint64_t{1} << number;
  }
  if (given != (uint64_t{1} << count) - 1) {
    return fail(Refusal::kBadCall, "an argument of " + std::string(row.name) + " is missing");
  }
  facts_.native_bytes = std::max(facts_.native_bytes, std::max(count, 1u) * kNativeSlotBytes);
  pending_.clear();
  pending_begin_ = ~uint64_t{0};
  pending_end_ = 0;
  results_ = {ResultsOf::kNative, u_.c};
  return true;
}

bool CodeVerifier::check_instance_frame() {
  return end_of_arguments("the call of an instance") && check_frame();
}

bool CodeVerifier::add_instance_call(TypeId type) {
  const uint32_t callee = context_.pou_of_type[type.index];
  if (callee == kNone) {
    return fail(Refusal::kBadCall, "`" + image_.types.text(type) + "` has no code");
  }
  facts_.callees.push_back(callee);
  results_ = {};
  return true;
}

bool CodeVerifier::check_call_instance(bool from_place) {
  if (!check_instance_frame()) return false;
  const TypeId type = instance_slot(from_place);
  return type.valid() && add_instance_call(type);
}

bool CodeVerifier::check_call_reference() {
  const Region region = region_of_field(extension_.x());
  if (!check_instance_frame()) return false;
  if (!near_operand(opcode_row(u_.opcode()).b, u_.base_b(), u_.b, false)) return false;
  const bool instance = context_.valid(region) && region.dim == 0 &&
                        image_.types[region.type].kind == Kind::kFunctionBlock;
  if (!instance) return fail(Refusal::kBadReference, "there is no such function block");
  // The instance may be of any type that extends the named one; each has and runs its own body.
  facts_.callees.push_back(DynamicCalls(image_).any_body(region.type));
  results_ = {};
  return true;
}

}  // namespace ir::verification
