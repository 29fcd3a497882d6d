// Initial values laid out as bytes: a member's own initial value, else its type's,
// else zero (A15). Instance and in-out slots stay zero.
#pragma once

#include <span>
#include <vector>

#include "ir/types/constants.h"
#include "ir/types/layout.h"
#include "ir/types/types.h"

namespace linker {

class InitialValues {
 public:
  InitialValues(const ir::TypeTable& types, const ir::ConstTable& constants,
                const ir::Layouts& layouts)
      : types_(types),
        constants_(constants),
        layouts_(layouts),
        defaults_(types.size(), Default::kUnknown) {
    for (uint32_t i = 0; i < types.size(); ++i) find_default(ir::TypeId(i));
  }

  // A value of `type`: `value`, or the type's default. `out` is zero and has its size.
  void write_value(ir::TypeId type, ir::ConstId value, std::span<uint8_t> out) const;
  // The variables of an instance or of the globals.
  void write_area(ir::TypeId type, ir::ConstId value, std::span<uint8_t> out) const;
  // What member `number` of a structure or instance of `type` starts with.
  ir::ConstId member_value(ir::TypeId type, ir::ConstId value, size_t number) const;
  // What element `flat` of an array starts with; invalid: the element type's default.
  ir::ConstId element_value(ir::TypeId type, ir::ConstId value, uint64_t flat) const;

 private:
  void write(ir::TypeId type, ir::ConstId value, std::span<uint8_t> out, uint32_t depth) const;
  void write_members(ir::TypeId type, ir::ConstId value, std::span<uint8_t> out,
                     uint32_t depth) const;
  void write_overlapping(ir::TypeId id, ir::ConstId value, std::span<uint8_t> out,
                         uint32_t depth) const;
  void write_array(ir::TypeId type, ir::ConstId value, std::span<uint8_t> out,
                   uint32_t depth) const;
  // Is a value of the type all zero when nothing says otherwise? Then nothing is written: a few
  // types that hold each other twice have a billion parts.
  enum class Default : uint8_t { kUnknown, kZero, kOther };
  bool find_default(ir::TypeId type);
  ir::ConstId listed(ir::ConstId value, uint64_t index) const;

  const ir::TypeTable& types_;
  const ir::ConstTable& constants_;
  const ir::Layouts& layouts_;
  std::vector<Default> defaults_;  // by type
};

}  // namespace linker
