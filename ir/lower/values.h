// What selection needs to know about each SSA value before it starts: its
// definition, how often and where it is used, and whether it is another value
// under a new name (a check's result, a conversion that changes no bits).
#pragma once

#include <cstdint>
#include <vector>

#include "ir/lower/flow.h"
#include "ir/program/alias.h"
#include "ir/program/ir.h"

namespace ir::codegen {

struct ValueFacts {
  const Inst* definition = nullptr;  // null: a block parameter
  uint32_t block = 0;                // position of the defining block
  uint32_t uses = 0;
  bool escapes = false;  // used outside its block
  ValueId same_as;       // valid: this value is that one
};

class Values : public AliasFacts {
 public:
  Values(const TypeTable& types, const Pou& pou, const Flow& flow);

  // The value that `id` stands for.
  ValueId root(ValueId id) const;
  const ValueFacts& operator[](ValueId id) const { return facts_[id.index]; }
  bool is_constant(ValueId id) const;
  uint64_t constant_bits(ValueId id) const;
  // Computes a value from values, without effect, and cannot trap.
  bool is_pure(const Inst& inst) const;
  // A pure value that nothing live uses.
  bool is_dead(const Inst& inst) const;
  std::optional<int64_t> constant_index(ValueId id) const override;
  bool local_escapes(uint32_t local) const override { return local_escapes_[local]; }

 private:
  void define(const Pou& pou, const Flow& flow);
  void count_uses(const Pou& pou, const Flow& flow);
  void drop_dead(const Pou& pou, const Flow& flow);
  void use(ValueId id, uint32_t block);
  void use_place(const Pou& pou, PlaceId place, uint32_t block);

  std::vector<ValueFacts> facts_;
  std::vector<bool> local_escapes_;
};

// Does the conversion `inst` leave the bits of its operand as they are?
bool changes_nothing(const Inst& inst, Scalar operand);

}  // namespace ir::codegen
