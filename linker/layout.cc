#include "linker/layout.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>

#include "base/limits.h"
#include "ir/types/member_finder.h"
#include "linker/extents.h"

namespace linker {
namespace {

using ir::Kind;
using ir::Layouts;
using ir::Member;
using ir::Section;
using ir::Type;
using ir::TypeId;
using ir::TypeLayout;

constexpr uint32_t kSlotBytes = 4;        // an instance ID or an address
constexpr uint32_t kMaxEmbedding = 1000;  // structures inside structures
// Larger members of an area go after the small ones, which 16-bit offsets reach.
constexpr uint64_t kLargeMember = 256;

uint64_t align_up(uint64_t value, uint64_t align) { return (value + align - 1) / align * align; }

bool has_area(Kind kind) {
  return kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kGlobals;
}

struct Extent64 {
  uint64_t begin = 0;
  uint64_t size = 0;
};

class Builder {
 public:
  Builder(const ir::TypeTable& types, const Slack& slack, const ir::Image* base)
      : types_(types), slack_(slack), base_(base) {
    layouts_.of.resize(types.size());
    done_.resize(types.size(), false);
    laid_out_.resize(types.size(), false);
    overlaid_.resize(types.size(), false);
    for (uint32_t i = 0; i < types.size(); ++i) {
      if (types_.overlaps(TypeId(i))) mark_overlaid(TypeId(i));
    }
    if (base_ != nullptr) index_base();
  }

  base::Result<Layouts> run() {
    for (uint32_t i = 0; i < types_.size() && !error_; ++i) value_layout(TypeId(i), 0);
    for (uint32_t i = 0; i < types_.size() && !error_; ++i) {
      if (has_area(types_[TypeId(i)].kind)) area_layout(TypeId(i), 0);
    }
    if (error_) return *error_;
    return std::move(layouts_);
  }

 private:
  std::string key_of(const ir::TypeTable& types, TypeId id) const {
    const Kind kind = types[id].kind;
    const std::string name = kind == Kind::kGlobals ? "" : ir::fold_name(types.text(id));
    return std::to_string(static_cast<uint32_t>(kind)) + ":" + name;
  }

  void index_base() {
    for (uint32_t i = 0; i < base_->types.size(); ++i) {
      if (!base_->types.has_members(TypeId(i))) continue;
      old_types_.emplace(key_of(base_->types, TypeId(i)), TypeId(i));
    }
  }

  // What other members of a union look at: its bytes are part of what the source says, so it is
  // laid out as in a first version.
  void mark_overlaid(TypeId id) {
    if (overlaid_[id.index]) return;
    overlaid_[id.index] = true;
    if (types_[id].kind == Kind::kArray) return mark_overlaid(types_[id].base);
    if (!ir::is_structure(types_[id].kind)) return;
    for (const Member& member : types_[id].members) mark_overlaid(member.type);
  }

  // The running version's type of the same name and kind; invalid: none.
  TypeId old_of(TypeId id) const {
    if (base_ == nullptr || overlaid_[id.index]) return {};
    const auto found = old_types_.find(key_of(types_, id));
    return found == old_types_.end() ? TypeId() : found->second;
  }

  void too_large(TypeId id, uint64_t size, uint64_t limit) {
    error_ = base::Error{base::Refusal::kTooLarge,
                         "`" + types_.shown(id) + "` needs " + std::to_string(size) +
                             " bytes; the limit is " + std::to_string(limit) + "."};
  }

  void value_layout(TypeId id, uint32_t depth) {
    if (done_[id.index] || error_) return;
    if (depth > kMaxEmbedding) {
      error_ =
          base::Error{base::Refusal::kTooMany, "`" + types_.shown(id) + "` is embedded more than " +
                                                   std::to_string(kMaxEmbedding) + " levels deep."};
      return;
    }
    done_[id.index] = true;
    const Type& type = types_[id];
    TypeLayout& layout = layouts_.of[id.index];
    if (has_area(type.kind)) {
      layout.size = layout.align = kSlotBytes;
    } else if (type.kind == Kind::kString) {
      layout.size = type.capacity + 1;
    } else if (type.kind == Kind::kWstring) {
      layout.size = 2 * (type.capacity + 1);
      layout.align = 2;
    } else if (type.kind == Kind::kArray) {
      array_layout(id, depth);
    } else if (ir::is_structure(type.kind)) {
      struct_layout(id, depth);
    } else if (type.kind != Kind::kInterface) {  // nothing is of an interface type
      layout.size = layout.align = ir::scalar_size(types_.scalar(id));
    }
  }

  void array_layout(TypeId id, uint32_t depth) {
    const Type& type = types_[id];
    value_layout(type.base, depth + 1);
    const TypeLayout& element = layouts_[type.base];
    uint64_t size = element.size;
    for (const ir::Dimension& dim : type.dims) {
      const uint64_t count = dim.count();
      if (count == 0 || count > base::kMaxTypeBytes || size > base::kMaxTypeBytes) {
        return too_large(id, std::max(size, count), base::kMaxTypeBytes);
      }
      size *= count;
    }
    if (size > base::kMaxTypeBytes) return too_large(id, size, base::kMaxTypeBytes);
    layouts_.of[id.index].size = static_cast<uint32_t>(size);
    layouts_.of[id.index].align = element.align;
  }

  void struct_layout(TypeId id, uint32_t depth) {
    for (const Member& member : types_[id].members) value_layout(member.type, depth + 1);
    if (error_) return;
    if (types_.overlaps(id)) {
      overlap_members(id);
    } else {
      place_members(id, 0);
    }
    if (error_) return;
    TypeLayout& layout = layouts_.of[id.index];
    for (const Member& member : types_[id].members) {
      layout.align = std::max(layout.align, align_of(types_[id], member));
    }
    layout.size = static_cast<uint32_t>(align_up(std::max(layout.used, 1u), layout.align));
  }

  // All at the beginning, or where the declaration says; never where they were before.
  void overlap_members(TypeId id) {
    std::vector<uint32_t>& offsets = layouts_.of[id.index].member_offsets;
    for (const Member& member : types_[id].members) {
      offsets.push_back(member.address.bit_offset / 8);
    }
    finish_members(id);
  }

  uint32_t size_of(const Member& member) const {
    return member.section == Section::kInOut ? kSlotBytes : layouts_[member.type].size;
  }
  uint32_t align_of(const Type& owner, const Member& member) const {
    const bool in_out = member.section == Section::kInOut;
    return ir::member_alignment(owner, in_out ? kSlotBytes : layouts_[member.type].align);
  }

  // The block that it extends; invalid: none.
  TypeId base_of(TypeId id) const {
    return types_[id].kind == Kind::kFunctionBlock ? types_[id].base : TypeId();
  }

  // Bases first.
  void area_layout(TypeId id, uint32_t depth) {
    if (laid_out_[id.index] || depth > base::kMaxNesting) return;
    laid_out_[id.index] = true;
    if (base_of(id).valid()) area_layout(base_of(id), depth + 1);
    if (error_) return;
    const TypeId old = old_of(id);
    const uint32_t old_capacity = old.valid() ? base_->layouts[old].area_capacity : 0;
    place_members(id, old_capacity);
    if (error_) return;
    TypeLayout& layout = layouts_.of[id.index];
    if (old.valid() && layout.used <= old_capacity) {
      layout.area_capacity = old_capacity;
      return;
    }
    const uint64_t end = std::max<uint64_t>(layout.used, inherited_capacity(id));
    const uint64_t capacity = align_up(std::max<uint64_t>(end + slack_of(id), 8), 8);
    if (capacity > base::kMaxDataBytes) return too_large(id, capacity, base::kMaxDataBytes);
    layout.area_capacity = static_cast<uint32_t>(capacity);
  }

  // What is inherited has its slack already: with a share of the whole at every level, a hundred
  // levels of EXTENDS would take more memory than there is (case 81).
  uint64_t slack_of(TypeId id) const {
    const uint64_t floor = inherited_capacity(id);
    const uint64_t used = layouts_[id].used > floor ? layouts_[id].used - floor : 0;
    const auto slack = [used](uint64_t percent, uint64_t bytes) {
      return std::max(used * percent / 100, bytes);
    };
    switch (types_[id].kind) {
      case Kind::kGlobals:
        return slack(slack_.globals_percent, slack_.globals_bytes);
      case Kind::kProgram:
        return slack(slack_.program_percent, slack_.program_bytes);
      default:
        return slack(slack_.instance_percent, slack_.instance_bytes);
    }
  }

  // Offset of the member in the running version when it can stay there (A1, A4).
  std::optional<uint32_t> kept_offset(TypeId old, ir::MemberFinder& old_members,
                                      const Member& member) const {
    const std::optional<size_t> number = old_members.find(member.name);
    if (!number) return std::nullopt;
    const Member& before = base_->types[old].members[*number];
    const bool in_out = member.section == Section::kInOut;
    if ((before.section == Section::kInOut) != in_out) return std::nullopt;
    if (!in_out && !ir::same_value_type(base_->types, base_->layouts, before.type, types_, layouts_,
                                        member.type)) {
      return std::nullopt;
    }
    return base_->layouts[old].member_offsets[*number];
  }

  // Byte ranges of all members of the running version's type.
  std::vector<Extent64> old_ranges(TypeId old) const {
    std::vector<Extent64> ranges;
    const Type& type = base_->types[old];
    for (size_t i = 0; i < type.members.size(); ++i) {
      const bool in_out = type.members[i].section == Section::kInOut;
      ranges.push_back({base_->layouts[old].member_offsets[i],
                        in_out ? kSlotBytes : base_->layouts[type.members[i].type].size});
    }
    return ranges;
  }

  uint64_t inherited_capacity(TypeId id) const {
    return base_of(id).valid() ? layouts_[base_of(id)].area_capacity : 0;
  }

  // The members of the base, where they are there; their number.
  size_t inherit(TypeId id, Extents& taken) {
    if (!base_of(id).valid()) return 0;
    const std::vector<uint32_t>& offsets = layouts_[base_of(id)].member_offsets;
    for (size_t i = 0; i < offsets.size(); ++i) {
      layouts_.of[id.index].member_offsets[i] = offsets[i];
      taken.add(offsets[i], size_of(types_[id].members[i]));
    }
    return offsets.size();
  }

  void place_members(TypeId id, uint32_t capacity) {
    const Type& type = types_[id];
    TypeId old = old_of(id);
    // Packed in another way: it is laid out as if it were new, and its members move.
    if (old.valid() && base_->types[old].capacity != type.capacity) old = {};
    std::vector<uint32_t>& offsets = layouts_.of[id.index].member_offsets;
    offsets.assign(type.members.size(), 0);
    ir::MemberFinder old_members(base_ != nullptr ? *base_->types : types_, old);
    std::vector<size_t> added;
    Extents taken;  // what lives on
    const size_t inherited = inherit(id, taken);
    const uint64_t floor = inherited_capacity(id);
    for (size_t i = inherited; i < type.members.size(); ++i) {
      const auto offset = kept_offset(old, old_members, type.members[i]);
      if (offset && *offset >= floor) {
        offsets[i] = *offset;
        taken.add(*offset, size_of(type.members[i]));
      } else {
        added.push_back(i);
      }
    }
    if (has_area(type.kind)) {
      std::stable_partition(added.begin(), added.end(),
                            [&](size_t i) { return size_of(type.members[i]) <= kLargeMember; });
    }
    if (!old.valid() && ir::is_structure(type.kind)) {
      place_in_order(id);
    } else {
      place_added(id, old, capacity, added, taken, offsets);
    }
    finish_members(id);
  }

  // A structure that nothing has a value of yet: each member after the one before it, aligned, and
  // holes stay holes, as other compilers do. Telegrams that are copied byte by byte count on that.
  void place_in_order(TypeId id) {
    uint64_t used = 0;
    for (size_t i = 0; i < types_[id].members.size(); ++i) {
      const Member& member = types_[id].members[i];
      const uint64_t at = align_up(used, align_of(types_[id], member));
      used = at + size_of(member);
      if (used > base::kMaxDataBytes) return too_large(id, used, base::kMaxDataBytes);
      layouts_.of[id.index].member_offsets[i] = static_cast<uint32_t>(at);
    }
  }

  // In order of preference: holes of the running version, the space after it, what
  // this change frees, and beyond the capacity.
  void place_added(TypeId id, TypeId old, uint32_t capacity, const std::vector<size_t>& added,
                   Extents& taken, std::vector<uint32_t>& offsets) {
    const uint64_t floor = inherited_capacity(id);
    uint64_t old_used = floor;
    Extents kept;
    if (old.valid()) {
      old_used = std::max<uint64_t>(base_->layouts[old].used, floor);
      kept = taken;
      for (const Extent64& range : old_ranges(old)) kept.add(range.begin, range.size);
    }
    Extents& before = old.valid() ? kept : taken;
    const uint64_t unlimited = uint64_t{1} << 40;
    const uint64_t end = capacity != 0 ? capacity : unlimited;
    std::map<std::pair<uint64_t, uint64_t>, uint64_t> hints;
    for (size_t i : added) {
      const Member& member = types_[id].members[i];
      const uint64_t size = size_of(member);
      const uint64_t align = align_of(types_[id], member);
      // Gaps only shrink, so a search for the same size goes on where the last one ended.
      uint64_t& hint = hints.try_emplace({size, align}, floor).first->second;
      std::optional<uint64_t> at =
          before.first_gap(std::min(hint, old_used), old_used, size, align);
      if (!at) at = before.first_gap(std::max(hint, old_used), end, size, align);
      if (!at) at = taken.first_gap(floor, end, size, align);
      if (!at) at = before.first_gap(std::max(hint, old_used), unlimited, size, align);
      if (*at >= hint) hint = *at;
      if (*at + size > base::kMaxDataBytes) return too_large(id, *at + size, base::kMaxDataBytes);
      offsets[i] = static_cast<uint32_t>(*at);
      taken.add(*at, size);
      if (old.valid()) before.add(*at, size);
    }
  }

  void finish_members(TypeId id) {
    TypeLayout& layout = layouts_.of[id.index];
    uint64_t used = 0;
    for (size_t i = 0; i < types_[id].members.size(); ++i) {
      used = std::max<uint64_t>(
          used, uint64_t{layout.member_offsets[i]} + size_of(types_[id].members[i]));
    }
    const uint64_t limit =
        has_area(types_[id].kind) ? uint64_t{base::kMaxDataBytes} : uint64_t{base::kMaxTypeBytes};
    if (used > limit && !error_) return too_large(id, used, limit);
    layout.used = static_cast<uint32_t>(used);
  }

  const ir::TypeTable& types_;
  const Slack& slack_;
  const ir::Image* base_;
  Layouts layouts_;
  std::vector<bool> done_;
  std::vector<bool> laid_out_;  // areas
  std::vector<bool> overlaid_;
  std::unordered_map<std::string, TypeId> old_types_;
  std::optional<base::Error> error_;
};

}  // namespace

base::Result<Layouts> lay_out(const ir::TypeTable& types, const Slack& slack,
                              const ir::Image* base) {
  return Builder(types, slack, base).run();
}

}  // namespace linker
