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
  uint32_t offset(const ir::Object& object, uint32_t number) const;
  const base::Bytes& bytes() const { return bytes_; }

 private:
  uint32_t intern(const base::Bytes& entry);
  // Where the base has these bytes, at the beginning of a word.
  std::optional<uint32_t> in_base(const base::Bytes& entry) const;

  base::Bytes bytes_;
  size_t base_size_ = 0;
  std::unordered_map<uint64_t, std::vector<uint32_t>> words_;  // of the base, by content
  std::unordered_map<std::string, uint32_t> offsets_;
  std::unordered_map<const ir::Object*, std::vector<uint32_t>> of_object_;
};

}  // namespace linker
