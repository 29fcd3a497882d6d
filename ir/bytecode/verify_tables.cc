#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/proof.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

class TablesVerifier {
 public:
  TablesVerifier(Context& context, const Likeness& likeness)
      : context_(context), image_(context.image), likeness_(likeness) {}

  base::Status run() {
    if (base::Status s = check_limits(); !s) return s;
    if (base::Status s = check_code_ranges(); !s) return s;
    context_.pou_of_type.assign(image_.types.size(), kNone);
    for (uint32_t i = 0; i < image_.pous.size(); ++i) {
      if (base::Status s = check_pou(i); !s) return s;
    }
    if (!likeness_.bounds()) {
      for (uint32_t i = 0; i < image_.bounds.size(); ++i) {
        if (base::Status s = check_bound(i); !s) return s;
      }
    }
    if (likeness_.ranges()) return base::Ok{};
    for (const Range& range : image_.ranges) {
      if (range.low > range.high) {
        return refuse(Refusal::kBadReference, "range `" + range.name + "` is empty");
      }
    }
    return base::Ok{};
  }

 private:
  base::Status limit(const char* what, uint64_t have, uint64_t most) const {
    if (have <= most) return base::Ok{};
    return refuse(Refusal::kTooLarge, std::string(what) + ": " + std::to_string(have) +
                                          ", at most " + std::to_string(most));
  }

  base::Status check_limits() const {
    const std::pair<const char*, std::pair<uint64_t, uint64_t>> limits[] = {
        {"bytes of data memory", {image_.data_capacity, base::kMaxDataBytes}},
        {"bytes of constants", {image_.pool.size(), kConstPoolLimit}},
        {"bytes of stack", {image_.stack_bytes, kStackLimit}},
        {"depth of calls", {image_.call_depth, base::kMaxCallDepth}},
        {"POUs", {image_.pous.size(), base::kMaxPous}},
        {"instances", {image_.instances.size(), base::kMaxInstances}},
        {"instructions", {image_.code.size(), base::kMaxCodeUnits}},
        {"tasks", {image_.tasks.size(), base::kMaxTasks}},
        {"bytes of %I", {image_.input_bytes, base::kMaxDeviceBytes}},
        {"bytes of %Q", {image_.output_bytes, base::kMaxDeviceBytes}},
    };
    for (const auto& [what, values] : limits) {
      if (base::Status s = limit(what, values.first, values.second); !s) return s;
    }
    return base::Ok{};
  }

  // Every unit belongs to exactly one POU: what no POU owns could not be reached (V6).
  base::Status check_code_ranges() const {
    std::vector<std::pair<uint64_t, uint64_t>> ranges;
    for (const LinkedPou& pou : image_.pous) {
      if (pou.unit_count != 0) {
        ranges.emplace_back(pou.first_unit, uint64_t{pou.first_unit} + pou.unit_count);
      } else if (pou.first_unit > image_.code.size()) {
        return refuse(Refusal::kUnreachable, "POU `" + pou.name + "` begins after all code");
      }
    }
    std::sort(ranges.begin(), ranges.end());
    uint64_t end = 0;
    for (const auto& [first, behind] : ranges) {
      if (first != end) {
        return refuse(Refusal::kUnreachable, "code units " + std::to_string(std::min(first, end)) +
                                                 " and on belong to no POU, or to two");
      }
      end = behind;
    }
    if (end != image_.code.size()) {
      return refuse(Refusal::kUnreachable, "POUs own " + std::to_string(end) + " code units of " +
                                               std::to_string(image_.code.size()));
    }
    return base::Ok{};
  }

  base::Error bad_frame(const LinkedPou& pou, const std::string& why) const {
    return refuse(Refusal::kBadFrame, "POU `" + pou.name + "`: " + why);
  }

  base::Status check_pou(uint32_t number) {
    const LinkedPou& pou = image_.pous[number];
    if (pou.frame_size % 8 != 0 || pou.frame_size > base::kMaxFrameBytes) {
      return bad_frame(pou, "frame of " + std::to_string(pou.frame_size) + " bytes");
    }
    if (pou.recursion_depth > base::kMaxCallDepth) {
      return bad_frame(pou, "recursion depth " + std::to_string(pou.recursion_depth));
    }
    if (base::Status s = check_self(pou, number); !s) return s;
    return likeness_.slots(number) ? base::Status(base::Ok{}) : check_slots(pou);
  }

  base::Status check_self(const LinkedPou& pou, uint32_t number) {
    if (!right_self(pou)) {
      return refuse(Refusal::kBadReference, "POU `" + pou.name + "`: wrong instance type");
    }
    if (!is_body(pou.kind) || pou.unit_count == 0) return base::Ok{};
    uint32_t& owner = context_.pou_of_type[pou.self.index];
    if (owner != kNone) {
      return refuse(Refusal::kBadReference, "POUs `" + image_.pous[owner].name + "` and `" +
                                                pou.name + "` have the same instance type");
    }
    owner = number;
    return base::Ok{};
  }

  bool right_self(const LinkedPou& pou) const {
    if (pou.kind == PouKind::kFunction) return !pou.self.valid();
    if (!image_.types.contains(pou.self)) return false;
    const Kind kind = image_.types[pou.self].kind;
    switch (pou.kind) {
      case PouKind::kFunctionBlock:
        return kind == Kind::kFunctionBlock;
      case PouKind::kProgram:
        return kind == Kind::kProgram;
      default:
        return image_.types.is_instance(pou.self) || kind == Kind::kInterface;
    }
  }

  base::Status check_slots(const LinkedPou& pou) const {
    uint64_t end = 0;
    for (const FrameSlot& slot : pou.slots) {
      // Nobody passes arguments to a body, so nothing may count on them.
      if (slot.kind == SlotKind::kParam && !has_parameters(pou.kind)) {
        return bad_frame(pou, "parameters of what has none");
      }
      if (slot.kind > SlotKind::kTemp) return bad_frame(pou, "slot of a kind that frames lack");
      if (base::Status s = check_slot(pou, slot); !s) return s;
      if (slot.offset < end) {
        return bad_frame(pou, "slots overlap at offset " + std::to_string(slot.offset));
      }
      end = uint64_t{slot.offset} + slot_size(slot);
      if (end > pou.frame_size) {
        return bad_frame(pou, "slot at " + std::to_string(slot.offset) + " ends at " +
                                  std::to_string(end) + ", the frame at " +
                                  std::to_string(pou.frame_size));
      }
    }
    return base::Ok{};
  }

  uint64_t slot_size(const FrameSlot& slot) const {
    return slot.aggregate ? context_.regions.size(slot.region) : class_size(slot.cls);
  }

  base::Status check_slot(const LinkedPou& pou, const FrameSlot& slot) const {
    const TypeTable& types = image_.types;
    const auto bad = [&](const char* why) {
      return bad_frame(pou, "slot at " + std::to_string(slot.offset) + ": " + why);
    };
    if (slot.aggregate || slot.cls == Class::kA) {
      if (!context_.valid(slot.region)) return bad("no such type");
    }
    if (slot.aggregate) {
      const bool area = types.is_instance(slot.region.type) ||
                        types[slot.region.type].kind == Kind::kGlobals ||
                        context_.facts[slot.region.type.index].has_slots;
      if (area) return bad("instances cannot live in a frame");
      if (slot.region.dim == 0 && types.is_scalar(slot.region.type)) {
        return bad("a scalar is no aggregate");
      }
    } else if (slot.cls != Class::kA && !right_scalar(slot)) {
      return bad("its type is none of its class");
    }
    return base::Ok{};
  }

  // A parameter's type is part of what callers see; of others debuggers know it, or nobody.
  bool right_scalar(const FrameSlot& slot) const {
    const TypeId type = slot.region.type;
    if (!type.valid()) return slot.kind != SlotKind::kParam;
    return slot.region.dim == 0 && image_.types.is_scalar(type) &&
           class_of(image_.types.scalar(type)) == slot.cls;  // so none of a string's place
  }

  base::Status check_bound(uint32_t number) const {
    const LinkedBound& bound = image_.bounds[number];
    const auto bad = [&](const std::string& why) {
      return refuse(Refusal::kBadReference,
                    "bounds " + std::to_string(number) + " of `" + bound.name + "`: " + why);
    };
    if (!context_.valid(bound.from) || image_.types[bound.from.type].kind != Kind::kArray) {
      return bad("not of an array");
    }
    const Type& type = image_.types[bound.from.type];
    if (bound.from.dim >= type.dims.size()) return bad("no such dimension");
    const Dimension& dim = type.dims[bound.from.dim];
    const uint64_t stride = index_stride(image_.types, image_.layouts, bound.from);
    if (bound.low != dim.low || bound.count != dim.count() || bound.stride != stride) {
      return bad("they differ from those of the array");
    }
    return base::Ok{};
  }

  Context& context_;
  const Image& image_;
  const Likeness& likeness_;
};

}  // namespace

base::Status verify_tables(Context& context, const Likeness& likeness) {
  return TablesVerifier(context, likeness).run();
}

base::Status verify_contents(const Image& image) {
  const size_t count = image.pous.size();
  const bool complete = image.contents.size() == count;
  if (!complete && !(image.contents.empty() && image.held.empty())) {
    return base::Error{base::Refusal::kBadFormat, "identities of " +
                                                      std::to_string(image.contents.size()) +
                                                      " POUs of " + std::to_string(count)};
  }
  const HeldPart* before = nullptr;
  for (const HeldPart& row : image.held) {
    const bool in_order = before == nullptr || *before < row;
    if (!in_order || row.pou >= count) {
      return base::Error{base::Refusal::kBadFormat,
                         "POU " + std::to_string(row.pou) + " of " + std::to_string(count) +
                             " holds `" + row.what.name +
                             "`: there is no such POU, or the rows are not in order"};
    }
    before = &row;
  }
  for (size_t i = 1; i < image.unit_members.size(); ++i) {
    const std::string& name = image.unit_members[i].name;
    if (fold_name(image.unit_members[i - 1].name) < fold_name(name)) continue;
    return base::Error{base::Refusal::kBadFormat, "unit of `" + name + "`: not in order"};
  }
  return base::Ok{};
}

}  // namespace ir::verification
