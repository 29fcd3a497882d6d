// Places: where variables, members, elements and constants are.
#include <algorithm>

#include "frontend/lower/body.h"
#include "frontend/sema/common_uses.h"
#include "frontend/sema/constants.h"
#include "frontend/sema/objects.h"
#include "frontend/sema/shared_addresses.h"
#include "frontend/sema/variables.h"
#include "frontend/sema/width.h"

namespace frontend {

// The place of a variable in shared bytes.
ir::Place Body::view_place(const AddressView& view) {
  ir::Place place = global_place(view.global);
  const ir::TypeId shared = place.type;
  place.steps.push_back(step_to(ir::StepKind::kMember, view.member));
  place.type = types()[shared].members[view.member].type;
  return place;
}

// The BYTE that holds the bit which `id` names.
ir::Place Body::view_place(ExprId id) {
  if (VarId variable = infer(id).variable; variable.valid()) {
    return view_place(resolve(variable).view);
  }
  return view_place(*direct_view(*this, tree_[id]));
}

ir::Place Body::variable_place(VarId id) {
  const Variable& variable = resolve(id);
  if (variable.view.global != AddressView::kNone) return view_place(variable.view);
  if (variable.storage == Storage::kGlobal) {
    note_outer_use(id, false, {});
    return global_place(variable.index);
  }
  // Methods see the input itself.
  bool body = variable.pou == body_.number ||
              (variable.pou == info_.owner && info_.decl->kind == PouKind::kAction);
  if (variable.edge.valid() && body) return variable_place(variable.edge);
  ir::Place place = variable.storage == Storage::kLocal ? local_place(variable.index)
                                                        : member_variable_place(variable);
  if (variable.section == VarSection::kInOut && !variable.by_reference) {
    place.steps.push_back(step_to(ir::StepKind::kDeref));
  }
  place.type = variable.type;
  return place;
}

// Any expression that is not a scalar, and any scalar that has a place of its own.
ir::Place Body::place(ExprId id) {
  const Note& note = infer(id);
  if (!note.reference.valid()) return raw_place(id);
  return code_.target_place(raw_reference(id), note.type);
}

ir::Place Body::raw_place(ExprId id) {
  const Expr& expr = tree_[id];
  const Note& note = infer(id);
  if (is_known(note)) return constant_place(id);
  if (note.property != kNoPou) return property_place(id);
  if (note.variable.valid()) return variable_place(note.variable);
  switch (expr.kind) {
    case ExprKind::kMember:
      return member_place(expr);
    case ExprKind::kIndex:
      return types().is_reference(infer(expr.operand).type) ? dereferenced_place(expr)
                                                            : index_place(expr);
    case ExprKind::kDeref:
      return dereferenced_place(expr);
    case ExprKind::kDirect:
      if (const AddressView* view = direct_view(*this, expr)) return view_place(*view);
      return global_place(ask<Variables>().direct_member(expr));
    case ExprKind::kCall:
      return call_place(id, expr);
    case ExprKind::kAssign:
      return assignment_place(id, expr);
    case ExprKind::kResult:
      return result_place(expr, note.type);
    default:
      return temporary_place(note.type);
  }
}

ir::Place Body::property_place(ExprId id) {
  const CallResult result = read_property(id);
  if (!result.value.valid()) return result.place;
  const ir::Place kept =
      temporary_place(resolve(sema_.declared.pous[property_code(id).getter].result).type);
  build_.store(kept, scalar(kept.type), result.value);
  return kept;
}

ir::Place Body::member_place(const Expr& expr) {
  ir::TypeId outer = infer(expr.operand).type;
  ir::Place place = this->place(expr.operand);
  if (const PouInfo* block = sema_.declared.pou_of(outer)) {
    const Variable& variable = resolve(ask<Objects>().find_parameter(*block, expr.name.text));
    place.steps.push_back(step_to(ir::StepKind::kEnter));
    place.steps.push_back(step_to(ir::StepKind::kMember, variable.index));
    place.type = variable.type;
    return place;
  }
  uint32_t member = static_cast<uint32_t>(sema_.declared.find_member(outer, expr.name.text));
  place.steps.push_back(step_to(ir::StepKind::kMember, member));
  place.type = types()[outer].members[member].type;
  return place;
}

// The member of a structure that holds the BIT member which `part` is.
ir::Place Body::bit_word_place(ExprId structure, const Note& part) {
  ir::Place out = place(structure);
  auto member = static_cast<uint32_t>(part.bit_member);
  out.steps.push_back(step_to(ir::StepKind::kMember, member));
  out.type = types()[infer(structure).type].members[member].type;
  return out;
}

ir::Place Body::index_place(const Expr& expr) {
  ir::TypeId array = infer(expr.operand).type;
  ir::Place place = this->place(expr.operand);
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    ExprId index = tree_.expr_lists[expr.list.first + i];
    ir::Step at = step_to(ir::StepKind::kIndex);
    if (infer(index).constant) {
      at.constant_index = ask<Constants>().fold_integer(index).value_or(0);
    } else {
      const auto& dim = types()[array].dims[i];
      const Expr& sum = tree_[index];
      const Note note = infer(index);
      const bool own = note.width == Width::kWide && sum.kind == ExprKind::kBinary &&
                       wraps_outside(sema_, note, sum, infer(sum.operand), {dim.low, dim.high});
      at.value = own ? computed_in(index, note.type) : natural(index).value;
    }
    place.steps.push_back(at);
  }
  place.type = types()[array].base;
  return place;
}

// Constants get no variable of the frame: they are read where the image keeps them.
ir::Place Body::constant_place(ExprId id) {
  const Note& note = infer(id);
  ir::Place place;
  place.base = ir::PlaceBase::kConst;
  place.base_type = place.type = note.type;
  if (types().is_scalar(note.type)) {
    auto bits = ask<Constants>().fold_bits(id, note.type, Known::kInitially);
    place.constant = sema_.program.constants.scalar(bits.value_or(0));
    return place;
  }
  if (!is_string(types(), note.type)) {
    auto part = ask<Constants>().initial_part(id);
    if (part) place.constant = part->init;
    return place;
  }
  auto text = ask<Constants>().fold(id, note.type, Known::kInitially);
  place.constant = sema_.program.constants.add({0, text ? text->text : std::string(), {}});
  return place;
}

void Body::note_output(const ir::DirectAddress& address, ir::TypeId type, base::SourceSpan span) {
  bool known = address.bit_size != 0 && type.valid();
  if (address.area == ir::DirectArea::kOutput && known) {
    info_.writes.push_back({address, type, span});
  }
}

void Body::note_outer_use(VarId global, bool written, base::SourceSpan span) {
  if (CommonUses(sema_).is_outer(global)) info_.outer_uses.push_back({global, written, span});
}

// Evaluates the indices of an assignment's left side; reports what cannot be written.
std::optional<Target> Body::target(ExprId id) {
  const Note note = infer(id);
  if (!note.type.valid()) return std::nullopt;
  ExprId whole = id;
  while (infer(whole).bit_size != 0 && !infer(whole).view) {
    whole = tree_[whole].operand;
  }
  const bool property = infer(whole).property != kNoPou && !infer(whole).reference.valid();
  if (!property && !check_writable(id)) return std::nullopt;
  if (!types().is_scalar(note.type) && ask<Variables>().holds_input(note.type)) {
    error(DiagnosticCode::kAssignToInput, tree_[id].span,
          "`" + sema_.report.type_text(note.type) + "` has inputs (AT %I*) among its members",
          "assign the other members one by one");
    return std::nullopt;
  }
  Target out;
  if (property) {
    auto found = property_target(whole);
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
      out.place = view_place(at);
      return out;
    }
    at = tree_[at].operand;
    if (part.bit_member < 0) continue;
    out.place = bit_word_place(at, part);
    return out;
  }
  if (property) return out;
  if (is_character(at)) {
    const Expr& character = tree_[at];
    out.place = place(character.operand);
    out.character = character_position(character);
  } else {
    out.place = place(at);
  }
  return out;
}

ir::ValueId Body::load(const Target& target) {
  ir::ValueId base = load_base(target);
  if (target.bit_size == 0) return base;
  return code_.part_of(base, base_scalar(target), target.bit_offset, target.bit_size);
}

ir::Scalar Body::base_scalar(const Target& target) const {
  if (!target.character.valid()) return scalar(target.place.type);
  return wide(target.place.type) ? ir::Scalar::kU16 : ir::Scalar::kU8;
}

ir::ValueId Body::load_base(const Target& target) {
  if (target.character.valid()) return code_.load_character(target.place, target.character);
  if (target.setter != kNoPou) {
    if (target.getter != kNoPou) return get_property(target.getter, target.receiver).value;
    return code_.zero(target.place.type);
  }
  return build_.load(target.place, base_scalar(target));
}

void Body::store_base(const Target& target, ir::ValueId value) {
  if (target.character.valid()) return code_.store_character(target.place, target.character, value);
  if (target.setter != kNoPou) return set_property(target, value);
  build_.store(target.place, base_scalar(target), value);
}

// `value` has the target's type. Bits are put into the word that holds them.
void Body::store(const Target& target, ir::ValueId value) {
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
