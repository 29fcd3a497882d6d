#include "frontend/sema/types/conversion.h"

#include <algorithm>

#include "frontend/sema/names.h"

namespace frontend {
namespace {

using ir::Group;

const NameMap<ir::Kind>& kinds_by_name() {
  static const NameMap<ir::Kind> kTable = [] {
    NameMap<ir::Kind> table;
    for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
      table.emplace(ir::elementary_name(static_cast<ir::Kind>(i)), static_cast<ir::Kind>(i));
    }
    table.emplace("TOD", ir::Kind::kTod);
    table.emplace("LTOD", ir::Kind::kLtod);
    table.emplace("DT", ir::Kind::kDt);
    table.emplace("LDT", ir::Kind::kLdt);
    table.emplace("STRING", ir::Kind::kString);
    table.emplace("WSTRING", ir::Kind::kWstring);
    table.emplace("USTRING", ir::Kind::kString);  // docs/adr/0008-characters.md
    table.emplace("UCHAR", ir::Kind::kChar);
    return table;
  }();
  return kTable;
}

// A number type as the range of integers it holds exactly.
struct Span {
  bool negative;
  uint32_t bits;  // of magnitude
};

Span span_of(const ir::TypeTable& types, ir::TypeId type) {
  ir::Scalar scalar = types.scalar(type);
  if (scalar == ir::Scalar::kF32) return {true, 24};
  if (scalar == ir::Scalar::kF64) return {true, 53};
  uint32_t bits = ir::scalar_size(scalar) * 8;
  return ir::is_signed(scalar) ? Span{true, bits - 1} : Span{false, bits};
}

bool contains(Span outer, Span inner) {
  return outer.bits >= inner.bits && (outer.negative || !inner.negative);
}

bool number_like(const Traits& t) { return t.integer || t.real || t.bits; }

Fit number_fit(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to, Dialect dialect) {
  Traits a = traits_of(types, from);
  Traits b = traits_of(types, to);
  if (!number_like(a) || !number_like(b)) return Fit::kNone;
  if (a.bits != b.bits && dialect == Dialect::kIec) return Fit::kNone;
  if (a.real && !b.real) return Fit::kNarrowing;
  return contains(span_of(types, to), span_of(types, from)) ? Fit::kLossless : Fit::kNarrowing;
}

Fit enum_fit(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to, Dialect dialect) {
  if (dialect == Dialect::kIec) return Fit::kNone;
  if (is_enum(types, to)) {
    return traits_of(types, from).integer || traits_of(types, from).bits ? Fit::kNarrowing
                                                                         : Fit::kNone;
  }
  ir::TypeId base = types.elementary(types.root_kind(from));
  return implicit_fit(types, base, to, dialect);
}

// Long forms hold everything that the short ones hold.
Fit time_fit(ir::Kind from, ir::Kind to) {
  constexpr std::pair<ir::Kind, ir::Kind> kWider[] = {{ir::Kind::kTime, ir::Kind::kLtime},
                                                      {ir::Kind::kDate, ir::Kind::kLdate},
                                                      {ir::Kind::kTod, ir::Kind::kLtod},
                                                      {ir::Kind::kDt, ir::Kind::kLdt}};
  for (auto [narrow, wide] : kWider) {
    if (from == narrow && to == wide) return Fit::kSame;
    if (from == wide && to == narrow) return Fit::kNarrowing;
  }
  return Fit::kNone;
}

ir::TypeId signed_holding(const ir::TypeTable& types, uint32_t magnitude_bits) {
  ir::Kind kind = magnitude_bits <= 7    ? ir::Kind::kSint
                  : magnitude_bits <= 15 ? ir::Kind::kInt
                  : magnitude_bits <= 31 ? ir::Kind::kDint
                                         : ir::Kind::kLint;
  return types.elementary(kind);
}

constexpr Traits traits_of_kind(ir::Kind kind, Group group) {
  Traits traits;
  traits.boolean = kind == ir::Kind::kBool;
  traits.bits = group == Group::kBit && kind != ir::Kind::kBool;
  traits.integer = group == Group::kSigned || group == Group::kUnsigned;
  traits.real = group == Group::kReal;
  traits.duration = group == Group::kDuration;
  traits.date = group == Group::kDate;
  traits.character = group == Group::kChar;
  return traits;
}

constexpr Traits kTraits[ir::kElementaryCount] = {
#define ELEMENTARY(id, name, scalar, group) traits_of_kind(ir::Kind::id, Group::group),
#include "ir/types/elementary.def"
#undef ELEMENTARY
};

}  // namespace

std::optional<ir::Kind> kind_of_name(std::string_view name) {
  auto found = kinds_by_name().find(name);
  if (found == kinds_by_name().end()) return std::nullopt;
  return found->second;
}

std::optional<ir::Kind> kind_of_address_name(std::string_view name) {
  if (ir::same_name(name, "PVOID")) return ir::Kind::kUlint;
  if (name.size() > 2 && name.substr(0, 2) == "__") name.remove_prefix(2);
  if (ir::same_name(name, "XINT")) return ir::Kind::kLint;
  if (ir::same_name(name, "UXINT")) return ir::Kind::kUlint;
  if (ir::same_name(name, "XWORD")) return ir::Kind::kLword;
  return std::nullopt;
}

bool is_enum(const ir::TypeTable& types, ir::TypeId type) {
  type = without_range(types, type);
  return type.valid() && types[type].kind == ir::Kind::kEnum;
}

bool is_string(const ir::TypeTable& types, ir::TypeId type) {
  return type.valid() &&
         (types[type].kind == ir::Kind::kString || types[type].kind == ir::Kind::kWstring);
}

bool is_time_of_day(const ir::TypeTable& types, ir::TypeId type) {
  if (!type.valid() || !types.is_scalar(type)) return false;
  const ir::Kind kind = types.root_kind(type);
  return kind == ir::Kind::kTod || kind == ir::Kind::kLtod;
}

Traits traits_of(const ir::TypeTable& types, ir::TypeId type) {
  type = without_range(types, type);
  if (!type.valid()) return {};
  const ir::Kind kind = types[type].kind;
  if (ir::is_elementary(kind)) return kTraits[static_cast<size_t>(kind)];
  Traits traits;
  traits.enumeration = kind == ir::Kind::kEnum;
  return traits;
}

Fit implicit_fit(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to, Dialect dialect) {
  from = without_range(types, from);
  to = without_range(types, to);
  if (from == to) return Fit::kSame;
  if (!from.valid() || !to.valid()) return Fit::kNone;
  if (is_string(types, from) && types[from].kind == types[to].kind) return Fit::kLossless;
  if (!types.is_scalar(from) || !types.is_scalar(to)) return Fit::kNone;
  if (is_enum(types, from) || is_enum(types, to)) return enum_fit(types, from, to, dialect);
  Traits a = traits_of(types, from);
  Traits b = traits_of(types, to);
  if (a.boolean) return b.bits ? Fit::kLossless : Fit::kNone;
  if (a.duration || a.date) return time_fit(types[from].kind, types[to].kind);
  return number_fit(types, from, to, dialect);
}

ir::TypeId common_type(const ir::TypeTable& types, ir::TypeId a, ir::TypeId b, Dialect dialect) {
  a = without_range(types, a);
  b = without_range(types, b);
  if (a == b) return a;
  Fit there = implicit_fit(types, a, b, dialect);
  Fit back = implicit_fit(types, b, a, dialect);
  if (there == Fit::kNone && back == Fit::kNone) return {};
  bool to_b = there == Fit::kSame || there == Fit::kLossless;
  bool to_a = back == Fit::kSame || back == Fit::kLossless;
  if (is_string(types, a)) return types[a].capacity >= types[b].capacity ? a : b;
  if (to_a && to_b) return traits_of(types, a).integer ? a : b;
  if (to_b) return b;
  if (to_a) return a;
  Traits ta = traits_of(types, a);
  Traits tb = traits_of(types, b);
  if (ta.real || tb.real) return types.elementary(ir::Kind::kLreal);
  if (ta.enumeration) return b;
  if (tb.enumeration) return a;
  if (!number_like(ta) || !number_like(tb)) return {};
  return signed_holding(types, std::max(span_of(types, a).bits, span_of(types, b).bits));
}

}  // namespace frontend
