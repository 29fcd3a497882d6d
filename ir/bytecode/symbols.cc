// Finding variables by path and walking all of them. The child of an instance is
// found through the ID in the slot's initial data, which never changes while the
// slot lives, so no search over the instance table is needed.
#include "ir/bytecode/symbols.h"

#include "base/limits.h"
#include "ir/bytecode/leaf_walk.h"
#include "ir/bytecode/regions.h"
#include "ir/types/inside.h"
#include "ir/types/listed_name.h"
#include "ir/types/shared_bytes.h"

namespace ir {
namespace {

base::Error no_such(std::string_view path, const std::string& why) {
  return {base::Refusal::kNoSuchVariable, "`" + std::string(path) + "`: " + why};
}

// Steps into the instance whose ID is in the slot at symbol.data; false when there is none.
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

// BIT members that share a byte are one member, with the names of all of them. What to write
// instead of the name of one of them; "" when `name` is none.
std::string byte_of_bit(const Type& owner, std::string_view name) {
  for (const Member& member : owner.members) {
    const std::string_view all = member.name;
    size_t bit = 0;
    for (size_t at = 0, end = 0; end < all.size() && all.find('-') != all.npos;
         at = end + 1, ++bit) {
      end = std::min(all.find('-', at), all.size());
      if (!same_name(all.substr(at, end - at), name)) continue;
      return "is bit " + std::to_string(bit) + " of `" + member.name + "`; name that byte";
    }
  }
  return {};
}

// Reads a path from left to right.
class PathReader {
 public:
  PathReader(const Image& image, std::string_view path) : image_(image), path_(path) {}

  base::Result<Symbol> run() {
    Symbol symbol;
    if (base::Status root = read_root(symbol); !root) return root.error();
    while (at_ < path_.size()) {
      const char next = path_[at_++];
      base::Status step = next == '.'   ? read_member(symbol)
                          : next == '[' ? read_index(symbol)
                                        : fail("expected `.` or `[`");
      if (!step) return step.error();
    }
    return symbol;
  }

 private:
  base::Error fail(const std::string& why) const { return no_such(path_, why); }

  std::string_view name() {
    const size_t end = std::min(path_.find_first_of(".[", at_), path_.size());
    const std::string_view text = path_.substr(at_, end - at_);
    at_ = end;
    return text;
  }

  base::Status read_root(Symbol& symbol) {
    const std::string_view text = name();
    // Globals that are visible as `List.x` or `A.B.x` only have that name, and so have static
    // variables: a program may be called as its instance is.
    const std::string_view listed = listed_name(image_.types, image_.globals, path_);
    std::string_view next = listed.empty() ? listed : listed.substr(text.size() + 1);
    next = next.substr(0, next.find('.'));
    for (uint32_t id = 1; id < image_.instances.size(); ++id) {
      const Instance& row = image_.instances[id];
      const bool program = row.live && image_.types.is_instance(row.type) &&
                           image_.types[row.type].kind == Kind::kProgram;
      if (!program || !same_name(row.name, text)) continue;
      if (!listed.empty() && image_.types.find_member(row.type, next) < 0) break;
      symbol.data = row.data;
      symbol.type = row.type;
      return base::Ok{};
    }
    symbol.type = image_.globals;
    symbol.data = image_.instances.empty() ? 0 : image_.instances[0].data;
    if (!listed.empty() && !global_has(text, next)) {
      at_ = listed.size();
      return step_to(symbol, listed, "");
    }
    return step_to(symbol, text, "is neither a program nor a global variable");
  }

  // A global `name` with a member `next`. A program that others call is among the globals too.
  bool global_has(std::string_view name, std::string_view next) const {
    const int32_t number = image_.types.find_member(image_.globals, name);
    if (number < 0) return false;
    const Member& global = image_.types[image_.globals].members[static_cast<size_t>(number)];
    return image_.types[global.type].kind != Kind::kProgram ||
           image_.types.find_member(global.type, next) >= 0;
  }

  base::Status read_member(Symbol& symbol) {
    const std::string_view text = name();
    if (!image_.types.has_members(symbol.type)) {
      return fail("`" + image_.types.text(symbol.type) + "` has no members");
    }
    return step_to(symbol, text, "is no member of `" + image_.types.text(symbol.type) + "`");
  }

  base::Status step_to(Symbol& symbol, std::string_view text, const std::string& why) {
    int32_t number = image_.types.find_member(symbol.type, text);
    if (number < 0 && symbol.type == image_.globals) {
      if (const auto shared = find_shared(image_.types, image_.globals, text)) {
        symbol = member_of(image_, symbol, shared->global);
        number = static_cast<int32_t>(shared->member);
      }
    }
    if (number < 0) {
      const std::string bit = byte_of_bit(image_.types[symbol.type], text);
      return fail("`" + std::string(text) + "` " + (bit.empty() ? why : bit));
    }
    const Member& member = image_.types[symbol.type].members[static_cast<size_t>(number)];
    if (member.section == Section::kInOut) {
      return fail("`" + std::string(text) + "` is an in-out; name the variable that is bound");
    }
    symbol = member_of(image_, symbol, static_cast<size_t>(number));
    return enter_if_instance(symbol);
  }

  base::Status enter_if_instance(Symbol& symbol) {
    if (image_.types.is_instance(symbol.type) && !enter(image_, symbol)) {
      return fail("there is no such instance");
    }
    return base::Ok{};
  }

  base::Status read_index(Symbol& symbol) {
    const Type& array = image_.types[symbol.type];
    if (array.kind != Kind::kArray) return fail("only arrays have an index");
    uint64_t flat = 0;
    for (size_t dim = 0; dim < array.dims.size(); ++dim) {
      int64_t index = 0;
      if (!read_number(index)) return fail("an index is a whole number");
      const Dimension& d = array.dims[dim];
      if (index < d.low || index > d.high) {
        return fail("index " + std::to_string(index) + " is outside " + std::to_string(d.low) +
                    ".." + std::to_string(d.high));
      }
      flat = flat * d.count() + (static_cast<uint64_t>(index) - static_cast<uint64_t>(d.low));
      const char wanted = dim + 1 == array.dims.size() ? ']' : ',';
      if (at_ >= path_.size() || path_[at_] != wanted) {
        return fail("the array has " + std::to_string(array.dims.size()) + " dimensions");
      }
      ++at_;
    }
    symbol.data += static_cast<uint32_t>(flat * image_.layouts[array.base].size);
    symbol.type = array.base;
    return enter_if_instance(symbol);
  }

  void skip_spaces() {
    while (at_ < path_.size() && path_[at_] == ' ') ++at_;
  }

  bool read_number(int64_t& number) {
    skip_spaces();
    const bool negative = at_ < path_.size() && path_[at_] == '-';
    if (negative) ++at_;
    uint64_t magnitude = 0;
    const size_t begin = at_;
    while (at_ < path_.size() && path_[at_] >= '0' && path_[at_] <= '9' && at_ - begin < 18) {
      magnitude = magnitude * 10 + static_cast<uint64_t>(path_[at_++] - '0');
    }
    if (at_ == begin) return false;
    skip_spaces();
    number = negative ? -static_cast<int64_t>(magnitude) : static_cast<int64_t>(magnitude);
    return true;
  }

  const Image& image_;
  std::string_view path_;
  size_t at_ = 0;
};

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

// VAR_ACCESS: another name for a variable, or for what its members begin with.
const AccessPath* access_path(const Image& image, std::string_view path) {
  for (const AccessPath& access : image.access) {  // `Main.x`, too: another name for one place
    const size_t size = access.name.size();
    const bool ends =
        size == path.size() || (size < path.size() && (path[size] == '.' || path[size] == '['));
    if (ends && same_name(access.name, path.substr(0, size))) return &access;
  }
  return nullptr;
}

base::Result<Symbol> find_symbol(const Image& image, std::string_view path) {
  if (const AccessPath* access = access_path(image, path)) {
    const std::string whole = access->path + std::string(path.substr(access->name.size()));
    base::Result<Symbol> symbol = PathReader(image, whole).run();
    if (symbol.ok()) symbol->constant |= !access->writable;
    return symbol;
  }
  return PathReader(image, path).run();
}

std::string type_text(const Image& image, const Symbol& symbol) {
  return symbol.bit_mask != 0 ? std::string(elementary_name(Kind::kBool))
                              : image.types.text(symbol.type);
}

std::string path_of(const Image& image, const Symbol& symbol) {
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const Instance& row = image.instances[id];
    const uint64_t end = uint64_t{row.data} + image.layouts[row.type].area_capacity;
    if ((id != 0 && !row.live) || symbol.data < row.data || symbol.data >= end) continue;
    std::string inside =
        path_inside(image.types, image.layouts, row.type, symbol.data - row.data, symbol.type);
    if (id == 0 && inside.starts_with('.')) inside.erase(0, 1);
    return image.instance_path(id) + inside;
  }
  return {};
}

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
