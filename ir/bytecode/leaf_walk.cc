// Walking all variables.
#include "ir/bytecode/leaf_walk.h"

#include "base/limits.h"
#include "ir/bytecode/regions.h"
#include "ir/bytecode/symbol_steps.h"
#include "ir/types/inside.h"
#include "ir/types/shared_bytes.h"

namespace ir {

bool enter(const Image& image, Symbol& symbol) {
  const uint32_t id = initial_id(image, symbol.data);
  if (id == 0 || id >= image.instances.size() || !image.instances[id].live) return false;
  if (image.instances[id].type != symbol.type) return false;
  symbol.data = image.instances[id].data;
  return true;
}

Symbol member_of(const Image& image, const Symbol& owner, size_t number) {
  const Member& member = image.types[owner.type].members[number];
  Symbol symbol = owner;
  symbol.data += image.layouts[owner.type].member_offsets[number];
  symbol.type = member.type;
  symbol.constant |= member.constant;
  symbol.retain |= member.retain;
  symbol.input |= member.address.area == DirectArea::kInput;
  symbol.output |= member.address.area == DirectArea::kOutput;
  symbol.bit_mask = bit_mask_of(image.types, owner.type, member);
  return symbol;
}

namespace {

// Visits leaves in declaration order. Depth is bounded because an image that was
// not verified may hold instances that contain themselves.
class LeafWalk {
 public:
  using Visit = std::function<bool(const std::string&, const Symbol&)>;
  // Without the first `skip` leaves; until a visit is false.
  LeafWalk(const Image& image, uint64_t skip, const Visit& visit)
      : image_(image), skip_(skip), visit_(visit) {}

  void walk(const Symbol& symbol, uint32_t depth) {
    const Type& type = image_.types[symbol.type];
    if (depth > base::kMaxNesting) return;
    if (type.kind == Kind::kArray) return elements(symbol, depth);
    if (image_.types.has_members(symbol.type)) return members(symbol, depth);
    if (skip_ != 0) {
      --skip_;
    } else {
      ended_ = !visit_(path_, symbol);
    }
  }

  bool ended() const { return ended_; }

  void root(const Symbol& symbol, std::string_view name) {
    path_ = name;
    walk(symbol, 0);
  }

 private:
  // A program among the globals comes later, as itself.
  void part(Symbol symbol, uint32_t depth) {
    if (image_.types[symbol.type].kind == Kind::kProgram) return;
    if (!image_.types.is_instance(symbol.type) || enter(image_, symbol)) walk(symbol, depth + 1);
  }

  void members(const Symbol& symbol, uint32_t depth) {
    const size_t length = path_.size();
    const Type& type = image_.types[symbol.type];
    for (size_t i = 0; i < type.members.size() && !ended_; ++i) {
      if (!is_listed(type.members[i])) continue;
      if (is_shared(image_.types, type.members[i])) {  // its members have paths of their own
        part(member_of(image_, symbol, i), depth);
        continue;
      }
      if (length != 0) path_ += '.';
      path_ += type.members[i].name;
      part(member_of(image_, symbol, i), depth);
      path_.resize(length);
    }
  }

  void elements(const Symbol& symbol, uint32_t depth) {
    const size_t length = path_.size();
    const Type& type = image_.types[symbol.type];
    const uint32_t stride = image_.layouts[type.base].size;
    std::vector<int64_t> index;
    uint64_t count = 1;
    for (const Dimension& dim : type.dims) {
      index.push_back(dim.low);
      count *= dim.count();
    }
    Symbol element = symbol;
    element.type = type.base;
    uint64_t flat = is_leaf(type.base) ? std::min(skip_, count) : 0;
    skip_ -= flat;
    element.data += static_cast<uint32_t>(flat * stride);
    set_index(type, flat, index);
    for (; flat < count && !ended_; ++flat, element.data += stride) {
      append_index(index);
      part(element, depth);
      path_.resize(length);
      advance(type, index);
    }
  }

  bool is_leaf(TypeId id) const {
    return image_.types[id].kind != Kind::kArray && !image_.types.has_members(id);
  }

  static void set_index(const Type& type, uint64_t flat, std::vector<int64_t>& index) {
    for (size_t dim = index.size(); dim-- > 0; flat /= type.dims[dim].count()) {
      index[dim] = type.dims[dim].low + static_cast<int64_t>(flat % type.dims[dim].count());
    }
  }

  void append_index(const std::vector<int64_t>& index) {
    char separator = '[';
    for (int64_t i : index) {
      path_ += separator + std::to_string(i);
      separator = ',';
    }
    path_ += ']';
  }

  static void advance(const Type& type, std::vector<int64_t>& index) {
    for (size_t dim = index.size(); dim-- > 0;) {
      if (index[dim] != type.dims[dim].high) {
        ++index[dim];
        return;
      }
      index[dim] = type.dims[dim].low;
    }
  }

  const Image& image_;
  uint64_t skip_;
  const Visit& visit_;
  bool ended_ = false;
  std::string path_;
};

}  // namespace

void for_each_leaf(const Image& image,
                   const std::function<void(const std::string& path, const Symbol&)>& visit) {
  for_each_leaf_from(image, 0, [&](const std::string& path, const Symbol& symbol) {
    visit(path, symbol);
    return true;
  });
}

void for_each_leaf_from(const Image& image, uint64_t first,
                        const std::function<bool(const std::string&, const Symbol&)>& visit) {
  LeafWalk walk(image, first, visit);
  Symbol globals;
  globals.type = image.globals;
  globals.data = image.instances.empty() ? 0 : image.instances[0].data;
  walk.root(globals, "");
  for (uint32_t id : image.program_ids()) {
    if (walk.ended()) return;
    Symbol program;
    program.type = image.instances[id].type;
    program.data = image.instances[id].data;
    walk.root(program, image.instances[id].name);
  }
}

}  // namespace ir
