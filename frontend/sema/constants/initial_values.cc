// Initial values of any type as trees of constants.
#include <map>

#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"

namespace frontend {

// Builds one initial value. `otherwise` is the value that the declared type gives the
// place: what a list leaves out keeps it.
class InitialBuilder : private Phase {
 public:
  InitialBuilder(Sema& sema, const PouScope& scope, Known least, Bound bound)
      : Phase(sema, scope), least_(least), bound_(bound) {}
  ir::ConstId value(ExprId id, ir::TypeId type, ir::ConstId otherwise);

 private:
  struct ArrayList {
    ir::TypeId type;
    ir::ConstId otherwise;
    uint64_t total = 1;
    uint64_t at = 0;  // flat number of the next element
    std::vector<ir::ConstElement> elements;
    std::map<std::pair<uint32_t, uint32_t>, ir::ConstId> known;  // by expression and default
  };
  struct Slot {
    int32_t member = -1;
    ir::TypeId type;
    int32_t bit = -1;    // of a BIT member
    bool fixed = false;  // a CONSTANT of a block
  };

  ir::ConstId whole(ExprId id, ir::TypeId type);
  ir::ConstId text(ExprId id, ir::TypeId type);
  ir::ConstId array(const Expr& expr, ir::TypeId type, ir::ConstId otherwise);
  bool item(ExprId id, ArrayList& list);
  bool item_parts(ExprId id, uint64_t& rounds, std::vector<ExprId>& values);
  bool element(ExprId id, uint64_t rounds, ArrayList& list);
  ir::ConstId element_value(ExprId id, ir::ConstId otherwise, ArrayList& list);
  ir::ConstId structure(const Expr& expr, ir::TypeId type, ir::ConstId otherwise);
  Slot find_slot(ir::TypeId type, const Name& name);
  bool set_bit(ExprId id, const Slot& slot, ir::TypeId type,
               std::vector<ir::ConstElement>& elements);

  Known least_;
  Bound bound_;
};

ir::ConstId InitialBuilder::value(ExprId id, ir::TypeId type, ir::ConstId otherwise) {
  const ir::TypeTable& types = sema_.program.types;
  const Expr& expr = sema_.tree[id];
  ir::Kind kind = types[type].kind;
  bool members = ir::is_structure(kind) || kind == ir::Kind::kFunctionBlock;
  if (expr.kind == ExprKind::kArrayInit && kind == ir::Kind::kArray) {
    return array(expr, type, otherwise);
  }
  if (expr.kind == ExprKind::kStructInit && members) return structure(expr, type, otherwise);
  if (types.is_reference(type) && bound_ == Bound::kAtStart) {
    const Note& note = infer(id);
    if (note.type.valid() && !note.constant) return sema_.start_values.add(scope_, id);
  }
  if (types.is_scalar(type)) {
    auto bits = ask<Constants>().fold_bits(id, type, least_);
    return bits ? sema_.program.constants.scalar(*bits) : ir::ConstId();
  }
  return is_string(types, type) ? text(id, type) : whole(id, type);
}

ir::ConstId InitialBuilder::text(ExprId id, ir::TypeId type) {
  auto value = ask<Constants>().fold(id, type, least_);
  if (!value) return {};
  auto text = ask<Constants>().fit_text(*value, type, sema_.tree[id].span);
  if (!text) return {};
  return sema_.program.constants.add({0, std::move(*text), {}});
}

// Another variable of the same structure or array type.
ir::ConstId InitialBuilder::whole(ExprId id, ir::TypeId type) {
  const Expr& expr = sema_.tree[id];
  bool list = expr.kind == ExprKind::kArrayInit || expr.kind == ExprKind::kStructInit ||
              expr.kind == ExprKind::kRepeat;
  if (!list) {
    const Note& note = infer(id);
    if (!note.type.valid()) return {};
    if (note.type == type && note.known >= least_ && !sema_.program.types.is_instance(type)) {
      auto part = ask<Constants>().initial_part(id);
      if (!part) return {};
      if (part->init.valid()) return part->init;
      return sema_.program.constants.add({});
    }
  }
  bool is_array = sema_.program.types[type].kind == ir::Kind::kArray;
  error(DiagnosticCode::kBadInitializer, expr.span,
        "this is no initial value of `" + sema_.report.type_text(type) + "`",
        is_array ? "write [value, value, 3(value)]" : "write (member := value, ...)");
  return {};
}

ir::ConstId InitialBuilder::array(const Expr& expr, ir::TypeId type, ir::ConstId otherwise) {
  ArrayList list;
  list.type = type;
  list.otherwise = otherwise;
  for (const ir::Dimension& dim : sema_.program.types[type].dims) list.total *= dim.count();
  if (otherwise.valid()) list.elements = sema_.program.constants[otherwise].elements;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    if (!item(sema_.tree.expr_lists[expr.list.first + i], list)) return {};
  }
  ir::ConstValue value;
  value.elements = std::move(list.elements);
  return sema_.program.constants.add(std::move(value));
}

// `3(7)` and `N(7)`: how often, and which values; other items stand once.
bool InitialBuilder::item_parts(ExprId id, uint64_t& rounds, std::vector<ExprId>& values) {
  const Tree& tree = sema_.tree;
  const Expr& item = tree[id];
  rounds = 1;
  if (item.kind == ExprKind::kRepeat) {
    for (uint32_t k = 0; k < item.list.count; ++k) {
      values.push_back(tree.expr_lists[item.list.first + k]);
    }
  } else if (item.kind == ExprKind::kCall && tree[item.operand].kind == ExprKind::kName &&
             ask<Variables>().find_variable(tree[item.operand]).valid()) {
    for (uint32_t k = 0; k < item.list.count; ++k) {
      values.push_back(tree.args[item.list.first + k].value);
      if (!values.back().valid()) return false;
    }
  } else {
    values.push_back(id);
    return true;
  }
  auto count = ask<Constants>().fold_integer(item.operand);
  if (!count) return false;
  if (*count < 0) {
    error(DiagnosticCode::kBadInitializer, item.span, "a negative number of values");
    return false;
  }
  rounds = static_cast<uint64_t>(*count);
  return true;
}

bool InitialBuilder::item(ExprId id, ArrayList& list) {
  uint64_t rounds = 1;
  std::vector<ExprId> values;
  if (!item_parts(id, rounds, values)) return false;
  uint64_t width = values.empty() ? 1 : values.size();  // n(): elements keep their default
  if (rounds > list.total || list.at + rounds * width > list.total) {
    error(DiagnosticCode::kTooManyInitializers, sema_.tree[id].span,
          "`" + sema_.report.type_text(list.type) + "` has " + std::to_string(list.total) +
              " elements");
    return false;
  }
  if (values.empty()) list.at += rounds;
  if (values.size() == 1) return element(values[0], rounds, list);
  for (uint64_t round = 0; round < rounds; ++round) {
    for (ExprId value : values) {
      if (!element(value, 1, list)) return false;
    }
  }
  return true;
}

// One value for `rounds` elements. Runs of one value stay one entry, unless the elements
// had different defaults that the value keeps in part.
bool InitialBuilder::element(ExprId id, uint64_t rounds, ArrayList& list) {
  ExprKind kind = sema_.tree[id].kind;
  bool partial = kind == ExprKind::kArrayInit || kind == ExprKind::kStructInit;
  uint64_t step = partial && list.otherwise.valid() ? 1 : rounds;
  for (uint64_t end = list.at + rounds; list.at < end; list.at += step) {
    ir::ConstId init = element_value(id, ask<Constants>().listed(list.otherwise, list.at), list);
    if (!init.valid()) return false;
    list.elements.push_back({static_cast<uint32_t>(list.at), static_cast<uint32_t>(step), init});
  }
  return true;
}

ir::ConstId InitialBuilder::element_value(ExprId id, ir::ConstId otherwise, ArrayList& list) {
  auto [known, added] = list.known.try_emplace({id.index, otherwise.index});
  if (added) known->second = value(id, sema_.program.types[list.type].base, otherwise);
  return known->second;
}

// One bit of the byte that holds it, the others as they are so far.
bool InitialBuilder::set_bit(ExprId id, const Slot& slot, ir::TypeId type,
                             std::vector<ir::ConstElement>& elements) {
  auto bit = ask<Constants>().fold_bits(id, slot.type, least_);
  if (!bit) return false;
  auto index = static_cast<uint32_t>(slot.member);
  ir::ConstId before = ask<Constants>().member_default(type, index);
  for (const ir::ConstElement& element : elements) {
    if (element.first == index) before = element.value;
  }
  uint64_t bits = before.valid() ? sema_.program.constants[before].bits : 0;
  uint64_t mask = uint64_t{1} << slot.bit;
  bits = *bit != 0 ? bits | mask : bits & ~mask;
  elements.push_back({index, 1, sema_.program.constants.scalar(bits)});
  return true;
}

InitialBuilder::Slot InitialBuilder::find_slot(ir::TypeId type, const Name& name) {
  const PouInfo* block = sema_.declared.pou_of(type);
  if (block == nullptr) {
    const StructureField* field = sema_.declared.find_field(type, name.text);
    if (field == nullptr) return {};
    bool bit = field->bit >= 0;
    return {static_cast<int32_t>(field->member),
            bit ? sema_.program.types.elementary(ir::Kind::kBool)
                : sema_.program.types[type].members[field->member].type,
            field->bit};
  }
  const VarId found = ask<Objects>().find_parameter(*block, name.text);
  if (!found.valid()) return {};
  const Variable& variable = resolve(found);
  bool settable = variable.storage == Storage::kMember && variable.section != VarSection::kInOut &&
                  variable.section != VarSection::kExternal;
  return {settable ? static_cast<int32_t>(variable.index) : -1, variable.type, -1,
          has_known_value(variable)};
}

ir::ConstId InitialBuilder::structure(const Expr& expr, ir::TypeId type, ir::ConstId otherwise) {
  ir::ConstValue value;
  if (otherwise.valid()) value.elements = sema_.program.constants[otherwise].elements;
  std::vector<bool> given;
  for (uint32_t i = 0; i < expr.list.count; ++i) {
    const Arg& arg = sema_.tree.args[expr.list.first + i];
    Slot slot = find_slot(type, arg.name);
    if (slot.fixed) {
      error(DiagnosticCode::kAssignToConstant, arg.span,
            "`" + std::string(arg.name.text) + "` is a constant of `" +
                sema_.report.type_text(type) + "`: every instance has the same value",
            "declare it in VAR or VAR_INPUT to set it for each instance");
      return {};
    }
    if (slot.member < 0 || arg.output || !arg.value.valid()) {
      error(DiagnosticCode::kUnknownMember, arg.span,
            "`" + sema_.report.type_text(type) + "` has no member `" + std::string(arg.name.text) +
                "` to initialise");
      return {};
    }
    if (!slot.type.valid()) return {};
    uint32_t index = static_cast<uint32_t>(slot.member);
    size_t number = index * 9 + static_cast<size_t>(slot.bit + 1);
    if (given.size() <= number) given.resize(number + 1);
    if (given[number]) {
      error(DiagnosticCode::kDuplicateName, arg.span,
            "`" + std::string(arg.name.text) + "` is initialised twice");
      return {};
    }
    given[number] = true;
    if (slot.bit >= 0) {
      if (!set_bit(arg.value, slot, type, value.elements)) return {};
      continue;
    }
    ir::ConstId before = ask<Constants>().listed(otherwise, index);
    if (!before.valid()) before = ask<Constants>().member_default(type, index);
    ir::ConstId init = this->value(arg.value, slot.type, before);
    if (!init.valid()) return {};
    value.elements.push_back({index, 1, init});
  }
  return sema_.program.constants.add(std::move(value));
}

ir::ConstId Constants::initial_value(ExprId id, ir::TypeId type, ir::ConstId otherwise, Known least,
                                     Bound bound) {
  return InitialBuilder(sema_, scope_, least, bound).value(id, type, otherwise);
}

}  // namespace frontend
