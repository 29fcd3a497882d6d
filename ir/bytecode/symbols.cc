// Finding variables by path.
#include "ir/bytecode/symbols.h"

#include "base/joined.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/symbol_steps.h"
#include "ir/types/inside.h"
#include "ir/types/listed_name.h"
#include "ir/types/shared_bytes.h"

namespace ir {
namespace {

base::Error no_such(std::string_view path, const std::string& why) {
  return {base::Refusal::kNoSuchVariable, "`" + std::string(path) + "`: " + why};
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

// Names are looked up in the index, or without one in the tables themselves, row by row.
class Names {
 public:
  Names(const Image& image, const NameIndex* index) : image_(image), index_(index) {}

  const Image& image() const { return image_; }
  int32_t find_member(TypeId type, std::string_view name) const {
    return index_ != nullptr ? index_->find_member(type, name)
                             : image_.types.find_member(type, name);
  }
  std::optional<SharedMember> find_shared(std::string_view name) const {
    return index_ != nullptr ? index_->find_shared(name)
                             : ir::find_shared(image_.types, image_.globals, name);
  }
  std::string_view listed_name(std::string_view path) const {
    return index_ != nullptr ? index_->listed_name(path)
                             : ir::listed_name(image_.types, image_.globals, path);
  }
  uint32_t find_program(std::string_view name) const {
    if (index_ != nullptr) return index_->find_program(name);
    for (uint32_t id = 1; id < image_.instances.size(); ++id) {
      const Instance& row = image_.instances[id];
      const bool program = row.live && image_.types.is_instance(row.type) &&
                           image_.types[row.type].kind == Kind::kProgram;
      if (program && same_name(row.name, name)) return id;
    }
    return 0;
  }
  // VAR_ACCESS: another name for a variable, or for what its members begin with.
  const AccessPath* access_path(std::string_view path) const {
    if (index_ != nullptr) return index_->access_path(path);
    for (const AccessPath& access : image_.access) {  // `Main.x`, too: another name for one place
      const size_t size = access.name.size();
      const bool ends =
          size == path.size() || (size < path.size() && (path[size] == '.' || path[size] == '['));
      if (ends && same_name(access.name, path.substr(0, size))) return &access;
    }
    return nullptr;
  }

 private:
  const Image& image_;
  const NameIndex* index_;
};

// Reads a path from left to right.
class PathReader {
 public:
  PathReader(const Names& names, std::string_view path)
      : names_(names), image_(names.image()), path_(path) {}

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
    const std::string_view listed = names_.listed_name(path_);
    std::string_view next = listed.empty() ? listed : listed.substr(text.size() + 1);
    next = next.substr(0, next.find('.'));
    if (const uint32_t id = names_.find_program(text); id != 0) {
      const Instance& row = image_.instances[id];
      if (listed.empty() || names_.find_member(row.type, next) >= 0) {
        symbol.data = row.data;
        symbol.type = row.type;
        return base::Ok{};
      }
    }
    symbol.type = image_.globals;
    symbol.data = image_.instances.empty() ? 0 : image_.instances[0].data;
    if (!listed.empty() && !global_has(text, next)) {
      at_ = listed.size();
      return step_to(symbol, listed, "");
    }
    return step_to(symbol, text, "is neither a program nor a global variable" + without_list());
  }

  // `GVL.level` of a list whose variables are visible without it: no image names such a list.
  std::string without_list() const {
    if (at_ >= path_.size() || path_[at_] != '.') return {};
    const std::string_view rest = path_.substr(at_ + 1);
    const std::string_view first = rest.substr(0, rest.find_first_of(".["));
    if (names_.find_member(image_.globals, first) < 0) return {};
    return base::joined(
        {"; a list is part of a name only by {attribute 'qualified_only'}: the variable is `", rest,
         "`"});
  }

  // A global `name` with a member `next`. A program that others call is among the globals too.
  bool global_has(std::string_view name, std::string_view next) const {
    const int32_t number = names_.find_member(image_.globals, name);
    if (number < 0) return false;
    const Member& global = image_.types[image_.globals].members[static_cast<size_t>(number)];
    return image_.types[global.type].kind != Kind::kProgram ||
           names_.find_member(global.type, next) >= 0;
  }

  base::Status read_member(Symbol& symbol) {
    // What an edge remembers is called after an operand, which may be a path.
    const std::string_view rest = path_.substr(at_);
    const bool edge = rest.find('#') != rest.npos && names_.find_member(symbol.type, rest) >= 0;
    const std::string_view text = edge ? rest : name();
    if (edge) at_ = path_.size();
    if (!image_.types.has_members(symbol.type)) {
      return fail("`" + image_.types.text(symbol.type) + "` has no members");
    }
    return step_to(symbol, text, "is no member of `" + image_.types.text(symbol.type) + "`");
  }

  base::Status step_to(Symbol& symbol, std::string_view text, const std::string& why) {
    int32_t number = names_.find_member(symbol.type, text);
    if (number < 0 && symbol.type == image_.globals) {
      if (const auto shared = names_.find_shared(text)) {
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

  const Names& names_;
  const Image& image_;
  std::string_view path_;
  size_t at_ = 0;
};

base::Result<Symbol> find_by(const Names& names, std::string_view path) {
  const AccessPath* const access = names.access_path(path);
  if (access == nullptr) return PathReader(names, path).run();
  const std::string whole = access->path + std::string(path.substr(access->name.size()));
  base::Result<Symbol> symbol = PathReader(names, whole).run();
  if (symbol.ok()) symbol->constant |= !access->writable;
  return symbol;
}

}  // namespace

base::Result<Symbol> find_symbol(const Image& image, std::string_view path) {
  return find_by({image, nullptr}, path);
}

base::Result<Symbol> find_symbol(const NameIndex& names, std::string_view path) {
  return find_by({names.image(), &names}, path);
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

}  // namespace ir
