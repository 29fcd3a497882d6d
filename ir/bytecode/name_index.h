// The names of an image in a hash table, for whoever looks for many of them: a name costs a look at
// it, where find_symbol(image, path) goes through all globals. Names are those of members of large
// types (globals among them), of programs, of variables at overlapping addresses and of access
// paths. Every answer is that of the function which it is named after, also where a name is there
// twice: the first of them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "ir/bytecode/image.h"
#include "ir/types/shared_bytes.h"

namespace ir {

class NameIndex {
 public:
  // Borrows `image`, which stays as it is. Linear in its names; 16 to 32 bytes for each.
  explicit NameIndex(const Image& image);

  const Image& image() const { return image_; }
  // TypeTable::find_member
  int32_t find_member(TypeId type, std::string_view name) const;
  // shared_bytes.h
  std::optional<SharedMember> find_shared(std::string_view name) const;
  // listed_name.h
  std::string_view listed_name(std::string_view path) const;
  // ID of the live instance of a PROGRAM with that name; 0: there is none.
  uint32_t find_program(std::string_view name) const;
  // Row of Image::access whose name the path is, or begins with; null: none.
  const AccessPath* access_path(std::string_view path) const;
  // Live instances of PROGRAMs, in declaration order.
  const std::vector<uint32_t>& programs() const { return programs_; }

 private:
  // Whose name it is: a type, by its number, or one of these.
  static constexpr uint32_t kProgram = 0xffffffffu;
  static constexpr uint32_t kShared = 0xfffffffeu;
  static constexpr uint32_t kAccess = 0xfffffffdu;
  struct Row {
    uint32_t owner = 0;
    uint32_t number = kFree;
  };
  static constexpr uint32_t kFree = 0xffffffffu;

  size_t count_names() const;
  void add(uint32_t owner, uint32_t number);
  std::string_view name_of(const Row& row) const;
  uint32_t find(uint32_t owner, std::string_view name) const;  // kFree: it is not there

  const Image& image_;
  std::vector<uint32_t> programs_;
  std::vector<SharedMember> shared_;
  std::vector<Row> rows_;  // open addressing, at most half full
  // Bytes of the longest global with a dot in its name, and of the longest access path.
  size_t longest_listed_ = 0;
  size_t longest_access_ = 0;
};

// One for all threads, made when somebody asks first.
class NamesOnDemand {
 public:
  const NameIndex& of(const Image& image) const {
    std::call_once(once_, [&] { index_ = std::make_unique<const NameIndex>(image); });
    return *index_;
  }

 private:
  mutable std::once_flag once_;
  mutable std::unique_ptr<const NameIndex> index_;
};

}  // namespace ir
