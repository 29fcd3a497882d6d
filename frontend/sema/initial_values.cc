// Initial values of any type as trees of constants.
#include "frontend/sema/sema.h"

namespace frontend {

ir::ConstId Sema::initial_value(ExprId id, ir::TypeId type) {
  const Expr& expr = tree[id];
  const ir::Kind kind = program.types[type].kind;
  bool instance = kind == ir::Kind::kFunctionBlock;
  if (expr.kind == ExprKind::kArrayInit && kind == ir::Kind::kArray) {
    return array_value(expr, type);
  }
  if (expr.kind == ExprKind::kStructInit && (kind == ir::Kind::kStruct || instance)) {
    return struct_value(expr, type);
  }
  if (program.types.is_scalar(type)) {
    auto bits = fold_bits(id, type);
    return bits ? program.constants.scalar(*bits) : ir::ConstId();
  }
  if (is_string(program.types, type)) {
    auto value = fold(id, type);
    if (!value) return {};
    auto text = fit_text(*value, type, expr.span);
    if (!text) return {};
    return program.constants.add({0, std::move(*text), {}});
  }
  // Another constant of the same structure or array type.
  if (expr.kind == ExprKind::kName) {
    const Note& note = infer(id);
    if (!note.type.valid()) return {};
    const Variable* constant = note.variable.valid() ? &resolve(note.variable) : nullptr;
    if (constant != nullptr && constant->constant && constant->type == type) return constant->init;
  }
  error(
      DiagnosticCode::kBadInitializer, expr.span,
      "this is no initial value of `" + type_text(type) + "`",
      kind == ir::Kind::kArray ? "write [value, value, 3(value)]" : "write (member := value, ...)");
  return {};
}

ir::ConstId Sema::array_value(const Expr& expr, ir::TypeId type) {
  uint64_t total = 1;
  for (const ir::Dimension& dim : program.types[type].dims) total *= dim.count();
  std::vector<ir::ConstElement> elements;
  uint64_t at = 0;
  if (!array_elements(expr, type, total, elements, at)) return {};
  ir::ConstValue value;
  value.elements = std::move(elements);
  return program.constants.add(std::move(value));
}

// `3(7)` and `N(7)`: how often, and which values; other items stand once.
bool Sema::array_item(ExprId id, uint64_t& rounds, std::vector<ExprId>& values) {
  const Expr& item = tree[id];
  rounds = 1;
  if (item.kind == ExprKind::kRepeat) {
    for (uint32_t k = 0; k < item.list.count; ++k) {
      values.push_back(tree.expr_lists[item.list.first + k]);
    }
  } else if (item.kind == ExprKind::kCall && tree[item.operand].kind == ExprKind::kName &&
             find_variable(tree[item.operand].name.text).valid()) {
    for (uint32_t k = 0; k < item.args.count; ++k) {
      values.push_back(tree.args[item.args.first + k].value);
      if (!values.back().valid()) return false;
    }
  } else {
    values.push_back(id);
    return true;
  }
  auto count = fold_integer(item.operand);
  if (!count) return false;
  if (*count < 0) {
    error(DiagnosticCode::kBadInitializer, item.span, "a negative number of values");
    return false;
  }
  rounds = static_cast<uint64_t>(*count);
  return true;
}

// `at` is the flat number of the next element. Runs of one value stay one entry.
bool Sema::array_elements(const Expr& list, ir::TypeId type, uint64_t total,
                          std::vector<ir::ConstElement>& out, uint64_t& at) {
  ir::TypeId element = program.types[type].base;
  for (uint32_t i = 0; i < list.list.count; ++i) {
    ExprId id = tree.expr_lists[list.list.first + i];
    uint64_t rounds = 1;
    std::vector<ExprId> items;
    if (!array_item(id, rounds, items)) return false;
    uint64_t width = items.empty() ? 1 : items.size();  // n(): elements keep their default
    if (rounds > total || at + rounds * width > total) {
      error(DiagnosticCode::kTooManyInitializers, tree[id].span,
            "`" + type_text(type) + "` has " + std::to_string(total) + " elements");
      return false;
    }
    std::vector<ir::ConstId> values;
    for (ExprId item : items) {
      values.push_back(initial_value(item, element));
      if (!values.back().valid()) return false;
    }
    if (values.size() <= 1) {
      if (rounds != 0 && !values.empty()) {
        out.push_back({static_cast<uint32_t>(at), static_cast<uint32_t>(rounds), values[0]});
      }
      at += rounds;
      continue;
    }
    for (uint64_t round = 0; round < rounds; ++round) {
      for (ir::ConstId value : values) out.push_back({static_cast<uint32_t>(at++), 1, value});
    }
  }
  return true;
}

ir::ConstId Sema::struct_value(const Expr& expr, ir::TypeId type) {
  ir::ConstValue value;
  const PouInfo* block = pou_of(type);
  std::vector<bool> given;
  for (uint32_t i = 0; i < expr.args.count; ++i) {
    const Arg& arg = tree.args[expr.args.first + i];
    int32_t member = -1;
    ir::TypeId member_type;
    if (block != nullptr) {
      auto found = block->names.find(arg.name.text);
      if (found != block->names.end()) {
        const Variable& variable = resolve(found->second);
        bool settable = variable.storage == Storage::kMember &&
                        variable.section != VarSection::kInOut &&
                        variable.section != VarSection::kExternal;
        if (settable) member = static_cast<int32_t>(variable.index);
        member_type = variable.type;
      }
    } else {
      member = find_member(type, arg.name.text);
      if (member >= 0)
        member_type = program.types[type].members[static_cast<uint32_t>(member)].type;
    }
    if (member < 0 || arg.output || !arg.value.valid()) {
      error(DiagnosticCode::kUnknownMember, arg.span,
            "`" + type_text(type) + "` has no member `" + std::string(arg.name.text) +
                "` to initialise");
      return {};
    }
    if (!member_type.valid()) return {};
    uint32_t index = static_cast<uint32_t>(member);
    if (given.size() <= index) given.resize(index + 1);
    if (given[index]) {
      error(DiagnosticCode::kDuplicateName, arg.span,
            "`" + std::string(arg.name.text) + "` is initialised twice");
      return {};
    }
    given[index] = true;
    ir::ConstId init = initial_value(arg.value, member_type);
    if (!init.valid()) return {};
    value.elements.push_back({index, 1, init});
  }
  return program.constants.add(std::move(value));
}

}  // namespace frontend
