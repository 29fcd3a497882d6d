// Case 75: what lies at %M and %Q keeps its bytes by its address, whatever variables the versions
// have there: `%MD4` becomes two words on its bytes, a BOOL at a bit becomes a bit of a word.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

// Bytes of the old version, or one bit of them, for a variable of the new one.
struct GatheredPart {
  static constexpr uint8_t kBool = 0;  // a BOOL, whose byte is 0 or 1
  uint32_t from = 0;                   // in data memory
  uint32_t within = 0;                 // of the variable that is made
  uint32_t size = 0;                   // bytes; 0: one bit
  uint8_t from_mask = kBool;           // of a bit: where it is in its byte, or kBool
  uint8_t to_mask = kBool;
};
using Gather = std::vector<GatheredPart>;

// Bytes `first` to `first + out.size()` of the variable, which hold what no part gives.
void gather(const Gather& parts, const uint8_t* memory, uint32_t first, std::span<uint8_t> out);

// Neighbouring bits of %M or %Q in data memory.
struct AddressRun {
  ir::DirectArea area = ir::DirectArea::kNone;
  uint64_t bit = 0;  // its address
  uint64_t bits = 0;
  uint32_t data = 0;  // of the first
  bool alone = false;  // a BOOL with a byte of its own
  uint64_t end() const { return bit + bits; }
};

// A variable at %M or %Q, or variables that share bytes.
struct AddressedVariable {
  uint32_t data = 0;
  uint32_t size = 0;
  std::string path;
  std::vector<AddressRun> runs;  // those of shared bytes may overlap
  bool any_bits = false;         // is each pattern of bits a value of it?
};

// Are they numbers, bits, times or text?
bool takes_any_bits(const ir::TypeTable& types, ir::TypeId type);

std::vector<AddressedVariable> addressed_variables(const ir::Image& image);

// What of the old version goes on by its address.
class TakenBits {
 public:
  void add(const Gather& parts);
  // After the last add().
  bool all(uint64_t begin, uint64_t end) const;  // bytes of data memory

 private:
  struct Range {
    uint64_t begin = 0;
    uint64_t end = 0;
  };
  std::map<uint64_t, uint64_t> ranges_;  // disjoint, neither overlapping nor touching
  std::map<uint32_t, uint8_t> bits_;     // by byte
  void add(Range range);
};

// What the old version has at an address.
class AddressBits {
 public:
  explicit AddressBits(const std::vector<AddressedVariable>& variables);
  // What a variable of the new version gets, in order.
  Gather parts_of(const AddressedVariable& variable) const;

 private:
  std::vector<AddressRun> runs_;  // sorted, disjoint
};

}  // namespace online_change
