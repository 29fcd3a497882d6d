// Objects as text for `stc dump --object` and tests: one instruction per line,
// operands by name: `AND_B f0, s:a, s:b`.
#include "ir/bytecode/object.h"

namespace ir {
namespace {

class ObjectDisassembler {
 public:
  ObjectDisassembler(const Object& object, const Program& program)
      : object_(object), program_(program), types_(program.types) {}

  std::string text() {
    std::string out = object_.name + ":\n";
    size_t merge = 0;
    size_t line = 0;
    for (uint32_t at = 0; at < object_.code.size();) {
      for (; line < object_.lines.size() && object_.lines[line].unit == at; ++line) {
        out += "; line " + std::to_string(object_.lines[line].line) + "\n";
      }
      for (; merge < object_.merges.size() && object_.merges[merge].unit == at; ++merge) {
        out += merge_text(object_.merges[merge]);
      }
      const OpcodeRow& row = opcode_row(object_.code[at].opcode());
      out += "  " + std::to_string(at) + ": " + inst_text(at, row) + "\n";
      at += row.extended ? 2 : 1;
    }
    return out;
  }

 private:
  std::string merge_text(const Merge& merge) const {
    std::string out = "@" + std::to_string(merge.unit) + " has";
    for (uint16_t slot : merge.slots) out += " " + slot_text(slot);
    return out + "\n";
  }

  std::string slot_text(uint32_t number) const {
    const Slot& slot = object_.slots[number];
    switch (slot.kind) {
      case SlotKind::kParam:
      case SlotKind::kLocal:
        return "f:" + slot.name;
      case SlotKind::kTemp:
        return "f" + std::to_string(number);
      case SlotKind::kArg:
        return "arg:" + object_.callees[slot.callee] + "." + std::to_string(slot.param);
      case SlotKind::kNativeArg:
        return "narg" + std::to_string(slot.param);
    }
    return "?";
  }

  std::string steps_text(const ObjectPlace& place, Region at) const {
    std::string out;
    for (const Step& step : place.steps) {
      if (step.kind == StepKind::kMember) {
        const Member& member = types_[at.type].members[step.index];
        out += (out.empty() ? "" : ".") + member.name;
        at = {member.type, 0};
        continue;
      }
      out += "[" + std::to_string(step.constant_index) + "]";
      const Type& array = types_[at.type];
      ++at.dim;
      if (at.dim == array.dims.size() && !types_.is_instance(array.base)) at = {array.base, 0};
    }
    return out;
  }

  std::string place_text(uint32_t number) const {
    const ObjectPlace& place = object_.places[number];
    switch (place.root) {
      case PlaceRoot::kSelf:
        return "s:" + steps_text(place, {object_.self, 0});
      case PlaceRoot::kGlobal:
        return "g:" + steps_text(place, {program_.globals, 0});
      case PlaceRoot::kSlot: {
        const std::string steps = steps_text(place, object_.slots[place.slot].region);
        return slot_text(place.slot) + (steps.empty() || steps[0] == '[' ? "" : ".") + steps;
      }
      case PlaceRoot::kRegion:
        return "+" + steps_text(place, place.region);
      case PlaceRoot::kFixed:
        return "+" + std::to_string(place.slot);
    }
    return "?";
  }

  std::string constant_text(uint32_t number) const {
    const ObjectConstant& constant = object_.constants[number];
    if (constant.type.valid()) return "c:" + types_.text(constant.type);
    uint64_t bits = 0;
    for (size_t i = 0; i < constant.bytes.size(); ++i) {
      bits |= uint64_t{constant.bytes[i]} << (8 * i);
    }
    return "#" + std::to_string(bits);
  }

  std::string near_text(Base base, uint32_t number) const {
    if (base == Base::kConst) return constant_text(number);
    if (base != Base::kFrame) return place_text(number);
    const auto slots = static_cast<uint32_t>(object_.slots.size());
    return number < slots ? slot_text(number) : place_text(number - slots);
  }

  std::string wide_text(Base base, uint32_t number) const {
    return base == Base::kConst ? constant_text(number) : place_text(number);
  }

  std::string field_text(const Field& field, Base base, uint16_t value) const {
    if (field.is_near()) return near_text(base, value);
    switch (field.kind) {
      case FieldKind::kOffset16:
        return place_text(value);
      case FieldKind::kCode:
        return object_.callees[value];
      case FieldKind::kRange:
        return range_text(value);
      case FieldKind::kNative:
        return "native " + std::to_string(value);
      case FieldKind::kTrap:
        return std::to_string(value);
      default:
        return "";
    }
  }

  std::string range_text(uint32_t number) const {
    const Range& range = object_.ranges[number];
    return std::to_string(range.low) + ".." + std::to_string(range.high);
  }

  std::string extension_text(const Field& field, Base base, uint32_t value) const {
    switch (field.kind) {
      case FieldKind::kPlace32:
        return wide_text(base, value);
      case FieldKind::kOffset32:
        return place_text(value);
      case FieldKind::kSize:
        return "size of " + types_.text(object_.regions[value].type);
      case FieldKind::kType:
        return types_.text(object_.regions[value].type);
      case FieldKind::kBounds:
        return "bounds of " + object_.bounds[value].name + " dim " +
               std::to_string(object_.bounds[value].dim);
      case FieldKind::kNumber:
        return std::to_string(static_cast<int32_t>(value));
      case FieldKind::kCapacity:
        return "capacity " + std::to_string(value);
      default:
        return "";
    }
  }

  static void join(std::string& out, const std::string& part) {
    if (part.empty()) return;
    out += out.empty() ? " " : ", ";
    out += part;
  }

  std::string inst_text(uint32_t at, const OpcodeRow& row) const {
    const Unit& unit = object_.code[at];
    std::string operands;
    join(operands, field_text(row.a, unit.base_a(), unit.a));
    if (row.b.kind == FieldKind::kBc32) {
      join(operands, wide_text(unit.base_b(), unit.bc()));
    } else if (row.b.kind == FieldKind::kRel32) {
      const int64_t target = int64_t{at} + 1 + static_cast<int32_t>(unit.bc());
      join(operands, "-> " + std::to_string(target));
    } else {
      join(operands, field_text(row.b, unit.base_b(), unit.b));
      join(operands, field_text(row.c, unit.base_c(), unit.c));
    }
    if (row.extended) {
      const Unit& extension = object_.code[at + 1];
      const Base base = row.c.kind == FieldKind::kBase ? unit.base_c() : unit.base_b();
      join(operands, extension_text(row.x, base, extension.x()));
      join(operands, extension_text(row.y, base, extension.y()));
    }
    return std::string(row.name) + operands;
  }

  const Object& object_;
  const Program& program_;
  const TypeTable& types_;
};

}  // namespace

std::string disassemble(const Object& object, const Program& program) {
  return ObjectDisassembler(object, program).text();
}

}  // namespace ir
