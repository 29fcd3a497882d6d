// Where BOOLs in a frame hold a value that somebody may still read. What holds at jumps comes from
// the merges of the POU (ir/bytecode/object.h), so one pass backwards over the code is enough.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ir/bytecode/image.h"

namespace vm {

class LastReads {
 public:
  // The code of a verified POU, whose frame is that of `pou`.
  LastReads(const ir::LinkedPou& pou, std::span<const ir::Unit> code);

  // Is the value that the instruction reads through that field, a BOOL in the frame, dead after
  // it? The same for `a` says that nobody reads what it writes there.
  bool ends_a(uint32_t unit) const { return (dead_[unit] & 1) != 0; }
  bool ends_b(uint32_t unit) const { return (dead_[unit] & 2) != 0; }
  bool ends_c(uint32_t unit) const { return (dead_[unit] & 4) != 0; }

 private:
  struct Place {
    bool temporary = false;  // a BOOL that nobody finds but by its offset; others are always live
    bool live = false;
    uint32_t stretch = 0;  // in which `live` holds
  };
  void list_places(const ir::LinkedPou& pou, std::span<const ir::Unit> code);
  void keep(uint32_t offset);
  bool is_live(uint32_t offset) const;
  void set(uint32_t offset, bool live);
  void begin_stretch(bool all_live);
  void arrive(const ir::LinkedPou& pou, uint32_t unit);
  void pass(const ir::LinkedPou& pou, const ir::Unit& u, uint32_t unit);

  std::vector<Place> places_;  // by offset in the frame
  std::vector<uint8_t> dead_;  // by unit; bits of a, b and c
  uint32_t stretch_ = 0;       // code without an end in between
  bool all_live_ = true;       // what the stretch has not said yet
};

}  // namespace vm
