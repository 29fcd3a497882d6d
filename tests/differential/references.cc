// References: what they lead to is a value like any other. They are set at the beginning of the
// body, so that they lead nowhere only when a statement in between says so.
#include <algorithm>

#include "tests/differential/builder.h"

namespace differential {
namespace {

constexpr int kTries = 4;

}  // namespace

void Builder::references(Pou& pou) {
  if (!nodes_.empty() && one_in(2) && !(iec_ && has_frame())) link_nodes(pou);
  for (uint32_t n = below(4); n > 0; --n) refer(pou);
  if (one_in(2)) walk(pou);
}

Variable Builder::unseen(Pou& pou, Section kind, TypeRef type) {
  Variable variable{fresh("p"), type, std::nullopt, {}, {}};
  section(pou, kind).variables.push_back(variable);
  return variable;
}

std::string Builder::address_word(TypeRef pointer) const {
  return program_[pointer].name.starts_with("REF_TO") ? "REF" : "ADR";
}

void Builder::refer(Pou& pou) {
  const Place* found = find_any();
  if (found == nullptr) return;
  const TypeRef target = found->type;
  Expr to = use(*found, 1);
  to.fixed = true;
  bool pointer = is(target, Form::kPointer) || !one_in(3);
  TypeRef type = pointer ? pointer_to(target)
                         : named(Form::kReference, "REFERENCE TO " + name_of(target), target);
  bool temporary = !has_frame() && one_in(5);
  const bool from_start = !temporary && bound_at_start(to) && one_in(2);
  Variable variable = unseen(pou, temporary ? Section::kTemp : Section::kLocal, type);
  if (from_start) {
    std::string word = pointer ? address_word(type) + "(@0)" : "@0";
    section(pou, Section::kLocal).variables.back().initial = node(kNoType, word, {to});
  }
  std::string set = variable.name + (pointer ? " := " + address_word(type) + "(@0);" : " REF= @0;");
  if (!from_start) prologue_.push_back(simple(std::move(set), {std::move(to)}));
  pointers_.push_back(variable);
  if (pointer) places_[type].push_back({variable.name, {}, type});
  see_inside({variable.name + (pointer ? "^" : ""), {}, target});
}

// Can it be where a reference begins? A variable that is there before any code runs.
bool Builder::bound_at_start(const Expr& to) const {
  const std::string name = to.pattern.substr(0, to.pattern.find_first_of(".["));
  auto is_it = [&](const auto& one) { return one.name == name; };
  return to.operands.empty() && to.pattern.find('^') == std::string::npos &&
         (std::any_of(global_variables_.begin(), global_variables_.end(), is_it) ||
          std::any_of(own_.begin(), own_.end(), [&](const Seen& one) {
            return one.variable.name == name && !is(one.variable.type, Form::kReference);
          }));
}

// Two nodes that lead to each other.
void Builder::link_nodes(Pou& pou) {
  TypeRef type = any_of(nodes_);
  Variable next;
  for (const Variable& member : program_[type].members) {
    if (is(member.type, Form::kPointer)) next = member;
  }
  std::string names[2];
  for (std::string& name : names) {
    name = declare(pou, Section::kLocal, type, false).name;
    see_inside({name + "." + next.name + "^", {}, type});
  }
  for (int i = 0; i < 2; ++i) {
    prologue_.push_back(simple(
        names[i] + "." + next.name + " := " + address_word(next.type) + "(" + names[1 - i] + ");",
        {}));
  }
}

// Through the bytes of something as through an array of another type.
void Builder::walk(Pou& pou) {
  for (int tries = 0; tries < kTries; ++tries) {
    const Place* found = find_any();
    if (found == nullptr) continue;
    const Type& row = program_[found->type];
    bool wide = row.form == Form::kWstring;
    std::optional<uint32_t> bytes = bytes_of(found->type);
    if (is_text(found->type)) bytes = row.capacity * (wide ? 2 : 1);
    TypeRef element = row.form == Form::kArray && one_in(2) ? row.base : any_elementary();
    if (is_text(found->type)) element = elementary(wide ? ir::Kind::kWord : ir::Kind::kByte);
    std::optional<uint32_t> step = bytes_of(element);
    if (!bytes || !step || *bytes < *step) continue;
    Expr to = use(*found, 1);
    to.fixed = true;
    TypeRef type = named(Form::kPointer, "POINTER TO " + name_of(element), element);
    Walker walker{unseen(pou, Section::kLocal, type).name,
                  unseen(pou, Section::kLocal, type).name,
                  {},
                  name_of(element),
                  *bytes / *step,
                  *step};
    Section passing = has_frame() ? Section::kLocal : Section::kTemp;
    walker.number =
        unseen(pou, passing, elementary(one_in(2) ? ir::Kind::kDword : ir::Kind::kLword)).name;
    prologue_.push_back(simple(walker.begin + " := ADR(@0);", {std::move(to)}));
    prologue_.push_back(simple(walker.runner + " := " + walker.begin + ";", {}));
    see_inside({walker.begin + "[@0]", {{0, walker.elements - 1}}, element});
    see_inside({walker.runner + "^", {}, element});
    walkers_.push_back(std::move(walker));
    return;
  }
}

// What an input leads to, or a variable of its own when that is nothing.
void Builder::own_target(Pou& pou, const Variable& parameter) {
  TypeRef target = program_[parameter.type].base;
  std::string own = declare(pou, Section::kLocal, target, false).name;
  Variable pointer = unseen(pou, Section::kLocal, parameter.type);
  prologue_.push_back(
      simple(pointer.name + " := " + address_word(parameter.type) + "(" + own + ");", {}));
  Stmt given;
  given.tail = "END_IF;";
  given.clauses.push_back({"IF " + parameter.name + " <> NULL THEN", {}, {}, false});
  given.clauses[0].body.push_back(simple(pointer.name + " := " + parameter.name + ";", {}));
  prologue_.push_back(std::move(given));
  pointers_.push_back(pointer);
  see_inside({pointer.name + "^", {}, target});
}

std::optional<Expr> Builder::address_of(TypeRef pointer, int depth) {
  const Place* place = find(program_[pointer].base, true);
  if (place == nullptr) return std::nullopt;
  Expr to = use(*place, depth);
  to.fixed = true;
  return node(pointer, address_word(pointer) + "(@0)", {std::move(to)});
}

Expr Builder::pointer_value(TypeRef type, int depth) {
  if (one_in(12)) return literal(type);
  std::optional<Expr> found = one_in(3) ? variable(type) : std::nullopt;
  if (!found) found = address_of(type, depth);
  return found ? std::move(*found) : literal(type);
}

std::optional<Expr> Builder::pointer_test(int depth) {
  TypeRef boolean = elementary(ir::Kind::kBool);
  if (!walkers_.empty() && one_in(3)) {
    static constexpr const char* kCompare[] = {" = ", " <> ", " < ", " >= "};
    const Walker& walker = walkers_[below(count(walkers_))];
    return node(boolean, "(" + walker.runner + kCompare[below(4)] + walker.begin + ")", {});
  }
  if (pointers_.empty()) return std::nullopt;
  const Variable& one = pointers_[below(count(pointers_))];
  if (is(one.type, Form::kReference) || one_in(4)) {
    return node(boolean, "__ISVALIDREF(" + one.name + ")", {});
  }
  return node(boolean, "(" + one.name + (one_in(2) ? " = @0)" : " <> @0)"),
              {pointer_value(one.type, depth)});
}

std::optional<Stmt> Builder::retarget() {
  if (pointers_.empty()) return std::nullopt;
  const Variable& one = pointers_[below(count(pointers_))];
  if (is(one.type, Form::kReference)) {
    std::optional<Expr> to = target(program_[one.type].base);
    if (!to) return std::nullopt;
    return simple(one.name + " REF= @0;", {std::move(*to)});
  }
  if (trap_in(4)) return simple(one.name + " := NULL;", {});
  std::optional<Expr> to = one_in(2) ? variable(one.type) : address_of(one.type, 1);
  if (!to) return std::nullopt;
  return simple(one.name + " := @0;", {std::move(*to)});
}

// Over the end of what is walked, or before its beginning, and back; a program that may trap can
// leave the runner there.
Stmt Builder::excursion(const Walker& walker) {
  const std::string element = "SIZEOF(" + walker.element + ")";
  const bool before = walker.elements >= 4 && one_in(3);
  const std::string away = before ? " - " + element + ";"
                                  : " + " + element + " * " + std::to_string(walker.elements) + ";";
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back({"IF TRUE THEN", {}, {}, false});
  std::vector<Stmt>& both = out.clauses[0].body;
  both.push_back(simple(walker.runner + " := " + walker.begin + away, {}));
  if (trap_in(6)) return out;
  Expr distance = small_integer(elementary(ir::Kind::kDint), 1, walker.elements, 1);
  both.push_back(
      simple(walker.runner + " := " + walker.runner + (before ? " + " : " - ") + element + " * @0;",
             {std::move(distance)}));
  return out;
}

// The runner goes to another element, sometimes between two; also by way of a number.
std::optional<Stmt> Builder::step() {
  if (walkers_.empty()) return std::nullopt;
  const Walker& walker = walkers_[below(count(walkers_))];
  if (one_in(4)) return excursion(walker);
  TypeRef number = elementary(one_in(2) ? ir::Kind::kUdint : ir::Kind::kDint);
  int64_t last = walker.elements - 1;
  bool whole = one_in(2);
  Expr distance = small_integer(number, 0, whole ? last : last * walker.step, 1);
  std::string sum = whole ? "SIZEOF(" + walker.element + ") * @0;" : "@0;";
  if (!one_in(3) || iec_) {
    return simple(walker.runner + " := " + walker.begin + " + " + sum, {std::move(distance)});
  }
  Stmt out;
  out.tail = "END_IF;";
  out.clauses.push_back({"IF TRUE THEN", {}, {}, false});
  std::vector<Stmt>& both = out.clauses[0].body;
  both.push_back(simple(walker.number + " := " + walker.begin + ";", {}));
  both.push_back(
      simple(walker.runner + " := " + walker.number + " + " + sum, {std::move(distance)}));
  return out;
}

}  // namespace differential
