// Members and elements.
#include "frontend/sema/sema.h"

namespace frontend {

namespace {

std::string quoted(const Name& name) { return "`" + std::string(name.text) + "`"; }

bool is_type_name(const Expr& expr) { return expr.kind == ExprKind::kName; }

}  // namespace

Note Sema::infer_member(const Expr& expr) {
  const Expr& head = tree[expr.operand];
  // E.a: a literal qualified by its enumeration.
  if (is_type_name(head) && !find_variable(head.name.text).valid() &&
      types_.contains(head.name.text)) {
    Expr qualified = expr;
    qualified.prefix = head.name;
    return infer_qualified(qualified);
  }
  const Note& operand = infer(expr.operand);
  if (!operand.type.valid()) return {};
  Note note = operand;
  note.variable = {};
  note.constant = false;
  note.flex = Flex::kNone;
  const ir::Type& type = program.types[operand.type];
  if (type.kind == ir::Kind::kStruct) {
    int32_t member = find_member(operand.type, expr.name.text);
    if (member >= 0) {
      note.type = type.members[static_cast<uint32_t>(member)].type;
      return note;
    }
    NearestName nearest(expr.name.text);
    for (const ir::Member& other : type.members) nearest.offer(other.name);
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          "`" + type_text(operand.type) + "` has no member " + quoted(expr.name), nearest.fix());
    return {};
  }
  const PouInfo* block = pou_of(operand.type);
  if (block == nullptr) {
    error(DiagnosticCode::kNoMembers, expr.span,
          "`" + type_text(operand.type) + "` has no members");
    return {};
  }
  auto found = block->names.find(expr.name.text);
  if (found != block->names.end()) {
    const Variable& variable = resolve(found->second);
    if (variable.section == VarSection::kInput || variable.section == VarSection::kOutput) {
      note.type = variable.type;
      return note;
    }
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          quoted(expr.name) + " is private to `" + type_text(operand.type) + "`",
          "only VAR_INPUT and VAR_OUTPUT are visible outside; declare it there");
    return {};
  }
  NearestName nearest(expr.name.text);
  nearest.offer_all(block->names);
  error(DiagnosticCode::kUnknownMember, expr.name.span,
        "`" + type_text(operand.type) + "` has no member " + quoted(expr.name), nearest.fix());
  return {};
}

Note Sema::infer_index(const Expr& expr) {
  Note note = infer(expr.operand);
  note.variable = {};
  note.constant = false;
  note.flex = Flex::kNone;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    const Note& index = infer(tree.expr_lists[expr.list.first + i]);
    note.calls = note.calls || index.calls;
    note.can_trap = note.can_trap || index.can_trap || !index.constant;
  }
  if (!note.type.valid()) return {};
  const ir::Type& array = program.types[note.type];
  if (array.kind != ir::Kind::kArray) {
    error(DiagnosticCode::kNotArray, expr.span, "`" + type_text(note.type) + "` is not an array");
    return {};
  }
  if (array.dims.size() != expr.list.count) {
    error(DiagnosticCode::kWrongIndexCount, expr.span,
          std::to_string(expr.list.count) + " indices for `" + type_text(note.type) + "`",
          "give " + std::to_string(array.dims.size()));
    return {};
  }
  ir::TypeId element = array.base;
  check_index_list(expr, array);
  note.type = element;
  return note;
}

void Sema::check_index_list(const Expr& expr, const ir::Type& array) {
  std::vector<ir::Dimension> dims = array.dims;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    ExprId index = tree.expr_lists[expr.list.first + i];
    const Note& note = infer(index);
    if (!note.type.valid()) continue;
    Traits traits = traits_of(program.types, note.type);
    bool enumeration = is_enum(program.types, note.type);
    if (!traits.integer && !traits.bits && !enumeration) {
      error(DiagnosticCode::kIndexNotInteger, tree[index].span,
            "the index is `" + type_text(note.type) + "`");
      continue;
    }
    if (!note.constant) continue;
    auto value = fold_integer(index);
    if (!value || (*value >= dims[i].low && *value <= dims[i].high)) continue;
    error(DiagnosticCode::kIndexOutOfBounds, tree[index].span,
          "index " + std::to_string(*value) + " is outside " + std::to_string(dims[i].low) + ".." +
              std::to_string(dims[i].high));
  }
}

}  // namespace frontend
