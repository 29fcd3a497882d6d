// The globals that one version of a resource exchanges with others (Image::shared): by name, with a
// digest of the type, and where their bytes lie. A table made once for each image; copying needs
// no allocation.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "ir/bytecode/image.h"
#include "ir/types/plain_data.h"

namespace vm {

struct SharedVariable {
  std::string name;          // as listed; compared without case
  std::string type;          // as people read it
  base::Digest signature{};  // ir::plain_signature
  bool written = false;      // by this resource
  uint32_t bytes = 0;
  std::vector<ir::PlainRun> runs;  // in data memory
};

class SharedGlobals {
 public:
  explicit SharedGlobals(const ir::Image& image);

  const std::vector<SharedVariable>& variables() const { return variables_; }
  // nullptr: there is none of that name.
  const SharedVariable* find(std::string_view name) const;

  // Bytes of all that others write, one variable after the other, as they are in data memory.
  uint32_t read_bytes() const { return read_bytes_; }
  void gather_read(const uint8_t* memory, std::span<uint8_t> to) const;
  void scatter_read(std::span<const uint8_t> from, uint8_t* memory) const;

 private:
  std::vector<SharedVariable> variables_;
  uint32_t read_bytes_ = 0;
};

// Bytes of `runs` in data memory, one after the other, from or to a block; after its last byte.
uint8_t* gather(std::span<const ir::PlainRun> runs, const uint8_t* memory, uint8_t* to);
const uint8_t* scatter(std::span<const ir::PlainRun> runs, const uint8_t* from, uint8_t* memory);

}  // namespace vm
