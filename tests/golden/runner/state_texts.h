// Texts of states, each made once: the tiers of one program mostly have the same bytes, and a text
// takes far longer than to compare these.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>

#include "base/bytes.h"
#include "ir/bytecode/verify.h"

namespace golden {

class StateTexts {
 public:
  // ir::state_text() of these.
  std::string text(const ir::VerifiedImage& image, std::span<const uint8_t> memory);

 private:
  struct Known {
    base::Digest image;
    base::Bytes memory;
    std::string text;
  };
  std::unordered_multimap<size_t, Known> known_;  // by a hash of the memory
  size_t size_ = 0;                               // bytes of memories
};

}  // namespace golden
