// Which values a POU sees, and how it writes them down.
#include "tests/differential/builder.h"

namespace differential {

void Builder::forget() {
  places_.clear();
  bits_.clear();
  nameable_.clear();
  prologue_.clear();
  pointers_.clear();
  walkers_.clear();
  receivers_.clear();
  handles_.clear();
  descending_ = false;
  caught_ = 0;
  in_loop_ = 0;
  own_.clear();
  loops_.clear();
  loop_level_ = 0;
  rounds_ = 1;
  guarded_ = false;
}

void Builder::see(const Variable& variable, bool writable, bool constant) {
  see_inside({variable.name, {}, variable.type, writable, constant});
}

void Builder::see_elements(const Place& place, const Type& type) {
  Place element = place;
  element.type = type.base;
  element.pattern += "[";
  const bool open = type.form == Form::kOpenArray;
  for (size_t i = 0; i < type.dims.size(); ++i) {
    if (i > 0) element.pattern += ", ";
    std::string hole = "@" + std::to_string(element.holes.size());
    std::string which = "(" + place.pattern + ", " + std::to_string(i + 1) + ")";
    element.pattern +=
        open ? "LIMIT(LOWER_BOUND" + which + ", " + hole + ", UPPER_BOUND" + which + ")" : hole;
    element.holes.push_back(type.dims[i]);
  }
  element.pattern += "]";
  see_inside(std::move(element));
}

void Builder::see_members(const Place& place, const std::vector<Variable>& members, bool writable) {
  for (const Variable& member : members) {
    Place inside = place;
    inside.pattern += "." + member.name;
    inside.type = member.type;
    inside.writable = inside.writable && writable;
    if (member.bit) {
      bits_.push_back(std::move(inside));
    } else {
      see_inside(std::move(inside));
    }
  }
}

// A value, and all values inside it.
void Builder::see_inside(Place place) {
  // A copy: seeing more may move the table.
  const Type type = program_[place.type];
  if (type.form == Form::kReference) {
    place.type = type.base;
    return see_inside(std::move(place));
  }
  bool list = type.form == Form::kArray || type.form == Form::kOpenArray;
  if (list && place.holes.size() + type.dims.size() <= 4) see_elements(place, type);
  if (type.form == Form::kStruct || type.form == Form::kUnion) {
    see_members(place, members_of(program_, place.type), true);
  }
  if (type.form == Form::kBlock) {
    Place inside = place;
    inside.writable = true;
    see_members(inside, faces_[place.type].inputs, true);
    see_members(inside, faces_[place.type].outputs, false);
  }
  places_[place.type].push_back(std::move(place));
}

const Place* Builder::find(TypeRef type, bool writable) {
  auto found = places_.find(type);
  if (found == places_.end() || found->second.empty()) return nullptr;
  const std::vector<Place>& list = found->second;
  for (int tries = 0; tries < 8; ++tries) {
    const Place& place = list[below(static_cast<uint32_t>(list.size()))];
    if (!writable || (place.writable && !place.constant)) return &place;
  }
  return nullptr;
}

const Place* Builder::find_open(TypeRef open, bool writable) {
  std::vector<TypeRef> fitting;
  for (const auto& [type, list] : places_) {
    const Type& row = program_[type];
    if (row.form == Form::kArray && row.base == program_[open].base &&
        row.dims.size() == program_[open].dims.size()) {
      fitting.push_back(type);
    }
  }
  return fitting.empty() ? nullptr : find(any_of(fitting), writable);
}

const Place* Builder::find_any() {
  for (int tries = 0; tries < 8; ++tries) {
    auto kind = places_.begin();
    std::advance(kind, below(static_cast<uint32_t>(places_.size())));
    if (is(kind->first, Form::kOpenArray)) continue;
    if (const Place* place = find(kind->first, true)) return place;
  }
  return nullptr;
}

const Place* Builder::find_text(bool wide, bool writable) {
  for (int tries = 0; tries < 4 && !strings_.empty(); ++tries) {
    auto kind = strings_.begin();
    std::advance(kind, below(static_cast<uint32_t>(strings_.size())));
    if (kind->first.first != wide) continue;
    if (const Place* place = find(kind->second, writable)) return place;
  }
  return nullptr;
}

// An index that is nearly always in range.
Expr Builder::index(Bounds bounds, int depth) {
  TypeRef kInt = elementary(one_in(4) ? ir::Kind::kDint : ir::Kind::kInt);
  if (depth <= 0 || inside_index_ > 1 || one_in(3)) {
    auto count = static_cast<uint32_t>(bounds.high - bounds.low + 1);
    return constant_text(kInt, std::to_string(bounds.low + below(count)));
  }
  if (trap_in(100)) return read(kInt);
  return small_integer(kInt, bounds.low, bounds.high, depth - 1);
}

Expr Builder::use(const Place& place, int depth) {
  // A copy: building the indices may not disturb it, but keeps it from moving either.
  const Place copy = place;
  Expr expr;
  expr.type = copy.type;
  expr.pattern = copy.pattern;
  expr.constant = copy.constant;
  ++inside_index_;
  for (const Bounds& hole : copy.holes) expr.operands.push_back(index(hole, depth));
  --inside_index_;
  return expr;
}

std::optional<Expr> Builder::variable(TypeRef type) {
  const Place* place =
      is_text(type) ? find_text(is(type, Form::kWstring), false) : find(type, false);
  if (place == nullptr) return std::nullopt;
  return use(*place, 1);
}

std::optional<Expr> Builder::target(TypeRef type) {
  const Place* place = is(type, Form::kOpenArray) ? find_open(type, true) : find(type, true);
  if (place == nullptr) return std::nullopt;
  Expr expr = use(*place, 1);
  expr.fixed = true;
  return expr;
}

Expr Builder::read(TypeRef type) {
  for (int tries = 0; tries < 3; ++tries) {
    std::optional<Expr> found = variable(type);
    if (found && !found->constant) return std::move(*found);
  }
  TypeRef from = elementary(ir::Kind::kDint);
  if (is_number(type) || is_bits(type)) {
    // Every POU has a guard.
    if (type == from) return Expr{type, "guard", {}, false, false};
    return Expr{type, "DINT_TO_" + name_of(type) + "(guard)", {}, false, false};
  }
  return node(type, "SEL(guard > 3, @0, @1)", {literal(type), literal(type)});
}

}  // namespace differential
