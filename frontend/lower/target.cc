// What is assigned: a place, bits of it, a character of a string, or a property.
#include "frontend/lower/method_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/targets.h"
#include "frontend/lower/write_checks.h"
#include "frontend/sema/declarations/variables.h"

namespace frontend {

// Evaluates the indices of an assignment's left side; reports what cannot be written.
std::optional<Target> Targets::target(ExprId id) {
  const Note note = infer(id);
  if (!note.type.valid()) return std::nullopt;
  ExprId whole = id;
  while (infer(whole).bit_size != 0 && !infer(whole).view) {
    whole = tree_[whole].operand;
  }
  const bool property = infer(whole).property != kNoPou && !infer(whole).reference.valid();
  if (!property && !ask<WriteChecks>().check_writable(id)) return std::nullopt;
  if (!types().is_scalar(note.type) && ask<Variables>().holds_input(note.type)) {
    error(DiagnosticCode::kAssignToInput, tree_[id].span,
          "`" + sema_.report.type_text(note.type) + "` has inputs (AT %I*) among its members",
          "assign the other members one by one");
    return std::nullopt;
  }
  Target out;
  if (property) {
    auto found = ask<MethodCode>().property_target(whole);
    if (!found) return std::nullopt;
    out = std::move(*found);
  }
  out.type = note.type;
  ExprId at = id;
  out.bit_size = note.bit_size;
  while (infer(at).bit_size != 0) {
    const Note part = infer(at);
    out.bit_offset += part.bit_number * part.bit_size;
    if (part.view) {
      out.place = ask<Places>().view_place(at);
      return out;
    }
    at = tree_[at].operand;
    if (part.bit_member < 0) continue;
    out.place = ask<Places>().bit_word_place(at, part);
    return out;
  }
  if (property) return out;
  if (ask<Places>().is_character(at)) {
    const Expr& character = tree_[at];
    out.place = place(character.operand);
    out.character = ask<Places>().character_position(character);
  } else {
    out.place = place(at);
  }
  return out;
}

ir::ValueId Targets::load(const Target& target) {
  ir::ValueId base = load_base(target);
  if (target.bit_size == 0) return base;
  return code_.part_of(base, base_scalar(target), target.bit_offset, target.bit_size);
}

ir::Scalar Targets::base_scalar(const Target& target) const {
  if (!target.character.valid()) return scalar(target.place.type);
  return wide(target.place.type) ? ir::Scalar::kU16 : ir::Scalar::kU8;
}

ir::ValueId Targets::load_base(const Target& target) {
  if (target.character.valid()) return code_.load_character(target.place, target.character);
  if (target.setter != kNoPou) {
    if (target.getter != kNoPou)
      return ask<MethodCode>().get_property(target.getter, target.receiver).value;
    return code_.zero(target.place.type);
  }
  return build_.load(target.place, base_scalar(target));
}

void Targets::store_base(const Target& target, ir::ValueId value) {
  if (target.character.valid()) return code_.store_character(target.place, target.character, value);
  if (target.setter != kNoPou) return ask<MethodCode>().set_property(target, value);
  build_.store(target.place, base_scalar(target), value);
}

// `value` has the target's type. Bits are put into the word that holds them.
void Targets::store(const Target& target, ir::ValueId value) {
  ir::Scalar machine = base_scalar(target);
  if (target.bit_size == 0) return store_base(target, value);
  uint64_t ones = (uint64_t{1} << target.bit_size) - 1;
  uint64_t keep = ~(ones << target.bit_offset);
  Wide mask = wrap_to(machine, static_cast<Wide>(keep) & limits_of(ir::Scalar::kU64).high);
  ir::ValueId old = load_base(target);
  ir::ValueId rest = build_.binary(ir::Op::kAnd, machine, old,
                                   build_.constant(machine, static_cast<uint64_t>(mask)));
  ir::ValueId bits = build_.unary(ir::Op::kWrap, machine, value);
  ir::ValueId count = build_.constant(ir::Scalar::kU32, target.bit_offset);
  ir::ValueId placed = build_.binary(ir::Op::kShl, machine, bits, count);
  store_base(target, build_.binary(ir::Op::kOr, machine, rest, placed));
}

}  // namespace frontend
