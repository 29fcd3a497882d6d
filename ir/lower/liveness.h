// Which registers are read later (live) and which have been written on every way
// (assigned), per block.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "base/inline_vector.h"
#include "ir/lower/machine.h"

namespace ir::codegen {

class RegisterSet {
 public:
  explicit RegisterSet(size_t size = 0, bool full = false) {
    words_.resize((size + 63) / 64);
    if (full) std::fill(words_.begin(), words_.end(), ~uint64_t{0});
  }
  bool has(uint32_t r) const { return (words_[r / 64] >> (r % 64) & 1) != 0; }
  void add(uint32_t r) { words_[r / 64] |= uint64_t{1} << (r % 64); }
  void remove(uint32_t r) { words_[r / 64] &= ~(uint64_t{1} << (r % 64)); }
  // True when the set changed.
  bool unite(const RegisterSet& other);
  bool intersect(const RegisterSet& other);
  void subtract(const RegisterSet& other);
  template <class Visit>
  void for_each(Visit visit) const {
    for (size_t i = 0; i < words_.size(); ++i) {
      for (uint64_t left = words_[i]; left != 0; left &= left - 1) {
        visit(static_cast<uint32_t>(i * 64 + static_cast<size_t>(std::countr_zero(left))));
      }
    }
  }

 private:
  base::InlineVector<uint64_t, 1> words_;
};

// Sets over the registers that matter beyond one block; most temporaries do not,
// so sets stay small in large POUs.
struct Liveness {
  std::vector<uint32_t> registers;  // element of the sets -> register
  std::vector<RegisterSet> live_in;
  std::vector<RegisterSet> live_out;
  std::vector<RegisterSet> assigned_in;
};

Liveness analyse_liveness(const Machine& machine, const std::vector<uint32_t>& written_at_entry);

}  // namespace ir::codegen
