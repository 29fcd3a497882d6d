// Fills an object's tables; equal entries share one number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/byte_table.h"
#include "ir/bytecode/object.h"

namespace ir::codegen {

class Tables {
 public:
  explicit Tables(Object& object) : object_(object) {}

  uint32_t place(const ObjectPlace& place);
  uint32_t scalar(Class cls, uint64_t bits);
  uint32_t initial_value(TypeId type, ConstId value);
  uint32_t region(Region region);
  uint32_t bound(TypeId array, uint8_t dim, const std::string& name);
  uint32_t range(int64_t low, int64_t high, const std::string& name);
  uint32_t callee(const std::string& name);
  uint32_t argument_slot(uint32_t callee, uint32_t param, Class cls, bool aggregate, Region region);
  uint32_t native_slot(uint32_t number, Class cls);

 private:
  template <class T, class Make>
  uint32_t intern(std::vector<T>& table, const Make& make);

  Object& object_;
  std::string key_;  // of the entry that is looked up
  base::ByteTable numbers_;
};

}  // namespace ir::codegen
