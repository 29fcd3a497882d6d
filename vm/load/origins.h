// Where the addresses in the frame slots of a POU come from, unit by unit.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "ir/bytecode/image.h"

namespace vm {

struct Origin {
  enum class Kind : uint8_t {
    kPlace,        // in the area of `base`
    kInstance,     // in the instance whose ID lies at `slot` of `base`
    kAnyInstance,  // in an instance of `type`, when that is valid
    kInOut,
    kReference,
    kAnywhere,  // too many to tell
  };
  Kind kind = Kind::kPlace;
  ir::Base base = ir::Base::kFrame;
  bool exact = true;  // it points to `begin`, else somewhere in front of `end`
  uint32_t slot = 0;
  uint64_t begin = 0;  // in that area; addresses of globals are those in data memory
  uint64_t end = 0;
  ir::TypeId type;
  friend bool operator==(const Origin&, const Origin&) = default;
};
using Origins = std::vector<Origin>;  // it is one of these

// Walks the units of a POU in order. Borrows both.
class OriginWalk {
 public:
  OriginWalk(const ir::Image& image, const ir::LinkedPou& pou);
  // To be told of every unit: enter() before anything is asked about it, pass() after that.
  void enter(uint32_t unit);
  void pass(uint32_t unit);
  // The origins of the address or string in that slot of the own frame, or of the next one.
  Origins of(uint32_t slot) const;
  // What the slot of the own frame points to; an invalid type: a string.
  ir::Region region(uint32_t slot) const;

  // Addresses in the next frame, put there for the call or native function that comes next.
  struct Argument {
    uint32_t slot = 0;
    Origins origins;
  };
  const std::vector<Argument>& arguments() const { return arguments_; }

 private:
  Origins of_unit(uint32_t unit) const;
  Origins moved(uint32_t slot, uint64_t by, uint64_t size) const;
  void find_all();

  const ir::Image& image_;
  const ir::LinkedPou& pou_;
  std::span<const ir::Unit> code_;
  size_t next_merge_ = 0;
  std::unordered_map<uint32_t, Origins> now_;  // since the last merge
  std::unordered_map<uint32_t, Origins> all_;  // in the whole POU
  std::vector<Argument> arguments_;
};

// Does the unit put an address or a string into a frame slot?
bool makes_address(const ir::Unit& unit);

}  // namespace vm
