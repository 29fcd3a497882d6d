#include "vm/load/generation.h"

#include <cstring>

#include "ir/bytecode/regions.h"
#include "vm/exec/handler_numbers.h"

namespace vm {
namespace {

// Handler numbers into the op fields; the bytes of a COPY in the place of its type.
void prepare_code(const ir::Image& image, const ir::LinkedPou& pou, ir::Unit* code) {
  for (uint32_t i = 0; i < pou.unit_count; ++i) {
    ir::Unit& unit = code[i];
    const ir::Opcode op = unit.opcode();
    unit.op =
        static_cast<uint16_t>(handler_number(op, unit.base_a(), unit.base_b(), unit.base_c()));
    if (!ir::opcode_row(op).extended) continue;
    ir::Unit& extension = code[++i];
    if (op != ir::Opcode::COPY) continue;
    const ir::Region region = ir::region_of_field(extension.x());
    extension = ir::Unit::extension(ir::region_size(image.types, image.layouts, region), 0);
  }
}

}  // namespace

uint32_t Generation::pool_offset() const {
  return number_ % 2 == 0 ? ir::kConstPoolA : ir::kConstPoolB;
}

std::unique_ptr<Generation> Generation::build(ir::VerifiedImage verified, uint32_t number,
                                              uint8_t* memory) {
  auto made = std::unique_ptr<Generation>(new Generation(std::move(verified)));
  const ir::Image& image = made->image();
  made->number_ = number;
  made->code_ = image.code;
  for (const ir::LinkedPou& pou : image.pous) {
    ir::Unit* const first = made->code_.data() + pou.first_unit;
    prepare_code(image, pou, first);
    made->pous_.push_back({first, pou.frame_size});
  }
  for (const ir::Instance& row : image.instances) {
    const bool callable = row.live && row.type != image.globals;
    made->instances_.push_back(callable ? InstanceEntry{row.data, row.pou} : InstanceEntry{});
  }
  for (const ir::LinkedBound& bound : image.bounds) {
    made->bounds_.push_back({bound.low, bound.count, bound.stride});
  }
  for (const ir::Range& range : image.ranges) made->ranges_.push_back({range.low, range.high});
  if (!image.pool.empty()) {
    std::memcpy(memory + made->pool_offset(), image.pool.data(), image.pool.size());
  }
  return made;
}

}  // namespace vm
