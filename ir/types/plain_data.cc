#include "ir/types/plain_data.h"

#include "base/bytes.h"

namespace ir {
namespace {

constexpr uint32_t kMaxPlainDepth = 200;

// `visited` counts the parts, so that types which hold others many times end too.
bool plain(const TypeTable& types, TypeId id, uint32_t depth, uint32_t& visited) {
  if (!types.contains(id) || depth > kMaxPlainDepth || ++visited > kMaxPlainParts) return false;
  const Type& type = types[id];
  switch (type.kind) {
    case Kind::kArray:
    case Kind::kSubrange:
    case Kind::kEnum:
      return plain(types, type.base, depth + 1, visited);
    case Kind::kStruct:
    case Kind::kUnion:
      for (const Member& member : type.members) {
        if (member.address.area != DirectArea::kNone) return false;
        if (!plain(types, member.type, depth + 1, visited)) return false;
      }
      return true;
    case Kind::kString:
    case Kind::kWstring:
      return true;
    default:
      return is_elementary(type.kind);
  }
}

class Description {
 public:
  Description(const TypeTable& types, const Layouts& layouts) : types_(types), layouts_(layouts) {}

  void add(TypeId id, bool with_layout) {
    const Type& type = types_[id];
    const bool overlap = types_.overlaps(id);
    out_.u8(static_cast<uint8_t>(type.kind));
    out_.text(fold_name(type.name));
    out_.u32(type.capacity);
    if (type.kind == Kind::kSubrange) {
      out_.i64(type.low);
      out_.u64(static_cast<uint64_t>(type.high));
    }
    for (const Dimension& dim : type.dims) {
      out_.i64(dim.low);
      out_.i64(dim.high);
    }
    for (const EnumLiteral& literal : type.literals) {
      out_.text(fold_name(literal.name));
      out_.i64(literal.value);
    }
    const bool fixed = with_layout || overlap;
    if (fixed) out_.u32(layouts_[id].size);
    if (type.base.valid()) add(type.base, fixed);
    if (!is_structure(type.kind)) return;
    out_.u32(static_cast<uint32_t>(type.members.size()));
    for (size_t i = 0; i < type.members.size(); ++i) {
      out_.text(fold_name(type.members[i].name));
      if (fixed) out_.u32(layouts_[id].member_offsets[i]);
      add(type.members[i].type, fixed);
    }
  }

  base::Digest digest() { return base::sha256(out_.bytes()); }

 private:
  const TypeTable& types_;
  const Layouts& layouts_;
  base::ByteWriter out_;
};

class Runs {
 public:
  Runs(const TypeTable& types, const Layouts& layouts) : types_(types), layouts_(layouts) {}

  // False: it has too many parts.
  bool add(TypeId id, uint32_t offset) {
    if (++visited_ > kMaxPlainParts) return false;
    const Type& type = types_[id];
    if (type.kind == Kind::kStruct && !types_.overlaps(id)) {
      for (size_t i = 0; i < type.members.size(); ++i) {
        const uint32_t at = offset + layouts_[id].member_offsets[i];
        if (!add(type.members[i].type, at)) return false;
      }
      return true;
    }
    const bool parts = type.kind == Kind::kArray && !types_.is_scalar(type.base);
    if (!parts) {
      join(offset, layouts_[id].size, is_bool(type.kind == Kind::kArray ? type.base : id));
      return true;
    }
    const uint32_t stride = layouts_[type.base].size;
    if (stride == 0) return true;
    for (uint32_t at = 0; at + stride <= layouts_[id].size; at += stride) {
      if (!add(type.base, offset + at)) return false;
    }
    return true;
  }

  std::vector<PlainRun> take() { return std::move(runs_); }

 private:
  bool is_bool(TypeId id) const {
    return types_.is_scalar(id) && types_.scalar(id) == Scalar::kBool;
  }
  void join(uint32_t offset, uint32_t size, bool bools) {
    if (!runs_.empty() && runs_.back().offset + runs_.back().size == offset &&
        runs_.back().bools == bools) {
      runs_.back().size += size;
    } else {
      runs_.push_back({offset, size, bools});
    }
  }

  const TypeTable& types_;
  const Layouts& layouts_;
  std::vector<PlainRun> runs_;
  uint32_t visited_ = 0;
};

}  // namespace

bool is_plain_data(const TypeTable& types, TypeId id) {
  uint32_t visited = 0;
  return plain(types, id, 0, visited);
}

std::optional<base::Digest> plain_signature(const TypeTable& types, const Layouts& layouts,
                                            TypeId id) {
  if (!is_plain_data(types, id) || !Runs(types, layouts).add(id, 0)) return std::nullopt;
  Description description(types, layouts);
  description.add(id, false);
  return description.digest();
}

std::vector<PlainRun> plain_runs(const TypeTable& types, const Layouts& layouts, TypeId id) {
  Runs runs(types, layouts);
  if (!is_plain_data(types, id) || !runs.add(id, 0)) return {};
  return runs.take();
}

}  // namespace ir
