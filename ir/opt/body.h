// What passes share: questions about instructions, constants, replacing values, and removing
// instructions. All of it belongs to one pass over one POU; nothing is kept in between.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ir/program/alias.h"
#include "ir/program/ir.h"

namespace ir::opt {

// Visits each operand and block argument; those inside places are visited by the places.
template <class Instruction, class Visit>
void for_each_operand(Instruction& inst, Visit visit) {
  for (auto& operand : inst.operands) visit(operand);
  for (auto& target : inst.targets) {
    for (auto& arg : target.args) visit(arg);
  }
}

template <class AnyPlace, class Visit>
void for_each_value(AnyPlace& place, Visit visit) {
  if (place.value.valid()) visit(place.value);
  for (auto& step : place.steps) {
    if (step.value.valid()) visit(step.value);
  }
}

// Values that are constants.
class Constants {
 public:
  explicit Constants(const Pou& pou);
  std::optional<uint64_t> operator[](ValueId value) const {
    return known(value) ? std::optional<uint64_t>(bits_[value.index]) : std::nullopt;
  }
  // False of values that were made after the constructor and not set.
  bool known(ValueId value) const { return value.index < known_.size() && known_[value.index]; }
  void set(ValueId value, uint64_t bits);

 private:
  std::vector<bool> known_;
  std::vector<uint64_t> bits_;
};

Inst constant_inst(Scalar scalar, ValueId result, uint64_t bits, uint32_t line);
ValueId new_value(Pou& pou, Scalar scalar);

// Computes its result from its operands alone, without effect, and cannot trap.
bool is_pure(const Inst& inst, const Constants& constants);
// The same for a native function without strings.
bool is_pure_native(const Inst& inst);

// Which locals have an address that somebody may use, and constant indices.
class Facts : public AliasFacts {
 public:
  Facts(const Program& program, const Pou& pou);
  std::optional<int64_t> constant_index(ValueId value) const override;
  bool local_escapes(uint32_t local) const override { return escapes_[local]; }
  Constants constants;

 private:
  std::vector<bool> escapes_;
};

// A write that may reach other places than it names, or a read of all.
bool is_call(Op op);

// Values that others stand for; chains are followed.
class Replacements {
 public:
  explicit Replacements(const Pou& pou);
  void replace(ValueId value, ValueId by) {
    by_[value.index] = by;
    ++count_;
  }
  ValueId operator()(ValueId value);
  bool empty() const { return count_ == 0; }
  // Everywhere, the values inside places too.
  void apply(Pou& pou);

 private:
  std::vector<ValueId> by_;
  size_t count_ = 0;
};

// How often each value is used, by instructions in reachable and unreachable blocks alike.
std::vector<uint32_t> count_uses(const Pou& pou);

// For each block, how many targets lead to it (from everywhere), and the last block that does.
struct Entries {
  std::vector<uint32_t> count;
  std::vector<uint32_t> from;
};
Entries count_entries(const Pou& pou);

}  // namespace ir::opt
