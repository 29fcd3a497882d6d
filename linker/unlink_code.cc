#include "linker/unlink_code.h"

#include <algorithm>
#include <string>

#include "linker/next_frame.h"
#include "linker/unlink_tables.h"

namespace linker {
namespace {

using ir::Base;
using ir::Class;
using ir::Field;
using ir::FieldKind;
using ir::Opcode;
using ir::OpcodeRow;
using ir::Region;
using ir::Unit;

constexpr uint32_t kNowhere = 0xffffffffu;
constexpr uint32_t kNativeSlotBytes = 8;

class CodeUnlinker {
 public:
  CodeUnlinker(const ir::Image& image, const PlaceFinder& finder, uint32_t number)
      : image_(image),
        pou_(image.pous[number]),
        code_(image.code.data() + pou_.first_unit, pou_.unit_count),
        next_frame_(code_),
        tables_(image, finder, object_) {
    object_.name = pou_.name;
    object_.kind = pou_.kind;
    object_.self = pou_.self;
    object_.recursion_depth = pou_.recursion_depth;
    object_.file = pou_.file;
    object_.known_as = pou_.identity;
    if (!image.contents.empty()) object_.content.identity = image.contents[number].identity;
    const auto first =
        std::lower_bound(image.held.begin(), image.held.end(), number,
                         [](const ir::HeldPart& row, uint32_t pou) { return row.pou < pou; });
    for (auto row = first; row != image.held.end() && row->pou == number; ++row) {
      object_.held.push_back(row->what);
    }
    object_.merges = pou_.merges.all();
    // Lines are for people; nobody has checked that their code is there.
    for (const ir::LineEntry& line : pou_.lines) {
      if (line.unit <= pou_.unit_count) object_.lines.push_back(line);
    }
    for (const ir::FrameSlot& slot : pou_.slots) {
      ir::Slot own;
      own.kind = slot.kind;
      own.local = slot.local;
      own.aggregate = slot.aggregate;
      own.cls = slot.cls;
      own.region = slot.region;
      own.name = slot.name;
      object_.slots.push_back(std::move(own));
    }
  }

  base::Result<ir::Object> run() {
    object_.code.assign(code_.begin(), code_.end());
    for (uint32_t i = 0; i < code_.size() && !tables_.error();) {
      next_frame_.enter(i);
      unlink(i);
      next_frame_.leave(i);
      i += ir::opcode_row(code_[i].opcode()).extended ? 2 : 1;
    }
    if (tables_.error()) return *tables_.error();
    // Places are numbered after the slots, of which there are more now.
    for (const PlaceField& field : place_fields_) put(field);
    if (tables_.error()) return *tables_.error();
    return std::move(object_);
  }

 private:
  // A near operand that names a place of the frame.
  struct PlaceField {
    uint32_t unit = 0;
    uint8_t position = 0;
    uint32_t place = 0;
  };

  void put(const PlaceField& field) {
    const uint64_t number = object_.slots.size() + field.place;
    if (number > 0xffff) return tables_.fail("more than 65,535 places of its frame");
    Unit& unit = object_.code[field.unit];
    uint16_t* const fields[] = {&unit.a, &unit.b, &unit.c};
    *fields[field.position] = static_cast<uint16_t>(number);
  }

  void unlink(uint32_t at) {
    Unit& unit = object_.code[at];
    const OpcodeRow& row = ir::opcode_row(unit.opcode());
    const Base bases[] = {unit.base_a(), unit.base_b(), unit.base_c()};
    const Field* const kinds[] = {&row.a, &row.b, &row.c};
    uint16_t* const fields[] = {&unit.a, &unit.b, &unit.c};
    // Reads come before writes: an argument that is changed was put there before.
    for (const bool writes : {false, true}) {
      for (uint8_t i = 0; i < 3; ++i) {
        if (!kinds[i]->is_near() || kinds[i]->writes() != writes) continue;
        near({at, i, 0}, *kinds[i], bases[i], *fields[i]);
      }
    }
    if (row.a.kind == FieldKind::kFrameSize) unit.a = 0;
    if (row.c.kind == FieldKind::kCode) unit.c = narrow(tables_.callee(unit.c));
    if (row.c.kind == FieldKind::kRange) unit.c = narrow(tables_.range(unit.c));
    if (row.c.kind == FieldKind::kOffset16) offset16(at, row, unit);
    if (row.b.kind == FieldKind::kBc32) unit.set_bc(wide(row, bases[1], unit.bc()));
    if (row.extended) extension(at, row);
  }

  uint16_t narrow(uint32_t number) {
    if (number > 0xffff) tables_.fail("more than 65,535 things of one kind");
    return static_cast<uint16_t>(number);
  }

  // --- operands ---------------------------------------------------------------

  void near(PlaceField field, const Field& kind, Base base, uint16_t& value) {
    if (base == Base::kConst) {
      value = narrow(tables_.constant(value, ir::class_size(kind.cls), kind.cls));
    } else if (base != Base::kFrame) {
      value = narrow(place_at(base, value, tables_.scalar(kind.cls)));
    } else if (value >= pou_.frame_size) {
      argument(field, kind, value - pou_.frame_size, value);
    } else {
      frame_operand(field, kind, value);
    }
  }

  void frame_operand(PlaceField field, const Field& kind, uint16_t& value) {
    const uint32_t slot = slot_at(pou_, value);
    if (slot == kNowhere) return tables_.fail("byte " + std::to_string(value) + " of its frame");
    const ir::FrameSlot& there = pou_.slots[slot];
    if (!there.aggregate) {
      value = narrow(slot);
      return;
    }
    field.place = place_in(slot, there.region, value - there.offset, tables_.scalar(kind.cls));
    place_fields_.push_back(field);
  }

  // A scalar of the next frame.
  void argument(PlaceField field, const Field& kind, uint32_t offset, uint16_t& value) {
    const std::optional<CallOf> call =
        kind.writes() ? next_frame_.write(offset) : next_frame_.read(offset);
    const std::optional<uint32_t> slot = call ? argument_slot(*call, offset, kind.cls) : kNowhere;
    if (!call || *slot == kNowhere)
      return tables_.fail("a value of the next frame that no call has");
    const ir::Slot& there = object_.slots[*slot];
    if (!there.aggregate) {
      value = narrow(*slot);
      return;
    }
    const uint32_t begin = parameter(*call, offset)->offset;
    field.place = place_in(*slot, there.region, offset - begin, tables_.scalar(kind.cls));
    place_fields_.push_back(field);
  }

  uint32_t far_argument(const OpcodeRow& row, uint32_t offset) {
    const bool stores = row.a.reads();
    const std::optional<CallOf> call =
        stores ? next_frame_.write(offset) : next_frame_.read(offset);
    const uint32_t slot = call ? argument_slot(*call, offset, row.a.cls) : kNowhere;
    if (slot == kNowhere) {
      tables_.fail("a value of the next frame that no call has");
      return 0;
    }
    const ir::FrameSlot* const there = parameter(*call, offset);
    const uint32_t begin = there == nullptr ? offset : there->offset;
    return place_in(slot, object_.slots[slot].region, offset - begin, tables_.scalar(row.a.cls));
  }

  // The object's slot for what lies at `offset` of the arguments and results of that call.
  uint32_t argument_slot(const CallOf& call, uint32_t offset, Class cls) {
    ir::Slot slot;
    slot.cls = cls;
    if (call.native) {
      slot.kind = ir::SlotKind::kNativeArg;
      slot.param = offset / kNativeSlotBytes;
      return tables_.argument(slot);
    }
    const ir::FrameSlot* const there = parameter(call, offset);
    if (there == nullptr) return kNowhere;
    slot.kind = ir::SlotKind::kArg;
    slot.callee = tables_.callee(call.number);
    slot.param = static_cast<uint32_t>(there - image_.pous[call.number].slots.data());
    slot.cls = there->cls;
    slot.aggregate = there->aggregate;
    slot.region = there->region;
    return tables_.argument(slot);
  }

  const ir::FrameSlot* parameter(const CallOf& call, uint32_t offset) const {
    if (call.native || call.number >= image_.pous.size()) return nullptr;
    const ir::LinkedPou& callee = image_.pous[call.number];
    const uint32_t slot = slot_at(callee, offset);
    if (slot == kNowhere || callee.slots[slot].kind != ir::SlotKind::kParam) return nullptr;
    return &callee.slots[slot];
  }

  static uint32_t slot_at(const ir::LinkedPou& pou, uint32_t offset) {
    const auto after =
        std::upper_bound(pou.slots.begin(), pou.slots.end(), offset,
                         [](uint32_t at, const ir::FrameSlot& slot) { return at < slot.offset; });
    if (after == pou.slots.begin()) return kNowhere;
    return static_cast<uint32_t>(after - pou.slots.begin() - 1);
  }

  // Behind an address: `c` of the unit.
  void offset16(uint32_t at, const OpcodeRow& row, Unit& unit) {
    const bool stores = row.a.cls == Class::kA && row.a.kind == FieldKind::kFrameRead;
    const uint16_t address = stores ? code_[at].a : code_[at].b;
    const Field& value = stores ? row.b : row.a;
    const bool slot = value.cls == Class::kA || value.kind == FieldKind::kFrameSize;
    Wanted wanted = slot || unit.opcode() == Opcode::HANDLE_INST_AT ? tables_.slot_of(unit.opcode())
                                                                    : tables_.scalar(value.cls);
    unit.c = narrow(place_after(address, unit.c, wanted));
  }

  uint32_t wide(const OpcodeRow& row, Base base, uint32_t offset) {
    const bool value = row.a.is_near() && row.a.cls != Class::kA &&
                       row.name.find("FAR_") != std::string_view::npos;
    if (value && base == Base::kConst) {
      return tables_.constant(offset, ir::class_size(row.a.cls), row.a.cls);
    }
    if (value && base == Base::kFrame && offset >= pou_.frame_size) {
      return far_argument(row, offset - pou_.frame_size);
    }
    return place_at(
        base, offset,
        value ? tables_.scalar(row.a.cls) : tables_.slot_of(ir::opcode_from_name(row.name)));
  }

  void extension(uint32_t at, const OpcodeRow& row) {
    const Unit& old = code_[at + 1];
    const Base base = row.c.kind == FieldKind::kBase ? code_[at].base_c() : code_[at].base_b();
    const Wanted wanted = wanted_of(row, old);
    const uint32_t x = field(at, row, row.x, old.x(), base, wanted);
    const uint32_t y = field(at, row, row.y, old.y(), base, wanted);
    object_.code[at + 1] = Unit::extension(x, y);
  }

  // What the offset of an extended instruction leads to: its other field says.
  Wanted wanted_of(const OpcodeRow& row, const Unit& extension) const {
    if (row.x.kind == FieldKind::kBounds) return tables_.region(image_.bounds[extension.x()].from);
    if (row.y.kind == FieldKind::kType) return tables_.region(ir::region_of_field(extension.y()));
    if (row.y.kind == FieldKind::kCapacity) return tables_.string(row.a.cls, extension.y());
    return tables_.anything();
  }

  uint32_t field(uint32_t at, const OpcodeRow& row, const Field& kind, uint32_t value, Base base,
                 const Wanted& wanted) {
    switch (kind.kind) {
      case FieldKind::kPlace32:
        if (base == Base::kFrame && value >= pou_.frame_size) return pointed(at, value, wanted);
        if (base == Base::kConst) return tables_.laid_out_constant(value, wanted);
        return place_at(base, value, wanted);
      case FieldKind::kOffset32:
        if (row.b.cls == Class::kA && row.b.is_near()) {
          return place_after(code_[at].b, value, wanted);
        }
        if (row.c.cls == Class::kA && row.c.is_near()) {
          return place_after(code_[at].c, value, wanted);
        }
        return tables_.fixed_place(value);
      case FieldKind::kBounds:
        return tables_.bound(value);
      case FieldKind::kType:
        return tables_.region_number(ir::region_of_field(value));
      case FieldKind::kCode:
        return tables_.callee(value);
      case FieldKind::kSize:
        return tables_.size_number(value);
      default:
        return value;
    }
  }

  // --- places -----------------------------------------------------------------

  uint32_t place_at(Base base, uint32_t offset, const Wanted& wanted) {
    ir::ObjectPlace place;
    if (base == Base::kFrame) {
      const uint32_t slot = slot_at(pou_, offset);
      if (slot == kNowhere) {
        tables_.fail("byte " + std::to_string(offset) + " of its frame");
        return 0;
      }
      return place_in(slot, pou_.slots[slot].region, offset - pou_.slots[slot].offset, wanted);
    }
    place.root = base == Base::kSelf ? ir::PlaceRoot::kSelf : ir::PlaceRoot::kGlobal;
    const bool self = base == Base::kSelf;
    if (!self) offset -= image_.instances.all()[0].data;
    return tables_.find(place, {self ? pou_.self : image_.globals, 0}, offset, wanted);
  }

  uint32_t place_in(uint32_t slot, Region region, uint32_t offset, const Wanted& wanted) {
    ir::ObjectPlace place;
    place.root = ir::PlaceRoot::kSlot;
    place.slot = slot;
    if (offset == 0 && !object_.slots[slot].aggregate) {
      return tables_.slot_place(slot, wanted.constant.type.valid() ? wanted.constant : region);
    }
    return tables_.find(place, region, offset, wanted);
  }

  // Behind the address in frame slot `address`.
  uint32_t place_after(uint16_t address, uint32_t offset, const Wanted& wanted) {
    const uint32_t slot = slot_at(pou_, address);
    if (slot == kNowhere) {
      tables_.fail("an address at byte " + std::to_string(address) + " of its frame");
      return 0;
    }
    ir::ObjectPlace place;
    place.root = ir::PlaceRoot::kRegion;
    place.region = pou_.slots[slot].region;
    return tables_.find(place, place.region, offset, wanted);
  }

  // A pointer to an argument or a result that is no scalar.
  uint32_t pointed(uint32_t at, uint32_t offset, const Wanted& wanted) {
    offset -= pou_.frame_size;
    const std::optional<CallOf> call = next_frame_.point(offset, code_[at].a);
    const ir::FrameSlot* const there = call ? parameter(*call, offset) : nullptr;
    if (there == nullptr) {
      tables_.fail("a place of the next frame that no call has");
      return 0;
    }
    const uint32_t slot = argument_slot(*call, offset, there->cls);
    return place_in(slot, there->region, offset - there->offset, wanted);
  }

  const ir::Image& image_;
  const ir::LinkedPou& pou_;
  std::span<const Unit> code_;
  NextFrame next_frame_;
  ir::Object object_;
  std::vector<PlaceField> place_fields_;
  UnlinkTables tables_;
};

}  // namespace

base::Result<ir::Object> unlink_code(const ir::Image& image, const PlaceFinder& finder,
                                     uint32_t pou) {
  return CodeUnlinker(image, finder, pou).run();
}

}  // namespace linker
