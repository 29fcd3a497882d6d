// Variables of the evaluator as the bytes that they are in memory, by a layout. Slots of instances
// and in-outs are no bytes; the padding of a structure goes where the structure goes.
#pragma once

#include <span>

#include "ir/program/eval_variable.h"

namespace ir {

class EvalBytes {
 public:
  EvalBytes(const TypeTable& types, const Layouts& layouts) : types_(types), layouts_(layouts) {}

  // `root` is a value, or an instance or the globals: then its own variables.
  void read(const Variable& root, uint32_t offset, std::span<uint8_t> out) const;
  void write(Variable& root, uint32_t offset, std::span<const uint8_t> in) const;
  // The part of exactly that type which begins at `offset`; null when there are only bytes.
  Variable* find(Variable& root, uint32_t offset, TypeId type) const;

 private:
  // Calls visit(leaf, its offset) for every leaf that has a byte in [begin, end), and for every
  // structure before what is in it.
  template <class Var, class Visit>
  void for_leaves(Var& variable, uint64_t at, uint64_t begin, uint64_t end, Visit visit) const;
  bool is_padded(const Variable& variable) const;
  uint32_t leaf_size(const Variable& leaf) const;

  const TypeTable& types_;
  const Layouts& layouts_;
};

}  // namespace ir
