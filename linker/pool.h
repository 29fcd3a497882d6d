// The constant pool of an image: equal entries once, each on a multiple of 8. Constants that the
// base has keep their places, so that an edit with new constants moves those of no other POU (D2).
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/object.h"
#include "linker/initial.h"

namespace linker {

class ConstantPool {
 public:
  ConstantPool() = default;
  // Begins with all of the base's pool, needed or not.
  explicit ConstantPool(const base::Bytes& base);

  // Scalars of all objects go first, where 16-bit offsets reach.
  void add_scalars(const ir::Object& object);
  void add_values(const ir::Object& object, const InitialValues& initial,
                  const ir::Layouts& layouts);
  // Offset of constant `number` of `object`, which must have been added.
  uint32_t offset(const ir::Object& object, uint32_t number) const {
    return offsets(object)[number];
  }
  // The offsets of all constants of the object.
  const std::vector<uint32_t>& offsets(const ir::Object& object) const {
    return of_object_.at(&object);
  }
  // Has `other` the constants of the object where this pool has them?
  bool same_offsets(const ConstantPool& other, const ir::Object& object) const {
    return of_object_.at(&object) == other.of_object_.at(&object);
  }
  const base::Bytes& bytes() const { return bytes_; }

 private:
  uint32_t intern(base::ByteSpan entry);
  // Where the base has these bytes, at the beginning of a word.
  std::optional<uint32_t> in_base(base::ByteSpan entry) const;

  base::Bytes bytes_;
  size_t base_size_ = 0;
  std::unordered_map<uint64_t, std::vector<uint32_t>> words_;  // of the base, by content
  std::unordered_map<std::string, uint32_t> offsets_;
  std::unordered_map<const ir::Object*, std::vector<uint32_t>> of_object_;
};

// The pool of all objects (by POU number; null: none). `base`, which may be null, is that of the
// running version. What it has stays where it is, until too much of it is of no use any more. In
// the end every constant is taken from the first place that has its bytes: so the same program
// linked against itself comes out the same.
ConstantPool make_pool(const std::vector<const ir::Object*>& objects, const InitialValues& initial,
                       const ir::Layouts& layouts, const base::Bytes* base);

}  // namespace linker
