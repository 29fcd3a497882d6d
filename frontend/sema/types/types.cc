// Type expressions -> TypeIds. Aliases, named strings, arrays and subranges stand
// for their content; structures and enumerations are types of their own.
#include "frontend/sema/types/types.h"
#include "base/limits.h"
#include "frontend/lex/library_index.h"
#include "frontend/parse/declared_twice.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// Chains of declarations that need each other; keeps hostile ones off the stack.
constexpr uint32_t kMaxTypeChain = 500;
constexpr uint64_t kMaxElements = base::kMaxTypeBytes;

}  // namespace

TypeUse Types::resolve_type(SpecId id) {
  if (!id.valid()) return {};
  SpecInfo& info = sema_.facts.of(scope_, id);
  if (info.progress == Progress::kDone) return info.use;
  const Spec& spec = sema_.tree[id];
  if (info.progress == Progress::kBusy) {
    error(DiagnosticCode::kRecursiveType, spec.span,
          "this type is needed to know its own size or bounds",
          "break the circle; a type cannot contain itself");
    return {};
  }
  if (sema_.facts.depth >= kMaxTypeChain) {
    error(DiagnosticCode::kTooDeep, spec.span, "types depend on each other too deeply");
    return {};
  }
  info.progress = Progress::kBusy;
  ++sema_.facts.depth;
  TypeUse use = resolve_kind(id, spec);
  info.use = use;
  // The default may name the type itself: Colour : (Red, Green) := Green.
  info.progress = Progress::kDone;
  if (use.type.valid() && info.default_value.valid()) {
    if (spec.kind == SpecKind::kEnum) know_own_literal(info.default_value, use.type);
    info.use.init = ask<Constants>().initial_value(info.default_value, use.type, use.init);
    if (spec.kind == SpecKind::kEnum) sema_.program.types.edit(use.type).init = info.use.init;
  }
  --sema_.facts.depth;
  return info.use;
}

TypeUse Types::resolve_kind(SpecId id, const Spec& spec) {
  switch (spec.kind) {
    case SpecKind::kError:
      return {};
    case SpecKind::kNamed:
      return resolve_named(spec);
    case SpecKind::kString:
      return resolve_string(spec);
    case SpecKind::kArray:
      return resolve_array(spec);
    case SpecKind::kStruct:
      return resolve_struct(id, spec);
    case SpecKind::kEnum:
      return resolve_enum(id, spec);
    case SpecKind::kSubrange:
      return resolve_subrange(spec);
    case SpecKind::kUnion:
      return resolve_struct(id, spec);
    case SpecKind::kPointer:
    case SpecKind::kRefTo:
    case SpecKind::kReferenceTo:
      return resolve_reference(spec);
  }
  return {};
}

std::optional<TypeUse> Types::find_type(std::string_view name) {
  if (auto kind = kind_of_name(name)) {
    if (*kind == ir::Kind::kString)
      return TypeUse{sema_.program.types.string(kDefaultStringCapacity), {}};
    if (*kind == ir::Kind::kWstring) {
      return TypeUse{sema_.program.types.wstring(kDefaultStringCapacity), {}};
    }
    return TypeUse{sema_.program.types.elementary(*kind), {}};
  }
  if (ir::same_name(name, "BIT") && !sema_.declared.types.contains(name)) {
    return TypeUse{sema_.program.types.elementary(ir::Kind::kBool), {}};
  }
  bool declared_pou = sema_.declared.pou_names.contains(name);
  if (!declared_pou && !sema_.declared.types.contains(name))
    ask<Collection>().use_library_type(name);
  if (auto known = sema_.declared.types.find(name); known != sema_.declared.types.end()) {
    return Types(sema_).resolve_type(known->second);
  }
  if (!declared_pou && sema_.options.dialect != Dialect::kIec) {
    if (auto kind = kind_of_address_name(name)) {
      return TypeUse{sema_.program.types.elementary(*kind), {}};
    }
  }
  if (!sema_.declared.pou_names.contains(name) && !ask<Collection>().use_library(name))
    return std::nullopt;
  const PouInfo& pou = sema_.declared.pous[sema_.declared.pou_names.find(name)->second];
  if (!pou.self.valid()) return std::nullopt;
  // A variable of an interface refers to what implements it.
  const bool interface = pou.decl->kind == PouKind::kInterface;
  return TypeUse{interface ? sema_.program.types.ref_to(pou.self) : pou.self, {}};
}

TypeUse Types::resolve_named(const Spec& spec) {
  if (scope_.meaning != nullptr) {
    const NameMap<ir::TypeId>& generic = scope_.meaning->generic;
    if (auto found = generic.find(spec.name.text); found != generic.end()) {
      return {found->second, {}};
    }
  }
  const std::string_view name =
      sema_.namespaces.find(NameSort::kDeclaration, spec.qualifiers, spec.name);
  if (auto use = find_type(name)) return *use;
  if (ask<Collection>().is_generic_name(name)) {
    error(DiagnosticCode::kUnknownType, spec.name.span,
          "`" + std::string(name) + "` leaves the type open, which only a function can do",
          "make it a function, or pass POINTER TO BYTE and a size: (ADR(x), SIZEOF(x))");
    return {};
  }
  const auto pou = sema_.declared.pou_names.find(name);
  if (sema_.library.functions.contains(name) ||
      (pou != sema_.declared.pou_names.end() &&
       sema_.declared.pous[pou->second].decl->kind == PouKind::kFunction)) {
    error(DiagnosticCode::kUnknownType, spec.name.span,
          "`" + std::string(name) + "` is a function, not a type", "call it without an instance");
    return {};
  }
  NearestName nearest(name);
  nearest.offer_all(sema_.declared.types);
  nearest.offer_all(sema_.declared.pou_names);
  const bool iec = sema_.options.dialect == Dialect::kIec;
  for (const std::string_view block : LibraryIndex::of(iec).pous()) nearest.offer(block);
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
    nearest.offer(ir::elementary_name(static_cast<ir::Kind>(i)));
  }
  error(DiagnosticCode::kUnknownType, spec.name.span, "`" + std::string(name) + "` is not a type",
        nearest.fix());
  return {};
}

TypeUse Types::resolve_string(const Spec& spec) {
  int64_t capacity = kDefaultStringCapacity;
  if (spec.length.valid()) {
    auto length = ask<Constants>().fold_integer(spec.length);
    if (!length) return {};
    capacity = *length;
  }
  if (capacity < 1 || capacity > base::kMaxStringCapacity) {
    error(DiagnosticCode::kStringTooLong, spec.span,
          "a string of " + std::to_string(capacity) + " characters",
          "use 1.." + std::to_string(base::kMaxStringCapacity));
    return {};
  }
  uint32_t characters = static_cast<uint32_t>(capacity);
  return {
      spec.wide ? sema_.program.types.wstring(characters) : sema_.program.types.string(characters),
      {}};
}

TypeUse Types::resolve_array(const Spec& spec) {
  if (spec.dims.size() > base::kMaxDimensions) {
    error(DiagnosticCode::kTooManyDimensions, spec.span,
          std::to_string(spec.dims.size()) + " dimensions",
          "use at most " + std::to_string(base::kMaxDimensions));
    return {};
  }
  if (spec.open_bounds) {
    error(DiagnosticCode::kSectionNotAllowed, spec.span, "an array with open bounds `[*]`",
          "parameters of functions leave the bounds open, and VAR_IN_OUT of methods and blocks");
    return {};
  }
  std::vector<ir::Dimension> dims;
  uint64_t elements = 1;
  for (const DimSpec& dim : spec.dims) {
    auto low = ask<Constants>().fold_integer(dim.low);
    auto high = ask<Constants>().fold_integer(dim.high);
    if (!low || !high) return {};
    if (*low > *high) {
      error(DiagnosticCode::kBadBounds, sema_.tree[dim.low].span,
            "bounds " + std::to_string(*low) + ".." + std::to_string(*high),
            "write the lower bound first");
      return {};
    }
    ir::Dimension dimension{*low, *high};
    uint64_t count = dimension.count();
    if (count == 0 || count > kMaxElements || elements * count > kMaxElements) {
      error(DiagnosticCode::kTypeTooLarge, spec.span,
            "the array has more than " + std::to_string(kMaxElements) + " elements");
      return {};
    }
    elements *= count;
    dims.push_back(dimension);
  }
  TypeUse element = resolve_type(spec.element);
  if (!element.type.valid() || dims.empty()) return {};
  TypeUse use{sema_.program.types.array(element.type, std::move(dims)), {}};
  if (element.init.valid()) {
    ir::ConstValue all;
    all.elements.push_back({0, static_cast<uint32_t>(elements), element.init});
    use.init = sema_.program.constants.add(std::move(all));
  }
  return use;
}

TypeUse Types::resolve_subrange(const Spec& spec) {
  TypeUse base = resolve_type(spec.element);
  if (!base.type.valid()) return {};
  Traits traits = traits_of(sema_.program.types, base.type);
  if (!traits.integer && !traits.bits) {
    error(DiagnosticCode::kTypeMismatch, spec.span,
          "a subrange of `" + sema_.report.type_text(base.type) + "`",
          "subranges need an integer type");
    return {};
  }
  auto low = ask<Constants>().fold_bits(spec.low, base.type);
  auto high = ask<Constants>().fold_bits(spec.high, base.type);
  if (!low || !high) return {};
  int64_t from = static_cast<int64_t>(*low);
  int64_t to = static_cast<int64_t>(*high);
  if (from > to) {
    error(DiagnosticCode::kBadBounds, spec.span,
          "subrange " + std::to_string(from) + ".." + std::to_string(to));
    return {};
  }
  // The lowest value is the default where zero is not in the range (IEC table 11).
  TypeUse use{sema_.program.types.subrange(without_range(sema_.program.types, base.type), from, to),
              {}};
  if (from > 0 || to < 0) use.init = sema_.program.constants.scalar(static_cast<uint64_t>(from));
  return use;
}

// In the default of an enumeration its own literals are known first, also those that
// {attribute 'qualified_only'} keeps from everybody else.
void Types::know_own_literal(ExprId default_value, ir::TypeId type) {
  const Expr& expr = sema_.tree[default_value];
  const bool own = expr.kind == ExprKind::kName && !expr.global &&
                   sema_.declared.find_literal(type, expr.name.text) >= 0;
  if (!own) return;
  Note note;
  note.type = type;
  note.constant = true;
  note.known = Known::kConstant;
  note.progress = Progress::kDone;
  sema_.facts.of(scope_, default_value) = note;
}

TypeUse Types::resolve_enum(SpecId id, const Spec& spec) {
  TypeUse base{sema_.program.types.elementary(ir::Kind::kInt), {}};
  if (spec.element.valid()) base = resolve_type(spec.element);
  if (!base.type.valid()) return {};
  Traits traits = traits_of(sema_.program.types, base.type);
  if (!traits.integer && !traits.bits) {
    error(DiagnosticCode::kTypeMismatch, spec.span,
          "an enumeration of `" + sema_.report.type_text(base.type) + "`",
          "enumerations need an integer type");
    return {};
  }
  if (spec.enumerators.size() > base::kMaxEnumerators) {
    error(DiagnosticCode::kTooComplex, spec.span,
          std::to_string(spec.enumerators.size()) + " literals in one enumeration",
          "use at most " + std::to_string(base::kMaxEnumerators));
    return {};
  }
  ir::Type type;
  type.kind = ir::Kind::kEnum;
  type.name = sema_.facts.of(scope_, id).name.text;
  type.base = without_range(sema_.program.types, base.type);
  Limits limits = limits_of(sema_.program.types.scalar(base.type));
  NameMap<uint32_t> numbers;
  Wide next = 0;
  for (const Enumerator& enumerator : spec.enumerators) {
    std::string name(enumerator.name.text);
    const auto number = static_cast<uint32_t>(type.literals.size());
    if (!numbers.emplace(enumerator.name.text, number).second) {
      const Name& first = spec.enumerators[numbers.find(enumerator.name.text)->second].name;
      error(DiagnosticCode::kDuplicateName, enumerator.name.span,
            declared_twice(sema_.sources, name, enumerator.name.span, first.span));
      return {};
    }
    if (enumerator.value.valid()) {
      sema_.declared.forming.push_back({type.base, &type.literals});
      auto value = ask<Constants>().fold_integer(enumerator.value);
      sema_.declared.forming.pop_back();
      if (!value) return {};
      next = *value;
    }
    if (next < limits.low || next > limits.high) {
      error(DiagnosticCode::kLiteralOutOfRange, enumerator.name.span,
            "`" + name + "` is " + wide_text(next) + "; `" + sema_.report.type_text(base.type) +
                "` ends at " + wide_text(limits.high));
      return {};
    }
    type.literals.push_back(
        {name, static_cast<int64_t>(next), ask<OldNames>().of_rule(enumerator.attributes)});
    next += 1;
  }
  if (type.literals.empty()) return {};
  if (int64_t first = type.literals[0].value; first != 0) {
    type.init = sema_.program.constants.scalar(static_cast<uint64_t>(first));
  }
  const ir::TypeId made = sema_.program.types.declare(std::move(type));
  sema_.declared.enumerations[made] = std::move(numbers);
  return {made, {}};
}

}  // namespace frontend
