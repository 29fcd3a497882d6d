// Variables of the evaluator: trees of values that know their type and no layout.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ir/program/ir.h"

namespace ir {

struct Variable;

// Where an in-out or an addr value points. A variable of a frame is gone when the
// frame is: `frame` is its serial number, 0 for variables that live for ever.
struct Address {
  Variable* variable = nullptr;
  uint64_t frame = 0;
};

// Which of the parts counts follows from the type: scalars `bits`, strings `text`,
// everything else `parts` (array elements with the last dimension fastest, members),
// in-out slots `target`. Parts are never added or removed once it is built, so that
// pointers to them stay good.
struct Variable {
  TypeId type;
  bool slot = false;
  uint64_t bits = 0;
  std::string text;  // without NUL; WSTRING: UTF-16LE
  std::vector<Variable> parts;
  Address target;
};

class Variables {
 public:
  explicit Variables(const Program& program) : program_(program) {}

  // With its type's initial value; `init` overrides what it names.
  Variable make(TypeId type, ConstId init = ConstId()) const;
  Variable make_slot(TypeId type) const;
  // Back to the initial value.
  void reset(Variable& variable, ConstId init) const;
  // Strings are cut to the capacity of `to`.
  void copy(Variable& to, const Variable& from) const;
  void set_text(Variable& variable, std::string_view text) const;

 private:
  ConstId listed(ConstId list, uint32_t index) const;
  Variable make_member(const Type& owner, uint32_t index, ConstId init) const;
  void make_elements(const Type& array, ConstId init, Variable& variable) const;
  void make_leaf(const Type& type, ConstId init, Variable& variable) const;

  const Program& program_;
};

}  // namespace ir
