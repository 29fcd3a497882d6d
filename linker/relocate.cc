#include "linker/relocate.h"

#include <algorithm>

#include "base/visible_text.h"

namespace linker {
namespace {

using ir::Base;
using ir::Class;
using ir::Field;
using ir::FieldKind;
using ir::Opcode;
using ir::OpcodeRow;
using ir::Unit;

constexpr uint64_t kNearLimit = 0xffff;

Opcode far_opcode(const char* stem, Class cls) {
  return ir::opcode_from_name(stem + std::string(ir::class_name(cls)));
}
bool exists(Opcode op) { return static_cast<uint32_t>(op) < ir::kOpcodeCount; }

// One pass over an object's code with a given set of scratch slots. When it needs
// more of them, `missing` says which, and the pass is repeated.
class Pass {
 public:
  Pass(const LinkContext& context, const ir::Object& object, const FrameLayout& frame,
       const std::vector<Scratch>& scratch)
      : context_(context),
        object_(object),
        frame_(frame),
        scratch_(scratch),
        numbers_(context, object, frame) {}

  void run() {
    starts_.resize(object_.code.size() + 1);
    code_.reserve(object_.code.size());
    for (uint32_t i = 0; i < object_.code.size() && !error_;) {
      starts_[i] = static_cast<uint32_t>(code_.size());
      i += link_inst(i);
    }
    starts_[object_.code.size()] = static_cast<uint32_t>(code_.size());
    if (error_ || !missing_.empty()) return;
    for (const Jump& jump : jumps_) {
      const int64_t target = starts_[jump.target];
      code_[jump.at].set_bc(static_cast<uint32_t>(target - (int64_t{jump.at} + 1)));
    }
  }

  const std::optional<base::Error>& error() const { return error_; }
  const std::vector<Scratch>& missing() const { return missing_; }
  std::vector<Unit> take_code() { return std::move(code_); }
  uint32_t start_of(uint32_t unit) const { return starts_[unit]; }

 private:
  struct Jump {
    uint32_t at;      // in the new code
    uint32_t target;  // in the object
  };

  void fail(std::string text) {
    if (!error_) {
      error_ = base::Error{base::Refusal::kTooMany, "`" + object_.name + "`: " + std::move(text)};
    }
  }

  uint16_t link_range(uint32_t number) {
    const uint32_t linked = numbers_.range_number(number);
    if (linked > kNearLimit) fail("more than 65,536 different subranges in the program");
    return static_cast<uint16_t>(linked);
  }

  uint32_t link_inst(uint32_t at) {
    const Unit& unit = object_.code[at];
    const OpcodeRow& row = ir::opcode_row(unit.opcode());
    before_.clear();
    after_.clear();
    Base bases[3] = {unit.base_a(), unit.base_b(), unit.base_c()};
    uint16_t fields[3] = {unit.a, unit.b, unit.c};
    const Field* kinds[3] = {&row.a, &row.b, &row.c};
    for (uint8_t i = 0; i < 3; ++i) link_field(*kinds[i], i, bases[i], fields[i]);
    if (row.c.kind == FieldKind::kOffset16) link_offset(unit, row, bases, fields);
    Unit linked = Unit::make(unit.opcode(), bases[0], bases[1], bases[2]);
    linked.a = fields[0];
    linked.b = fields[1];
    linked.c = fields[2];
    if (row.b.kind == FieldKind::kBc32) linked.set_bc(numbers_.wide_offset(bases[1], unit.bc()));
    append(before_);
    if (row.b.kind == FieldKind::kRel32) {
      const auto distance = static_cast<int32_t>(unit.bc());
      jumps_.push_back(
          {static_cast<uint32_t>(code_.size()), static_cast<uint32_t>(int64_t{at} + 1 + distance)});
    }
    code_.push_back(linked);
    if (row.extended) {
      const Unit& extension = object_.code[at + 1];
      const Base base = row.c.kind == FieldKind::kBase ? bases[2] : bases[1];
      const uint32_t x = numbers_.extension_field(row.x, extension.x(), base);
      code_.push_back(Unit::extension(x, numbers_.extension_field(row.y, extension.y(), base)));
    }
    append(after_);
    return row.extended ? 2 : 1;
  }

  void link_field(const Field& field, uint8_t position, Base& base, uint16_t& value) {
    switch (field.kind) {
      case FieldKind::kFrameSize:
        value = static_cast<uint16_t>(frame_.size / 8);
        return;
      case FieldKind::kCode:
        value = static_cast<uint16_t>(numbers_.pou_number(value));
        return;
      case FieldKind::kRange:
        value = link_range(value);
        return;
      default:
        break;
    }
    if (!field.is_near()) return;
    const uint64_t offset = numbers_.near_offset(base, value);
    if (offset <= kNearLimit) {
      value = static_cast<uint16_t>(offset);
      return;
    }
    value = through_scratch(field, position, base, static_cast<uint32_t>(offset));
    base = Base::kFrame;
  }

  uint16_t through_scratch(const Field& field, uint8_t position, Base base, uint32_t offset) {
    const uint16_t slot = scratch_slot({field.cls, {}, position});
    for (const bool store : {false, true}) {
      if (store ? !field.writes() : !field.reads()) continue;
      const Opcode op = far_opcode(store ? "STFAR_" : "LDFAR_", field.cls);
      if (!exists(op)) {
        fail(
            "its frame is too large for references and strings as arguments; make large "
            "local variables variables of the instance");
        return 0;
      }
      Unit unit = Unit::make(op, Base::kFrame, base);
      unit.a = slot;
      unit.set_bc(offset);
      (store ? after_ : before_).push_back(unit);
    }
    return slot;
  }

  uint16_t scratch_slot(const Scratch& wanted) {
    const auto found = std::find(scratch_.begin(), scratch_.end(), wanted);
    if (found == scratch_.end()) {
      if (std::find(missing_.begin(), missing_.end(), wanted) == missing_.end()) {
        missing_.push_back(wanted);
      }
      return 0;
    }
    const uint32_t offset = frame_.scratch_offsets[static_cast<size_t>(found - scratch_.begin())];
    if (offset > kNearLimit) fail("its parameters are too large for one frame");
    return static_cast<uint16_t>(offset);
  }

  // A displacement beyond 16 bits: the address of the scalar itself comes first.
  void link_offset(const Unit& unit, const OpcodeRow& row, Base (&bases)[3],
                   uint16_t (&fields)[3]) {
    const uint32_t number = unit.c;
    const uint64_t offset = numbers_.offset_of_place(number);
    if (offset <= kNearLimit) {
      fields[2] = static_cast<uint16_t>(offset);
      return;
    }
    const ir::Region leaf = object_.places[number].result;
    const bool store = row.a.cls == Class::kA && row.a.kind == FieldKind::kFrameRead;
    const uint8_t addr = store ? 0 : 1;
    const bool scalar = context_.program.types.is_scalar(leaf.type) && row.name.size() < 7 &&
                        (row.name.starts_with("LD_") || row.name.starts_with("ST_"));
    if (!scalar) {
      return fail(
          "a function block or in-out variable lies more than 65,535 bytes after the "
          "start of its instance");
    }
    const uint16_t slot = scratch_slot({Class::kA, leaf, addr});
    Unit lea = Unit::make(Opcode::LEA_AT);
    lea.a = slot;
    lea.b = fields[addr];
    before_.push_back(lea);
    before_.push_back(Unit::extension(static_cast<uint32_t>(offset), ir::region_field(leaf)));
    bases[addr] = Base::kFrame;
    fields[addr] = slot;
    fields[2] = 0;
  }

  void append(const std::vector<Unit>& units) {
    if (!units.empty()) code_.insert(code_.end(), units.begin(), units.end());
  }

  const LinkContext& context_;
  const ir::Object& object_;
  const FrameLayout& frame_;
  const std::vector<Scratch>& scratch_;
  Numbers numbers_;
  std::vector<Scratch> missing_;
  std::vector<Unit> code_;
  std::vector<Unit> before_;
  std::vector<Unit> after_;
  std::vector<uint32_t> starts_;  // unit of the object -> unit of the code
  std::vector<Jump> jumps_;
  std::optional<base::Error> error_;
};

LinkedCode linked_code(Pass& pass, const ir::Object& object, FrameLayout frame) {
  LinkedCode linked;
  ir::LinkedPou& pou = linked.pou;
  pou.name = object.name;
  pou.kind = object.kind;
  pou.self = object.self;
  pou.recursion_depth = object.recursion_depth;
  pou.file = base::visible(object.file);  // as an image can hold it
  pou.frame_size = frame.size;
  pou.slots = std::move(frame.slots);
  for (const ir::Merge& merge : object.merges) {
    ir::Merge moved{pass.start_of(merge.unit), {}};
    for (uint16_t slot : merge.slots) {
      moved.slots.push_back(static_cast<uint16_t>(frame.slot_numbers[slot]));
    }
    std::sort(moved.slots.begin(), moved.slots.end());
    pou.merges.push_back(std::move(moved));
  }
  for (const ir::LineEntry& line : object.lines) {
    pou.lines.push_back({pass.start_of(line.unit), line.line});
  }
  linked.code = pass.take_code();
  pou.unit_count = static_cast<uint32_t>(linked.code.size());
  return linked;
}

}  // namespace

base::Result<LinkedCode> relocate(const LinkContext& context, const ir::Object& object) {
  std::vector<Scratch> scratch;
  for (;;) {
    base::Result<FrameLayout> frame = lay_out_frame(object, context.image.layouts, scratch);
    if (!frame.ok()) return frame.error();
    Pass pass(context, object, frame.value(), scratch);
    pass.run();
    if (pass.error()) return *pass.error();
    if (pass.missing().empty()) return linked_code(pass, object, std::move(frame).value());
    scratch.insert(scratch.end(), pass.missing().begin(), pass.missing().end());
  }
}

}  // namespace linker
