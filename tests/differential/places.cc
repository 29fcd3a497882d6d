// Which values a POU sees, and how it writes them down.
#include "tests/differential/builder.h"

namespace differential {

void Builder::forget() {
  places_.clear();
  loops_.clear();
  loop_level_ = 0;
  rounds_ = 1;
  guarded_ = false;
}

void Builder::see(const Variable& variable, bool writable, bool constant) {
  see_inside({variable.name, {}, variable.type, writable, constant});
}

// A value, and all values inside it.
void Builder::see_inside(Place place) {
  const Type& type = program_[place.type];
  if (type.form == Form::kArray && place.holes.size() + type.dims.size() <= 4) {
    Place element = place;
    element.type = type.base;
    element.pattern += "[";
    for (const Bounds& dim : type.dims) {
      if (element.pattern.back() != '[') element.pattern += ", ";
      element.pattern += "@" + std::to_string(element.holes.size());
      element.holes.push_back(dim);
    }
    element.pattern += "]";
    see_inside(std::move(element));
  }
  if (type.form == Form::kStruct) {
    for (const Variable& member : type.members) {
      Place inside = place;
      inside.pattern += "." + member.name;
      inside.type = member.type;
      see_inside(std::move(inside));
    }
  }
  if (type.form == Form::kBlock) {
    const Interface& face = faces_[place.type];
    auto members = [&](const std::vector<Variable>& list, bool writable) {
      for (const Variable& member : list) {
        Place inside = place;
        inside.pattern += "." + member.name;
        inside.type = member.type;
        inside.writable = writable;
        see_inside(std::move(inside));
      }
    };
    members(face.inputs, true);
    members(face.outputs, false);
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

const Place* Builder::find_text(bool wide, bool writable) {
  for (int tries = 0; tries < 4; ++tries) {
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
  if (one_in(100)) return read(kInt);
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
  const Place* place = find(type, true);
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
