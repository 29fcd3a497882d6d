#include "vm/load/decode.h"

#include "ir/bytecode/regions.h"
#include "vm/exec/fusion.h"
#include "vm/exec/handler_numbers.h"
#include "vm/load/truth_tables.h"
#include "vm/native/program.h"

namespace vm {
namespace {

// What a RESOLVE checks follows from its type alone: so many bytes without a slot (c is 0, x the
// bytes), or exactly such a value or instance (c is 1, x the type).
void prepare_resolve(const ir::Image& image, const std::vector<bool>& has_slots, ir::Unit& unit,
                     ir::Unit& extension) {
  const ir::TypeId type = ir::region_of_field(extension.x()).type;
  const bool exact = has_slots[type.index];
  unit.c = exact ? 1 : 0;
  extension = ir::Unit::extension(exact ? type.index : image.layouts[type].size, extension.y());
}

// Handler numbers into the op fields; the bytes of a COPY in the place of its type.
void prepare_code(const ir::Image& image, const std::vector<bool>& has_slots,
                  std::vector<ir::Unit>& code) {
  for (uint32_t i = 0; i < code.size(); ++i) {
    ir::Unit& unit = code[i];
    const ir::Opcode op = unit.opcode();
    unit.op =
        static_cast<uint16_t>(handler_number(op, unit.base_a(), unit.base_b(), unit.base_c()));
    if (!ir::opcode_row(op).extended) continue;
    ir::Unit& extension = code[++i];
    if (op == ir::Opcode::RESOLVE) prepare_resolve(image, has_slots, unit, extension);
    if (op == ir::Opcode::CALL_REF || op == ir::Opcode::IS_TYPE) {
      extension = ir::Unit::extension(ir::region_of_field(extension.x()).type.index, 0);
    }
    if (op == ir::Opcode::CALL_METHOD_REF) {
      extension = ir::Unit::extension(extension.x(), image.pous[extension.x()].self.index);
    }
    if (op != ir::Opcode::COPY) continue;
    const ir::Region region = ir::region_of_field(extension.x());
    extension = ir::Unit::extension(ir::region_size(image.types, image.layouts, region), 0);
  }
}

// Code that is compiled leaves the interpreter little to do.
bool is_fused(const TierOptions& tier) {
  if (tier.fusing != Fusing::kAuto) return tier.fusing == Fusing::kAlways;
  return tier.tier == Tier::kInterpreter || !native::is_available();
}

// Shorter lines of boolean logic are quicker with fused handlers.
constexpr uint32_t kLeastLogic = 16;

}  // namespace

std::vector<bool> types_with_slots(const ir::Image& image) {
  std::vector<bool> with(image.types.size());
  for (bool changed = true; changed;) {
    changed = false;
    for (uint32_t i = 0; i < with.size(); ++i) {
      const ir::Type& type = image.types[ir::TypeId(i)];
      bool found = image.types.is_instance(ir::TypeId(i)) ||
                   (type.kind == ir::Kind::kArray && with[type.base.index]);
      for (const ir::Member& member : type.members) found = found || with[member.type.index];
      changed |= found && !with[i];
      if (found) with[i] = true;
    }
  }
  return with;
}

Decoder::Decoder(const ir::Image& image, bool clean_bools, const TierOptions& tier)
    : image_(image),
      has_slots_(types_with_slots(image)),
      fuses_(is_fused(tier)),
      seed_(tier.fusing_seed),
      has_tables_(clean_bools),
      logic_line_(tier.logic_line) {}

void Decoder::run(const ir::LinkedPou& pou, std::span<const ir::Unit> units,
                  std::vector<ir::Unit>& decoded) const {
  run_unfused(units, decoded);
  if (!fuses_) return;
  StepLine line(units);
  std::vector<TruthSeries> tables;
  if (has_tables_) {
    const uint32_t least = logic_line_ != 0 ? logic_line_ : kLeastLogic;
    tables = truth_tables(pou, units, image_.pool, least, logic_line_ != 0);
  }
  for (const TruthSeries& series : tables) line.leave_out(series.first, series.units);
  fuse(line, decoded, seed_);
  for (const TruthSeries& series : tables) put_truth_tables(series, decoded);
}

void Decoder::run_unfused(std::span<const ir::Unit> units, std::vector<ir::Unit>& decoded) const {
  decoded.assign(units.begin(), units.end());
  prepare_code(image_, has_slots_, decoded);
}

}  // namespace vm
