// Places: where variables, members, elements and constants are.
#include <algorithm>

#include "frontend/lower/assignments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/current_results.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/values.h"
#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/width.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {

// The place of a variable in shared bytes.
ir::Place Places::view_place(const AddressView& view) {
  ir::Place place = global_place(view.global);
  const ir::TypeId shared = place.type;
  place.steps.push_back(step_to(ir::StepKind::kMember, view.member));
  place.type = types()[shared].members[view.member].type;
  return place;
}

// The BYTE that holds the bit which `id` names.
ir::Place Places::view_place(ExprId id) {
  if (VarId variable = infer(id).variable; variable.valid()) {
    return view_place(resolve(variable).view);
  }
  return view_place(*direct_view(*this, tree_[id]));
}

ir::Place Places::variable_place(VarId id) {
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
ir::Place Places::place(ExprId id) {
  const Note& note = infer(id);
  if (!note.reference.valid()) return raw_place(id);
  return code_.target_place(ask<References>().raw_reference(id), note.type);
}

ir::Place Places::raw_place(ExprId id) {
  const Expr& expr = tree_[id];
  const Note& note = infer(id);
  if (is_known(note)) return constant_place(id);
  if (note.property != kNoPou) return property_place(id);
  if (note.variable.valid()) return variable_place(note.variable);
  switch (expr.kind) {
    case ExprKind::kMember:
      return member_place(expr);
    case ExprKind::kIndex:
      return types().is_reference(infer(expr.operand).type)
                 ? ask<References>().dereferenced_place(expr)
                 : index_place(expr);
    case ExprKind::kDeref:
      return ask<References>().dereferenced_place(expr);
    case ExprKind::kDirect:
      if (const AddressView* view = direct_view(*this, expr)) return view_place(*view);
      return global_place(ask<Variables>().direct_member(expr));
    case ExprKind::kCall:
      return ask<CallCode>().call_place(id, expr);
    case ExprKind::kAssign:
      return ask<Assignments>().assignment_place(id, expr);
    case ExprKind::kResult:
      return ask<CurrentResults>().result_place(expr, note.type);
    default:
      return temporary_place(note.type);
  }
}

ir::Place Places::property_place(ExprId id) {
  const CallResult result = ask<MethodCode>().read_property(id);
  if (!result.value.valid()) return result.place;
  const ir::Place kept = temporary_place(
      resolve(sema_.declared.pous[ask<MethodCode>().property_code(id).getter].result).type);
  build_.store(kept, scalar(kept.type), result.value);
  return kept;
}

ir::Place Places::member_place(const Expr& expr) {
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
ir::Place Places::bit_word_place(ExprId structure, const Note& part) {
  ir::Place out = place(structure);
  auto member = static_cast<uint32_t>(part.bit_member);
  out.steps.push_back(step_to(ir::StepKind::kMember, member));
  out.type = types()[infer(structure).type].members[member].type;
  return out;
}

ir::Place Places::index_place(const Expr& expr) {
  ir::TypeId array = infer(expr.operand).type;
  if (const OpenArray* open = sema_.declared.open_array(array)) return open_element(expr, *open);
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
      at.value = own ? ask<Values>().computed_in(index, note.type) : natural(index).value;
    }
    place.steps.push_back(at);
  }
  place.type = types()[array].base;
  return place;
}

// Constants get no variable of the frame: they are read where the image keeps them.
ir::Place Places::constant_place(ExprId id) {
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

void Places::note_output(const ir::DirectAddress& address, ir::TypeId type, base::SourceSpan span) {
  bool known = address.bit_size != 0 && type.valid();
  if (address.area == ir::DirectArea::kOutput && known) {
    info_.writes.push_back({address, type, span});
  }
}

void Places::note_outer_use(VarId global, bool written, base::SourceSpan span) {
  if (CommonUses(sema_).is_outer(global)) info_.outer_uses.push_back({global, written, span});
}

}  // namespace frontend
