// The tables of an object that is made from the code of an image: each entry once, found by what
// the code names.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "base/byte_table.h"
#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/place_finder.h"

namespace linker {

// What a field with an offset leads to.
struct Wanted {
  static constexpr uint32_t kNoBytes = 0xffffffffu;
  SpotTest test;
  std::string key;            // another test has another one
  ir::Region constant;        // in the constant pool: a value of this type
  uint32_t bytes = kNoBytes;  // or of so many bytes
  bool any = false;           // nothing says what is there
};

class UnlinkTables {
 public:
  // Borrows all of them; fills `object`.
  UnlinkTables(const ir::Image& image, const PlaceFinder& finder, ir::Object& object)
      : image_(image), finder_(finder), object_(object) {}

  Wanted scalar(ir::Class cls) const;
  Wanted region(ir::Region region) const;
  Wanted string(ir::Class cls, uint32_t capacity) const;
  Wanted slot_of(ir::Opcode op) const;  // of an in-out or an instance
  static Wanted anything() { return {PlaceFinder::anything, "*", {}, Wanted::kNoBytes, true}; }

  // Numbers of entries.
  uint32_t find(ir::ObjectPlace& place, ir::Region root, uint32_t offset, const Wanted& wanted);
  uint32_t fixed_place(uint32_t offset);
  uint32_t slot_place(uint32_t slot, ir::Region result);
  uint32_t constant(uint32_t offset, uint32_t size, ir::Class cls);
  // A string, or a value whose bytes lie as its type says.
  uint32_t laid_out_constant(uint32_t offset, const Wanted& wanted);
  uint32_t region_number(ir::Region region);
  // The type is gone; one of that size is as good while nothing has another size.
  uint32_t size_number(uint32_t size);
  uint32_t bound(uint32_t number);
  uint32_t range(uint32_t number);
  uint32_t callee(uint32_t number);
  uint32_t argument(const ir::Slot& slot);

  // Something that the image does not tell.
  void fail(const std::string& what);
  const std::optional<base::Error>& error() const { return error_; }

 private:
  template <class T>
  uint32_t intern(char table, std::initializer_list<uint32_t> parts, std::vector<T>& entries,
                  const T& entry);

  const ir::Image& image_;
  const PlaceFinder& finder_;
  ir::Object& object_;
  base::ByteTable numbers_;
  std::optional<base::Error> error_;
};

}  // namespace linker
