// Linked code as text for `stc dump`: one line per instruction, operands as
// base[offset] with the name of the slot or member where there is one.
#include <algorithm>

#include "base/limits.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/regions.h"
#include "ir/program/ir.h"
#include "stdlib/native/natives.h"

namespace ir {
namespace {

constexpr const char* kTrapNames[] = {
#define TRAP(id, text, title, help) text,
#include "ir/program/traps.def"
#undef TRAP
};

class ImageDisassembler {
 public:
  ImageDisassembler(const Image& image, const LinkedPou& pou) : image_(image), pou_(pou) {}

  std::string text() {
    std::string out = pou_.name + ": frame " + std::to_string(pou_.frame_size) + " bytes\n";
    size_t line = 0;
    size_t merge = 0;
    for (uint32_t unit = 0; unit < pou_.unit_count;) {
      for (; line < pou_.lines.size() && pou_.lines[line].unit <= unit; ++line) {
        out += "; line " + std::to_string(pou_.lines[line].line) + "\n";
      }
      for (; merge < pou_.merges.size() && pou_.merges[merge].unit <= unit; ++merge) {
        out += merge_text(pou_.merges[merge]);
      }
      out += instruction(unit);
    }
    return out;
  }

 private:
  const Unit& at(uint32_t unit) const { return image_.code[pou_.first_unit + unit]; }

  std::string merge_text(const Merge& merge) const {
    std::string out = "L" + std::to_string(merge.unit) + ":";
    for (uint16_t slot : merge.slots) out += " " + slot_name(slot);
    return out + "\n";
  }

  std::string slot_name(uint32_t slot) const {
    if (slot >= pou_.slots.size()) return "?";
    const FrameSlot& s = pou_.slots[slot];
    return s.name.empty() ? "f" + std::to_string(s.offset) : s.name;
  }

  std::string instruction(uint32_t& unit) const {
    const uint32_t here = unit++;
    const Unit& u = at(here);
    std::string out = std::to_string(here);
    out.resize(std::max<size_t>(out.size() + 1, 6), ' ');
    if (u.opcode_number() >= kOpcodeCount) return out + "?\n";
    const OpcodeRow& row = opcode_row(u.opcode());
    out += row.name;
    out.resize(std::max<size_t>(out.size(), 22), ' ');
    Unit extension;
    if (row.extended && unit < pou_.unit_count) extension = at(unit++);
    append(out, field(row.a, u.base_a(), u.a, u, unit));
    append(out, field(row.b, u.base_b(), u.b, u, unit));
    append(out, field(row.c, u.base_c(), u.c, u, unit));
    if (row.extended) {
      append(out, field(row.x, place_base(row, u), extension.x(), u, unit));
      append(out, field(row.y, place_base(row, u), extension.y(), u, unit));
    }
    return out + "\n";
  }

  static Base place_base(const OpcodeRow& row, const Unit& u) {
    return row.b.kind == FieldKind::kBase ? u.base_b() : u.base_c();
  }

  static void append(std::string& out, const std::string& text) {
    if (!text.empty()) out += " " + text;
  }

  std::string field(const Field& f, Base base, uint32_t value, const Unit& u, uint32_t next) const {
    switch (f.kind) {
      case FieldKind::kNone:
      case FieldKind::kBase:
        return "";
      case FieldKind::kBc32:
        return place(u.base_b(), u.bc());
      case FieldKind::kRel32:
        return "-> " + std::to_string(next + u.bc());
      case FieldKind::kPlace32:
        return place(base, value);
      case FieldKind::kOffset16:
      case FieldKind::kOffset32:
        return "+" + std::to_string(value);
      case FieldKind::kFrameSize:
        return "frame+" + std::to_string(value * 8);
      case FieldKind::kCode:
        return value < image_.pous.size() ? image_.pous[value].name : "?";
      case FieldKind::kNative:
        return value < stdlib::native_count() ? std::string(stdlib::native_row(value).name) : "?";
      case FieldKind::kTrap:
        return value < kTrapCount ? kTrapNames[value] : "?";
      case FieldKind::kRange:
        return range(value);
      case FieldKind::kBounds:
        return bound(value);
      case FieldKind::kType:
        return image_.types.text(region_of_field(value).type);
      case FieldKind::kSize:
        return std::to_string(value);
      case FieldKind::kNumber:
        return std::to_string(static_cast<int32_t>(value));
      case FieldKind::kCapacity:
        return "cap " + std::to_string(value);
      default:
        return place(base, value);
    }
  }

  std::string range(uint32_t number) const {
    if (number >= image_.ranges.size()) return "?";
    const Range& r = image_.ranges[number];
    return std::to_string(r.low) + ".." + std::to_string(r.high);
  }

  std::string bound(uint32_t number) const {
    if (number >= image_.bounds.size()) return "?";
    const LinkedBound& b = image_.bounds[number];
    return b.name + "[" + std::to_string(b.low) + "..+" + std::to_string(b.count) + " by " +
           std::to_string(b.stride) + "]";
  }

  std::string place(Base base, uint32_t offset) const {
    if (base == Base::kFrame) return frame_place(offset);
    static constexpr const char* kBases[] = {"frame", "self", "global", "const"};
    return std::string(kBases[static_cast<uint32_t>(base)]) + "[" + std::to_string(offset) + "]";
  }

  std::string frame_place(uint32_t offset) const {
    if (offset >= pou_.frame_size) return "next[" + std::to_string(offset - pou_.frame_size) + "]";
    for (uint32_t i = 0; i < pou_.slots.size(); ++i) {
      if (pou_.slots[i].offset == offset) return slot_name(i);
    }
    return "frame[" + std::to_string(offset) + "]";
  }

  const Image& image_;
  const LinkedPou& pou_;
};

}  // namespace

std::string disassemble(const Image& image, const LinkedPou& pou) {
  return ImageDisassembler(image, pou).text();
}

}  // namespace ir
