// Numbers that an object uses -> offsets, numbers and indices of the image.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/frame.h"
#include "linker/pool.h"

namespace linker {

// What relocation needs of the whole program.
struct LinkContext {
  const ir::Program& program;
  ir::Image& image;  // types, layouts, instances and tables are set
  const ConstantPool& pool;
  std::unordered_map<std::string, uint32_t> pou_numbers;    // by folded name
  std::vector<const ir::Object*> objects;                   // by POU number
  std::vector<std::vector<uint64_t>> parameter_offsets;     // by POU number, then slot
  std::unordered_map<std::string, uint32_t> table_numbers;  // of bounds and ranges
};

// The digest of an object, as it is known.
base::Digest known_identity(const ir::Object& object, const ir::Program& program,
                            const ir::PouNames& names);

// Numbers of one object, each looked up once, however often its code names them.
class Numbers {
 public:
  Numbers(const LinkContext& context, const ir::Object& object, const FrameLayout& frame);

  uint32_t pou_number(uint32_t callee) const { return callees_[callee]; }
  uint64_t offset_of_place(uint32_t number) const { return places_[number]; }
  uint64_t near_offset(ir::Base base, uint32_t number) const;
  uint32_t wide_offset(ir::Base base, uint32_t number) const;
  uint32_t range_number(uint32_t number) const { return ranges_[number]; }
  // The value of a field x or y; `base` is that of the instruction's BASE field.
  uint32_t extension_field(const ir::Field& field, uint32_t number, ir::Base base) const;

 private:
  uint64_t slot_offset(uint32_t number) const;
  uint64_t find_place(const ir::ObjectPlace& place) const;
  uint32_t size_of(ir::TypeId type) const;

  const LinkContext& context_;
  const ir::Object& object_;
  const FrameLayout& frame_;
  const std::vector<uint32_t>& constants_;  // offsets
  std::vector<uint32_t> callees_;
  std::vector<uint64_t> places_;
  std::vector<uint32_t> bounds_;
  std::vector<uint32_t> ranges_;
};

}  // namespace linker
