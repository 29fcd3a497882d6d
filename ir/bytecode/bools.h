// BOOLs in data memory, which are 0 or 1 unless a program can write their bytes as another type
// (docs/adr/0024-clean-bools.md). Code is made faster by that; memory safety never relies on it.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace ir {

class Bools {
 public:
  // The bools of a verified image, which is borrowed. `known`: those of another version, whose code
  // is looked at no more where it is the same; null: of none.
  explicit Bools(const Image& image, const Bools* known = nullptr);

  // Do instructions of this image write nothing but 0 and 1 to bytes of BOOLs?
  bool stay_clean() const { return stay_clean_; }
  // How many lie in data memory.
  uint64_t count() const;
  // Any other byte becomes 1: in a value of `type` (an instance: its area), in all data memory.
  void normalise(TypeId type, uint8_t* value) const;
  void normalise_all(uint8_t* memory) const;

 private:
  bool find(TypeId type, uint32_t depth);
  uint64_t count_in(TypeId type, uint32_t depth) const;
  void normalise(TypeId type, uint8_t* value, uint32_t depth) const;
  bool is_slot(const Member& member) const;
  bool writes_as_others();

  const Image& image_;
  enum class Holds : uint8_t { kUnknown, kNo, kYes };
  std::vector<Holds> holds_;  // by type
  bool stay_clean_ = false;
};

// Bytes that are BOOLs.
void normalise_bools(uint8_t* at, size_t count);

// Do both stay clean, or neither? Where code that differs does not matter; false says nothing.
bool stay_alike(const Image& a, const Image& b);

// Must a change from `before` to `after` normalise data memory?
inline bool needs_normalising(const Bools& before, const Bools& after) {
  return !before.stay_clean() && after.stay_clean();
}

}  // namespace ir
