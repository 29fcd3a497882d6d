#include "online_change/package/type_fit.h"

#include <algorithm>

#include "base/limits.h"
#include "online_change/diff/areas.h"
#include "online_change/diff/type_diff.h"
#include "online_change/diff/union_bytes.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::Kind;
using ir::TypeId;

Fit both(Fit a, Fit b) {
  if (a == Fit::kNo || b == Fit::kNo) return Fit::kNo;
  return std::max(a, b);
}

}  // namespace

Fit TypeFit::value_at(uint32_t from, Node node) {
  std::optional<uint32_t> id = areas_.instance_at(from);
  if (!id) return Fit::kNo;
  std::optional<Node> at =
      areas_.child_at({old_.instances[*id].type, areas_.begin(*id), false}, from);
  for (uint32_t depth = 0; at && depth < base::kMaxTypeDepth; ++depth) {
    if (at->in_out || node.in_out) {
      bool alike = at->in_out && node.in_out && at->begin == from;
      if (alike && values(at->type, node.type) != Fit::kNo) return Fit::kYes;
      if (at->in_out) return Fit::kNo;
    } else if (at->begin == from) {
      Fit fit = values(at->type, node.type);
      if (fit != Fit::kNo) return fit;
    }
    const ir::Type& type = old_.types[at->type];
    if (type.kind == Kind::kArray && new_.types[node.type].kind == Kind::kArray && !node.in_out) {
      uint32_t stride = old_.layouts[type.base].size;
      uint32_t relative = from - at->begin;
      if (stride != 0 && relative % stride == 0) {
        Fit fit = elements(at->type, relative / stride, node.type);
        if (fit != Fit::kNo) return fit;
      }
    }
    if (type.kind != Kind::kArray && !has_own_parts(old_.types, at->type)) return Fit::kNo;
    at = areas_.child_at(*at, from);
  }
  return Fit::kNo;
}

Fit TypeFit::area_at(uint32_t from, TypeId type) {
  std::optional<uint32_t> id = areas_.instance_at(from);
  if (!id || areas_.begin(*id) != from) return Fit::kNo;
  return members(old_.instances[*id].type, type);
}

Fit TypeFit::values(TypeId old_type, TypeId new_type) {
  auto found = values_.find({old_type, new_type});
  if (found != values_.end()) return found->second;
  if (depth_ >= base::kMaxTypeDepth) return Fit::kNo;
  ++depth_;
  Fit fit = compare_values(old_type, new_type);
  --depth_;
  values_[{old_type, new_type}] = fit;
  return fit;
}

Fit TypeFit::compare_values(TypeId old_type, TypeId new_type) {
  if (old_.types.is_instance(old_type) || new_.types.is_instance(new_type)) {
    bool alike = old_.types.is_instance(old_type) && new_.types.is_instance(new_type) &&
                 same_instance_type(old_, old_type, new_, new_type);
    return alike ? Fit::kYesButSlots : Fit::kNo;
  }
  const ir::Type& from = old_.types[old_type];
  const ir::Type& to = new_.types[new_type];
  if (has_own_parts(old_.types, old_type) && has_own_parts(new_.types, new_type)) {
    return members(old_type, new_type);
  }
  if (old_.types.overlaps(old_type) || new_.types.overlaps(new_type)) {
    bool alike =
        ir::same_value_type(old_.types, old_.layouts, old_type, new_.types, new_.layouts, new_type);
    // What is after the old bytes is another step's.
    alike = alike || (keeps_union_bytes(old_, old_type, new_, new_type) &&
                      old_.layouts[old_type].size >= new_.layouts[new_type].size);
    return alike ? Fit::kYes : Fit::kNo;
  }
  if (from.kind == Kind::kArray && to.kind == Kind::kArray) {
    return elements(old_type, 0, new_type);
  }
  Conversion conversion = classify(old_.types, old_type, new_.types, new_type);
  return conversion == Conversion::kSame ? Fit::kYes : Fit::kNo;
}

Fit TypeFit::elements(TypeId old_type, uint64_t skipped, TypeId new_type) {
  const ir::Type& from = old_.types[old_type];
  const ir::Type& to = new_.types[new_type];
  uint64_t available = from.element_count();
  if (skipped > available || available - skipped < to.element_count()) return Fit::kNo;
  if (old_.layouts[from.base].size != new_.layouts[to.base].size) return Fit::kNo;
  return values(from.base, to.base);
}

Fit TypeFit::members(TypeId old_type, TypeId new_type) {
  auto [found, added] = members_.try_emplace({old_type, new_type}, Fit::kNo);
  if (!added) return found->second;
  const ir::Type& to = new_.types[new_type];
  const ir::TypeLayout& layout = new_.layouts[new_type];
  Fit fit = Fit::kYes;
  for (uint32_t i = 0; i < to.members.size() && fit != Fit::kNo; ++i) {
    bool in_out = to.members[i].section == ir::Section::kInOut;
    std::optional<Node> twin = areas_.child_at({old_type, 0, false}, layout.member_offsets[i]);
    if (!twin || twin->begin != layout.member_offsets[i] || twin->in_out != in_out) {
      fit = Fit::kNo;
      break;
    }
    Fit part = values(twin->type, to.members[i].type);
    fit = both(fit, in_out && part != Fit::kNo ? Fit::kYes : part);
  }
  members_[{old_type, new_type}] = fit;
  return fit;
}

}  // namespace online_change
