// Traps in words: what, which variable, which values, where in the source.
#include <algorithm>

#include "ir/types/handle.h"
#include "ir/types/inside.h"
#include "ir/types/value_text.h"
#include "vm/exec/execution.h"

namespace vm {
namespace {

constexpr const char* kTitles[] = {
#define TRAP(id, text, title, help) title,
#include "ir/program/traps.def"
#undef TRAP
};

// An index or checked value as the instruction that trapped saw it.
std::string number(std::string_view opcode, int64_t value) {
  const bool is_unsigned = opcode.ends_with("_U64");
  return is_unsigned ? std::to_string(static_cast<uint64_t>(value)) : std::to_string(value);
}

std::string index_text(const ir::Image& image, const Trap& trap, std::string_view opcode) {
  const auto bound = static_cast<uint64_t>(trap.operand[1]);
  if (bound >= image.bounds.size()) return "";
  const ir::LinkedBound& b = image.bounds[bound];
  const auto high = static_cast<int64_t>(static_cast<uint64_t>(b.low) + b.count - 1);
  return ": " + b.name + "[" + number(opcode, trap.operand[0]) + "], bounds " +
         std::to_string(b.low) + ".." + std::to_string(high);
}

std::string range_text(const ir::Image& image, const Trap& trap, std::string_view opcode) {
  const auto range = static_cast<uint64_t>(trap.operand[1]);
  if (range >= image.ranges.size()) return "";
  const ir::Range& r = image.ranges[range];
  return ": " + (r.name.empty() ? std::string() : r.name + " = ") +
         number(opcode, trap.operand[0]) + ", range " + std::to_string(r.low) + ".." +
         std::to_string(r.high);
}

// What it is. A reference that has left its variable is bound, which the title denies. Locals that
// were exposed are gone when this is asked.
std::string title_of(const ir::Image& image, const Trap& trap) {
  const bool left = trap.kind == ir::TrapKind::kReference && trap.operand[1] != 0;
  if (!left) return kTitles[static_cast<size_t>(trap.kind)];
  const auto handle = static_cast<uint64_t>(trap.operand[0]);
  const uint32_t id = ir::segment_id(ir::handle_segment(handle));
  const bool area = id < image.instances.size() && image.instances[id].live;
  const ir::TypeId type = area ? image.instances[id].type : ir::TypeId();
  return ir::left_text(image.types, image.layouts, type, handle);
}

std::string operand_text(const ir::Image& image, const Trap& trap, std::string_view opcode) {
  switch (trap.kind) {
    case ir::TrapKind::kIndex:
      return index_text(image, trap, opcode);
    case ir::TrapKind::kSubrange:
      return range_text(image, trap, opcode);
    case ir::TrapKind::kConversion:
      if (opcode == "TRAP") return "";  // behind a comparison, which has the value
      return ": " + ir::scalar_text(image.types, image.types.elementary(ir::Kind::kLreal),
                                    static_cast<uint64_t>(trap.operand[0]));
    default:
      return "";
  }
}

}  // namespace

uint32_t line_of(const ir::LinkedPou& pou, uint32_t unit) {
  const auto behind =
      std::upper_bound(pou.lines.begin(), pou.lines.end(), unit,
                       [](uint32_t at, const ir::LineEntry& line) { return at < line.unit; });
  return behind == pou.lines.begin() ? 0 : (behind - 1)->line;
}

TrapText describe(const ir::Image& image, const Trap& trap) {
  TrapText text;
  text.text = title_of(image, trap);
  if (trap.pou >= image.pous.size()) return text;
  const ir::LinkedPou& pou = image.pous[trap.pou];
  text.pou = pou.name;
  text.file = pou.file;
  text.line = line_of(pou, trap.unit);
  if (trap.unit >= pou.unit_count) return text;
  const ir::Unit& unit = image.code[pou.first_unit + trap.unit];
  if (unit.opcode_number() < ir::kOpcodeCount) {
    text.text += operand_text(image, trap, ir::opcode_row(unit.opcode()).name);
  }
  return text;
}

}  // namespace vm
