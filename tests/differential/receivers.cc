// Calls of methods, properties and actions: of the object itself, of instances, through references
// to a base and through interfaces.
#include "tests/differential/builder.h"

namespace differential {

// Instances of a family, and what leads to them with dynamic calls.
void Builder::objects(Pou& pou) {
  if (families_.empty() || !one_in(2)) return;
  const Family family = families_[below(count(families_))];
  Handles out;
  out.family = family;
  for (TypeRef type : family.concrete) {
    out.instances.push_back(declare(pou, Section::kLocal, type, false));
  }
  auto variable = [&](const char* prefix, TypeRef type) {
    Variable one{fresh(prefix), type};
    section(pou, Section::kLocal).variables.push_back(one);
    return one.name;
  };
  auto first = [&] { return out.instances[below(count(out.instances))].name; };
  const std::string contract = family.contract.name;
  out.face = variable("itf", named(Form::kInterface, contract, kNoType));
  out.asked = variable("asked", named(Form::kInterface, family.wide, kNoType));
  prologue_.push_back(simple(out.face + " := " + first() + ";", {}));
  receivers_.push_back({out.face + ".", family.contract});
  if (!family.self.empty()) {
    receivers_.push_back({out.face + "." + family.self + "().", family.contract});
  }
  std::string base = name_of(family.base);
  TypeRef pointer = named(Form::kPointer, "POINTER TO " + base, family.base);
  out.pointer = variable("base", pointer);
  prologue_.push_back(simple(out.pointer + " := ADR(" + first() + ");", {}));
  see_inside({out.pointer + "^", {}, family.base});
  out.down = variable("down", named(Form::kPointer, "POINTER TO " + name_of(family.concrete.back()),
                                    family.concrete.back()));
  if (one_in(2)) {
    std::string alias =
        variable("alias", named(Form::kReference, "REFERENCE TO " + base, family.base));
    prologue_.push_back(simple(alias + " REF= " + first() + ";", {}));
    see_inside({alias, {}, family.base});
  }
  handles_.push_back(std::move(out));
}

std::optional<std::pair<Expr, Interface>> Builder::any_receiver() {
  if (!receivers_.empty() && one_in(2)) {
    const Receiver& one = receivers_[below(count(receivers_))];
    return std::pair{Expr{kNoType, one.text, {}, false, true}, one.face};
  }
  std::vector<TypeRef> seen;
  for (const auto& [type, face] : faces_) {
    bool any = !face.methods.empty() || !face.properties.empty() || !face.actions.empty();
    if (any && places_.contains(type)) seen.push_back(type);
  }
  if (seen.empty()) return std::nullopt;
  const Place* place = find(any_of(seen), false);
  if (place == nullptr) return std::nullopt;
  Interface face = faces_[place->type];
  std::erase_if(face.methods, [](const Interface& one) { return !one.visibility.empty(); });
  Expr instance = use(*place, 1);
  instance.pattern += ".";
  instance.type = kNoType;
  instance.fixed = true;
  return std::pair{std::move(instance), std::move(face)};
}

// A call with that result, or the value of a property.
std::optional<Expr> Builder::method_call(TypeRef type, int depth) {
  for (int tries = 0; tries < 4; ++tries) {
    auto found = any_receiver();
    if (!found) return std::nullopt;
    auto& [receiver, face] = *found;
    for (const Variable& one : face.properties) {
      if (one.type == type && one_in(2)) return node(type, "@0" + one.name, {receiver});
    }
    for (const Interface& one : face.methods) {
      if (one.result != type || (one.recursive && descending_) || !one_in(2)) continue;
      std::optional<std::vector<Expr>> args = arguments(one, false, depth - 1);
      if (!args) continue;
      Expr list = node(kNoType, "@*", std::move(*args));
      return node(type, "@0" + one.name + "(@1)", {receiver, std::move(list)});
    }
  }
  return std::nullopt;
}

std::optional<Stmt> Builder::method_statement(int depth) {
  auto found = any_receiver();
  if (!found) return std::nullopt;
  auto& [receiver, face] = *found;
  if (!face.properties.empty() && one_in(3)) {
    const Variable& one = face.properties[below(count(face.properties))];
    return simple("@0" + one.name + " := @1;", {receiver, expression(one.type, depth)});
  }
  if (!face.actions.empty() && one_in(3)) {
    return simple("@0" + face.actions[below(count(face.actions))] + "();", {receiver});
  }
  if (face.methods.empty()) return std::nullopt;
  const Interface& one = face.methods[below(count(face.methods))];
  if (one.recursive && descending_) return std::nullopt;
  std::optional<std::vector<Expr>> args = arguments(one, false, depth);
  if (!args) return std::nullopt;
  Expr list = node(kNoType, "@*", std::move(*args));
  return simple("@0" + one.name + "(@1);", {receiver, std::move(list)});
}

// Another instance behind a handle, or the question what stands there.
std::optional<Stmt> Builder::rebind() {
  if (handles_.empty()) return std::nullopt;
  const Handles& one = handles_[below(count(handles_))];
  const std::string instance = one.instances[below(count(one.instances))].name;
  switch (below(4)) {
    case 0:
      return simple(one.face + " := " + instance + ";", {});
    case 1:
      return simple(one.pointer + " := ADR(" + instance + ");", {});
    case 2:
      return tested(one);
    default:
      return asked(one);
  }
}

// down ?= itf; IF down <> NULL THEN ...
Stmt Builder::tested(const Handles& one) {
  Stmt out;
  out.tail = "END_IF;";
  Clause roof{"IF TRUE THEN", {}, {}, false};
  const char* sources[] = {one.face.c_str(), one.pointer.c_str(), "NULL"};
  roof.body.push_back(simple(one.down + " ?= " + sources[below(one_in(4) ? 3 : 2)] + ";", {}));
  Stmt inner;
  inner.tail = "END_IF;";
  inner.clauses.push_back({"IF " + one.down + " <> NULL THEN", {}, {}, false});
  receivers_.push_back({one.down + "^.", faces_[one.family.concrete.back()]});
  std::erase_if(receivers_.back().face.methods,
                [](const Interface& face) { return !face.visibility.empty(); });
  std::optional<Stmt> call = method_statement(1);
  receivers_.pop_back();
  inner.clauses[0].body.push_back(call ? std::move(*call) : assignment());
  roof.body.push_back(std::move(inner));
  out.clauses.push_back(std::move(roof));
  return out;
}

Stmt Builder::asked(const Handles& one) {
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back(
      {"IF __QUERYINTERFACE(" + one.face + ", " + one.asked + ") THEN", {}, {}, false});
  out.clauses[0].body.push_back(simple(one.face + " ?= " + one.asked + ";", {}));
  if (one_in(3)) {
    out.clauses[0].head = "IF __QUERYPOINTER(" + one.face + ", " + one.down + ") THEN";
    out.clauses[0].body[0] = simple(one.pointer + " := " + one.down + ";", {});
  } else if (one_in(2)) {
    out.clauses[0].body.push_back(
        simple("spare := SEL(" + one.asked + " = " + one.face + ", spare, spare + 1);", {}));
  }
  return out;
}

}  // namespace differential
