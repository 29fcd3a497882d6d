// The constant pool of an image: equal entries once, each on a multiple of 8.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/object.h"
#include "linker/initial.h"

namespace linker {

class ConstantPool {
 public:
  // Scalars of all objects go first, where 16-bit offsets reach.
  void add_scalars(const ir::Object& object);
  void add_values(const ir::Object& object, const InitialValues& initial,
                  const ir::Layouts& layouts);
  // Offset of constant `number` of `object`, which must have been added.
  uint32_t offset(const ir::Object& object, uint32_t number) const;
  const base::Bytes& bytes() const { return bytes_; }

 private:
  uint32_t intern(const base::Bytes& entry);

  base::Bytes bytes_;
  std::unordered_map<std::string, uint32_t> offsets_;
  std::unordered_map<const ir::Object*, std::vector<uint32_t>> of_object_;
};

}  // namespace linker
