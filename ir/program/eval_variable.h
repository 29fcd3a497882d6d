// Variables of the evaluator: trees of values that know their type. Only what is looked at as
// bytes (unions, and whatever a reference names as another type) needs a layout.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ir/program/ir.h"
#include "ir/types/layout.h"

namespace ir {

struct Variable;

// Where an in-out or an addr value points. A variable of a frame is gone when the
// frame is: `frame` is its serial number, 0 for variables that live for ever.
struct Address {
  Variable* variable = nullptr;  // null: a value of `type` in the bytes of `root` only
  uint64_t frame = 0;
  Variable* root = nullptr;  // the area, local or constant that holds it
  uint32_t offset = 0;       // in `root`, as laid out
  TypeId type;
  uint32_t capacity = 0;  // of a string: characters that fit there
  bool constant = false;
  uint8_t bit_mask = 0;  // a BOOL at that bit of the BYTE (shared_bytes.h), as people see it
};

// Which of the parts counts follows from the type: scalars `bits`, strings and what overlaps
// `bytes`, everything else `parts` (array elements with the last dimension fastest, members),
// in-out slots and globals of a program type `target`. Parts are never added or removed once it is
// built, so that pointers to them stay good.
struct Variable {
  TypeId type;
  bool slot = false;
  uint64_t bits = 0;
  // Strings: all units, the NUL and what lies after it included. A structure that was written as
  // bytes: these, for its padding.
  std::string bytes;
  std::vector<Variable> parts;
  Address target;
};

class Variables {
 public:
  // Without `layouts` there are no unions.
  explicit Variables(const Program& program, const Layouts* layouts = nullptr)
      : program_(program), layouts_(layouts) {}

  // With its type's initial value; `init` overrides what it names.
  Variable make(TypeId type, ConstId init = ConstId()) const;
  Variable make_slot(TypeId type) const;
  // Back to the initial value.
  void reset(Variable& variable, ConstId init) const;
  // A string is cut to the capacity of `to`; what holds strings is copied byte for byte.
  void copy(Variable& to, const Variable& from) const;
  // Up to the first NUL, or to the capacity; what lies after the new NUL stays.
  void set_text(Variable& variable, std::string_view text) const;
  std::string_view text(const Variable& variable) const;

 private:
  ConstId listed(ConstId list, uint32_t index) const;
  Variable make_member(const Type& owner, uint32_t index, ConstId init) const;
  void make_elements(const Type& array, ConstId init, Variable& variable) const;
  void copy_all(Variable& to, const Variable& from) const;
  Variable make_overlapping(TypeId type, ConstId init) const;
  void make_leaf(const Type& type, ConstId init, Variable& variable) const;

  const Program& program_;
  const Layouts* layouts_;
};

}  // namespace ir
