// Rules of the instructions that name places: each step legal, types equal,
// constants read only, in-out slots followed or bound.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ir/program/place.h"

namespace ir {

// The instruction that defines each value; null for block parameters.
using Definitions = std::vector<const Inst*>;

class MemoryVerifier {
 public:
  // `definitions` may be filled after construction, and has an entry for every value.
  MemoryVerifier(const Program& program, const Pou& pou, const Definitions& definitions)
      : program_(program), pou_(pou), definitions_(definitions) {}

  // The first reason found; empty when the instruction is right. Its operands exist.
  std::string check(const Inst& inst);
  // Not the address or string of a constant, as far as can be seen.
  bool writable(ValueId value) const;

 private:
  void require(bool holds, const char* why) {
    if (!holds) {
      fail(why);
    }
  }
  void fail(const std::string& why) {
    if (reason_.empty()) {
      reason_ = why;
    }
  }
  const Place* pointee(ValueId value) const;
  void check_memory_inst(const Inst& inst);
  void check_handle(const Inst& inst, const PlaceState& state);
  void check_access(const Inst& inst, const PlaceState& state);
  void check_store(const Inst& inst, const PlaceState& state);
  void check_copy(const Inst& inst, const PlaceState& to);
  std::optional<PlaceState> check_one_place(PlaceId id, bool may_be_entered);
  void check_place_values(const Place& place);
  void check_pointee(const Place& place);

  const Program& program_;
  const Pou& pou_;
  const Definitions& definitions_;
  std::string reason_;
};

}  // namespace ir
