// May a write to one place change what another place holds? Errs on the safe side.
// Areas never overlap: the globals, an instance's own variables, and the instances
// it contains are different memory; what a reference points to may be any of it.
// Between two safe points (calls, back edges) nothing else writes: no other task runs.
#pragma once

#include <optional>

#include "ir/program/ir.h"

namespace ir {

// What is known about the values and locals of the POU that the places belong to.
class AliasFacts {
 public:
  explicit AliasFacts(const TypeTable& types) : types_(types) {}
  virtual ~AliasFacts() = default;

  const TypeTable& types() const { return types_; }
  // The index that a value is, when that is known.
  virtual std::optional<int64_t> constant_index(ValueId value) const = 0;
  // Was the address of that local taken?
  virtual bool local_escapes(uint32_t local) const = 0;

 protected:
  AliasFacts(const AliasFacts&) = default;

 private:
  const TypeTable& types_;
};

bool may_alias(const Place& a, const Place& b, const AliasFacts& facts);
// May a called POU read or write it? Only locals whose address nobody took are private.
bool calls_may_change(const Place& place, const AliasFacts& facts);
// A fixed offset from a fixed root: reading it needs no instruction and cannot trap.
bool is_static(const Place& place, const AliasFacts& facts);
// Does an instruction on this place take a local's address (kAddress, kHandle)? Its number.
std::optional<uint32_t> local_of_address(const Inst& inst, const Pou& pou);
inline std::optional<uint32_t> exposed_local(const Inst& inst, const Pou& pou) {
  if (inst.op != Op::kAddress && inst.op != Op::kHandle) return std::nullopt;
  return local_of_address(inst, pou);
}

}  // namespace ir
