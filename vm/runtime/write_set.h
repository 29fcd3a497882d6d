// Values to be written at one boundary: found and checked before, off the control thread, so that
// the boundary only copies bytes.
#pragma once

#include <span>
#include <vector>

#include "base/bytes.h"
#include "vm/runtime/forces.h"

namespace vm {

struct TaskTables;

struct WriteSet {
  struct Value {
    uint32_t data = 0;
    base::Bytes bytes;
    uint8_t mask = 0;  // ir::Symbol::bit_mask
    void put(uint8_t* memory) const;
  };
  struct OutputBits {
    uint32_t byte = 0;
    uint8_t mask = 0;
  };
  std::vector<Value> values;
  std::vector<OutputBits> outputs;  // bits of %Q that the values are sent as
  uint64_t work_bytes = 0;          // in lines (live_copy.h), for the time that it takes
  uint32_t generation = 0;

  // All or none: a mistake in the last one is found before the first is written. kTooMany: more
  // than one boundary has room for.
  static base::Result<WriteSet> make(const TaskTables& tables, std::span<const NamedValue> values);
};

// What `set` and `force` write to; kReadOnly.
base::Result<ir::Symbol> writable(const ir::VerifiedImage& version, std::string_view path);
base::Result<base::Bytes> parsed(const ir::Image& image, const ir::Symbol& symbol,
                                 const NamedValue& row);

}  // namespace vm
