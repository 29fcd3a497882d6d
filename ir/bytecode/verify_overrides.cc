// The rows that virtual calls look for: each target runs on the row's type, and takes its
// arguments and leaves its results exactly where the prototype does.
#include <map>
#include <tuple>

#include "base/bytes.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {
namespace {

class OverridesVerifier {
 public:
  explicit OverridesVerifier(const Image& image) : image_(image), shapes_(image.pous.size(), 0) {}

  base::Status run() {
    for (size_t i = 0; i < image_.overrides.size(); ++i) {
      if (base::Status s = check_row(i); !s) return s;
    }
    return base::Ok{};
  }

 private:
  static base::Error bad(size_t number, Refusal refusal, const std::string& why) {
    return refuse(refusal, "override " + std::to_string(number) + ": " + why);
  }

  bool is_method(uint32_t pou) const {
    return pou < image_.pous.size() && image_.pous[pou].unit_count != 0 &&
           image_.pous[pou].kind == PouKind::kMethod;
  }

  base::Status check_row(size_t number) {
    const LinkedOverride& row = image_.overrides[number];
    const auto key = [](const LinkedOverride& r) { return std::tuple(r.type.index, r.prototype); };
    if (number != 0 && key(image_.overrides[number - 1]) >= key(row)) {
      return bad(number, Refusal::kBadFormat, "it is out of order");
    }
    const bool block =
        image_.types.contains(row.type) && image_.types[row.type].kind == Kind::kFunctionBlock;
    if (!block) return bad(number, Refusal::kBadReference, "there is no such function block");
    if (!is_method(row.prototype) || !is_method(row.target)) {
      return bad(number, Refusal::kBadCall, "there is no such method");
    }
    const LinkedPou& prototype = image_.pous[row.prototype];
    const LinkedPou& target = image_.pous[row.target];
    const bool runs = image_.types[target.self].kind == Kind::kFunctionBlock &&
                      image_.types.is_a(row.type, target.self) &&
                      image_.types.is_a(row.type, prototype.self);
    const std::string names = "`" + target.name + "` for `" + prototype.name + "`";
    if (!runs) {
      return bad(number, Refusal::kBadCall,
                 names + " cannot run on a `" + image_.types[row.type].name + "`");
    }
    if (shape_of(row.target) != shape_of(row.prototype)) {
      return bad(number, Refusal::kBadCall, names + ": their parameters differ");
    }
    return base::Ok{};
  }

  // Equal numbers: slot for slot the same parameters and results. Not 0.
  uint32_t shape_of(uint32_t pou) {
    if (shapes_[pou] != 0) return shapes_[pou];
    base::ByteWriter shape;
    for (const FrameSlot& slot : image_.pous[pou].slots) {
      if (slot.kind != SlotKind::kParam) continue;
      const bool typed = slot.aggregate || slot.cls == Class::kA;
      shape.u32(slot.offset);
      shape.u8(static_cast<uint8_t>(slot.local));
      shape.boolean(slot.aggregate);
      shape.u8(static_cast<uint8_t>(slot.cls));
      shape.u32(typed ? slot.region.type.index : 0);
      shape.u8(typed ? slot.region.dim : 0);
    }
    const base::Bytes bytes = shape.take();
    const auto [known, added] = known_.try_emplace(bytes, static_cast<uint32_t>(known_.size() + 1));
    return shapes_[pou] = known->second;
  }

  const Image& image_;
  std::vector<uint32_t> shapes_;  // by POU number; 0: not known yet
  std::map<base::Bytes, uint32_t> known_;
};

}  // namespace

base::Status verify_overrides(const Image& image) { return OverridesVerifier(image).run(); }

}  // namespace ir::verification
