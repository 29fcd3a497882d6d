// Families of function blocks or classes: an interface, a base, what extends it. They are complete
// before anything else uses them, and a method calls only methods of its object that have a lower
// rank, so that whatever a virtual call reaches, nothing calls itself.
#include <algorithm>

#include "tests/differential/builder.h"

namespace differential {

// What outside calls may name.
Interface Builder::method_face(const char* prefix) {
  Interface face;
  face.name = fresh(prefix);
  face.rank = next_rank_++;
  if (!one_in(4)) face.result = any_data();
  for (uint32_t n = below(3); n > 0; --n) {
    Variable input{fresh("v"), any_data()};
    if (one_in(3)) input.initial = initial(input.type);
    face.inputs.push_back(std::move(input));
  }
  if (one_in(3)) face.outputs.push_back({fresh("v"), any_data()});
  if (one_in(3)) face.in_outs.push_back({fresh("v"), any_data()});
  return face;
}

void Builder::family() {
  Family out;
  out.plain = one_in(4);
  out.abstract = one_in(3);
  for (uint32_t n = 1 + below(2); n > 0; --n) out.helpers.push_back(method_face("Help"));
  if (one_in(2)) out.helpers[0].visibility = "PROTECTED ";
  if (one_in(3)) {
    Interface& down = out.helpers.emplace_back(method_face("Down"));
    down.recursive = true;
    down.inputs.insert(down.inputs.begin(), {"depth", elementary(ir::Kind::kInt)});
  }
  for (uint32_t n = 1 + below(2); n > 0; --n) out.contract.methods.push_back(method_face("Do"));
  if (one_in(2)) out.self = fresh("Self");
  if (one_in(2)) out.contract.properties.push_back({fresh("Prop"), any_scalar()});
  declare_contract(out);
  std::vector<Class> chain;
  for (uint32_t n = 2 + below(2); n > 0; --n) {
    const bool first = chain.empty();
    chain.push_back(declare_class(first ? nullptr : &chain[below(count(chain))], out, n == 1));
    const TypeRef type = chain.back().face.block;
    if (first) out.base = type;
    if (first && out.abstract) continue;
    out.concrete.push_back(type);
  }
  for (const Class& one : chain) {
    const bool abstract = out.abstract && one.face.block == out.base;
    if (!abstract) blocks_.push_back(one.face);
  }
  families_.push_back(std::move(out));
}

void Builder::declare_contract(Family& family) {
  Interface& contract = family.contract;
  auto declare = [&](std::string relations, const std::vector<Interface>& methods) {
    Pou pou;
    pou.kind = PouKind::kInterface;
    pou.name = fresh("Contract");
    contract.name = place_in_space(pou);
    pou.relations = std::move(relations);
    for (const Interface& face : methods) pou.methods.push_back(head_of(face));
    return pou;
  };
  const bool chains = !family.self.empty();
  std::vector<Interface> first = contract.methods;
  std::vector<Interface> rest;
  const bool two = first.size() > 1 && one_in(2);
  if (two) {
    rest.push_back(first.back());
    first.pop_back();
  }
  Pou pou = declare("", first);
  for (const Variable& one : contract.properties) {
    pou.members.push_back(simple("PROPERTY " + one.name + " : " + name_of(one.type) +
                                     " GET END_GET SET END_SET END_PROPERTY",
                                 {}));
  }
  program_.pous.push_back(std::move(pou));
  family.wide = contract.name;
  if (two) program_.pous.push_back(declare(" EXTENDS " + contract.name, rest));
  if (chains) program_.pous.back().methods.push_back(self_method(family, false));
}

// Gives the object itself: calls of its methods can be chained.
Pou Builder::self_method(const Family& family, bool with_body) {
  Pou pou;
  pou.kind = PouKind::kMethod;
  pou.name = family.self;
  pou.result = named(Form::kInterface, family.contract.name, kNoType);
  if (with_body) pou.body.push_back(simple(family.self + " := THIS^;", {}));
  return pou;
}

// The parameters, with no body.
Pou Builder::head_of(const Interface& face) {
  Pou pou;
  pou.kind = PouKind::kMethod;
  pou.name = face.name;
  pou.result = face.result;
  for (const Variable& one : face.inputs) section(pou, Section::kInput).variables.push_back(one);
  for (const Variable& one : face.outputs) section(pou, Section::kOutput).variables.push_back(one);
  for (const Variable& one : face.in_outs) section(pou, Section::kInOut).variables.push_back(one);
  return pou;
}

Class Builder::declare_class(const Class* base, const Family& family, bool last) {
  forget();
  kind_ = PouKind::kFunctionBlock;
  rounds_ = 4;
  Class out;
  if (base != nullptr) out = *base;
  Pou pou;
  pou.kind = family.plain ? PouKind::kClass : PouKind::kFunctionBlock;
  pou.name = fresh("Class");
  out.face.name = place_in_space(pou);
  const bool abstract = base == nullptr && family.abstract;
  pou.words = abstract ? "ABSTRACT " : last && one_in(3) ? "FINAL " : "";
  pou.relations =
      base == nullptr ? " IMPLEMENTS " + family.contract.name : " EXTENDS " + base->face.name;
  out.face.callable = !family.plain;
  own_ = out.seen;
  loops_ = out.loops;
  see_own(out);
  if (!family.plain) class_parameters(pou, out.face);
  locals(pou, 2 + below(3));
  instances(pou);
  out.seen = own_;
  out.loops = loops_;
  Type type;
  type.form = Form::kBlock;
  type.name = out.face.name;
  out.face.block = add_type(std::move(type));
  if (construction_ && one_in(3)) construct(pou, out.face, base);
  class_methods(pou, out, base, family);
  class_members(pou, out, base, family);
  if (!family.plain) {
    forget();
    kind_ = PouKind::kFunctionBlock;
    see_own(out);
    loops_ = out.loops;
    own_receivers(out, base, next_rank_);
    body(pou, 2 + below(3), 2);
    if (base != nullptr && one_in(2)) pou.body.insert(pou.body.begin(), simple("SUPER^();", {}));
  }
  faces_[out.face.block] = out.face;
  if (base != nullptr) derived_[base->face.block].push_back(out.face.block);
  program_.pous.push_back(std::move(pou));
  return out;
}

void Builder::class_parameters(Pou& pou, Interface& face) {
  for (uint32_t n = below(3); n > 0; --n) {
    face.inputs.push_back(declare(pou, Section::kInput, any_data()));
  }
  for (uint32_t n = below(2); n > 0; --n) {
    face.outputs.push_back(declare(pou, Section::kOutput, any_data(), false));
  }
}

void Builder::see_own(const Class& one) {
  for (const Seen& seen : one.seen) see(seen.variable, seen.writable, seen.constant);
}

void Builder::class_methods(Pou& pou, Class& out, const Class* base, const Family& family) {
  std::vector<Interface> all = family.helpers;
  all.insert(all.end(), family.contract.methods.begin(), family.contract.methods.end());
  const bool abstract = base == nullptr && family.abstract;
  if (base == nullptr) {
    if (!family.self.empty()) pou.methods.push_back(self_method(family, true));
    out.face.methods.clear();
    for (const Interface& face : all) out.face.methods.push_back(face);
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const Interface& face = all[i];
    const bool of_contract = i >= family.helpers.size();
    if (abstract && of_contract && one_in(2)) {
      Pou head = head_of(face);
      head.words = (iec_ ? "PUBLIC " : "") + std::string("ABSTRACT ");
      pou.methods.push_back(std::move(head));
      out.missing.push_back(face.name);
      continue;
    }
    const bool owed = std::erase(out.missing, face.name) > 0;
    if (base != nullptr && !owed && !one_in(2)) continue;
    pou.methods.push_back(method(out, face, base));
  }
}

Pou Builder::method(const Class& owner, const Interface& face, const Class* base) {
  forget();
  kind_ = PouKind::kMethod;
  rounds_ = face.recursive ? kMaxRounds : 8;
  see_own(owner);
  Pou pou = head_of(face);
  pou.words = visibility_words(face);
  if (base != nullptr && (one_in(2) || iec_)) pou.words += "OVERRIDE ";
  for (const Variable& one : face.inputs) see(one, false);
  for (const Variable& one : face.outputs) see(one, true);
  for (const Variable& one : face.in_outs) see(one, true);
  own_.clear();
  locals(pou, 1 + below(2));
  if (one_in(2)) declare(pou, Section::kInst, any_data());
  references(pou);
  own_receivers(owner, base, face.rank);
  if (face.recursive) descend(pou, face, "THIS^.");
  body(pou, 2 + below(2), 1);
  if (pou.result != kNoType && possible(pou.result)) {
    pou.body.push_back(simple(pou.name + " := @0;", {expression(pou.result, 2)}));
  }
  return pou;
}

// Methods of the object itself that may be called from one of that rank.
void Builder::own_receivers(const Class& owner, const Class* base, uint32_t rank) {
  auto add = [&](const char* text, const Interface& face, uint32_t below_rank) {
    Receiver out{text, face};
    std::erase_if(out.face.methods, [&](const Interface& one) { return one.rank >= below_rank; });
    if (!out.face.methods.empty()) receivers_.push_back(std::move(out));
  };
  add("THIS^.", owner.face, rank);
  add("", owner.face, rank);
  if (base == nullptr) return;
  Interface above = base->face;
  std::erase_if(above.methods, [&](const Interface& one) {
    const std::vector<std::string>& missing = base->missing;
    return std::find(missing.begin(), missing.end(), one.name) != missing.end();
  });
  above.properties.clear();
  add("SUPER^.", above, rank + 1);
}

// Properties and actions: code that shares the loop counters of the body has no loops.
void Builder::class_members(Pou& pou, Class& out, const Class* base, const Family& family) {
  if (base == nullptr) out.face.properties = family.contract.properties;
  std::vector<Variable> properties = out.face.properties;
  if (base == nullptr && one_in(2)) properties.push_back({fresh("Prop"), any_scalar()});
  for (const Variable& one : properties) {
    if (base == nullptr || one_in(3)) pou.members.push_back(property(out, one));
  }
  out.face.properties = properties;
  if (passes_addresses(pou) || !one_in(2)) return;
  pou.members.push_back(action(out.seen, fresh("Act")));
  std::string head = pou.members.back().clauses[0].head;
  out.face.actions.push_back(head.substr(7, head.size() - 8));
}

void Builder::without_loops(const std::vector<Seen>& seen) {
  forget();
  kind_ = PouKind::kMethod;
  for (const Seen& one : seen) see(one.variable, one.writable, one.constant);
  for (const Variable& global : global_variables_) see(global, true);
  guarded_ = true;
}

// With actions VAR_TEMP are members, and an address in a number does not follow its instance.
bool Builder::passes_addresses(const Pou& pou) const {
  for (const VarBlock& block : pou.blocks) {
    for (const Variable& one : block.variables) {
      bool number =
          one.type == elementary(ir::Kind::kDword) || one.type == elementary(ir::Kind::kLword);
      if (block.section == Section::kTemp && number) return true;
    }
  }
  return false;
}

Stmt Builder::action(const std::vector<Seen>& seen, const std::string& name) {
  without_loops(seen);
  Stmt out;
  out.tail = "END_ACTION";
  out.clauses.push_back({"ACTION " + name + ":", {}, statements(1 + below(2), 1), false});
  return out;
}

Stmt Builder::property(const Class& owner, const Variable& one) {
  Stmt out;
  out.tail = "END_SET END_PROPERTY";
  without_loops(owner.seen);
  std::vector<Stmt> get = statements(below(2), 0);
  get.push_back(simple(one.name + " := @0;", {expression(one.type, 2)}));
  out.clauses.push_back(
      {std::string(iec_ ? "PROPERTY PUBLIC " : "PROPERTY ") + one.name + " : " + name_of(one.type) +
           " GET",
       {},
       std::move(get),
       false});
  without_loops(owner.seen);
  see(one, false);
  std::vector<Stmt> set = statements(1, 0);
  if (std::optional<Expr> to = target(one.type)) {
    set.push_back(simple("@0 := " + one.name + ";", {std::move(*to)}));
  }
  out.clauses.push_back({"END_GET SET", {}, std::move(set), false});
  return out;
}

// FB_Init with parameters of its own.
void Builder::construct(Pou& pou, Interface& face, const Class* base) {
  Pou init;
  init.kind = PouKind::kMethod;
  init.name = "FB_Init";
  init.result = elementary(ir::Kind::kBool);
  forget();
  kind_ = PouKind::kMethod;
  rounds_ = kMaxRounds;
  std::vector<Variable>& inputs = section(init, Section::kInput).variables;
  inputs.push_back({"bInitRetains", init.result});
  inputs.push_back({"bInCopyCode", init.result});
  const bool derived = base != nullptr && base->face.constructed;
  std::vector<Variable> own;
  // FB_Init of the base runs first there, with the arguments that it has parameters for.
  if (derived && !iec_) own = base->face.construction;
  for (uint32_t n = below(3); n > 0; --n) {
    Variable one{fresh("v"), any_scalar()};
    if (one_in(3)) one.initial = literal(one.type, true);
    own.push_back(std::move(one));
  }
  inputs.insert(inputs.end(), own.begin(), own.end());
  for (const VarBlock& block : pou.blocks) {
    bool lasting = block.section == Section::kLocal || block.section == Section::kOutput;
    for (const Variable& one : block.variables) {
      bool set = program_[one.type].form < Form::kPointer;  // references lead nowhere yet
      if (lasting && set && !is_counter_name(one.name)) see(one, true);
    }
  }
  for (const Variable& one : own) see(one, false);
  locals(init, 1);
  if (derived && (iec_ || one_in(3))) {
    std::string given = construction_arguments(base->face.block);
    std::string all = "SUPER^.FB_Init(bInitRetains, bInCopyCode";
    all += given.empty() ? ")" : ", " + given.substr(1);
    init.body.push_back(simple(all + ";", {}));
  }
  for (Stmt& one : statements(2 + below(2), 1)) init.body.push_back(std::move(one));
  for (const Variable& one : own) {
    std::optional<Expr> to = target(one.type);
    if (to) init.body.push_back(simple("@0 := " + one.name + ";", {std::move(*to)}));
  }
  face.constructed = true;
  face.construction = std::move(own);
  pou.methods.push_back(std::move(init));
}

std::string Builder::construction_arguments(TypeRef type) {
  while (is(type, Form::kArray)) type = program_[type].base;
  auto face = faces_.find(type);
  if (face == faces_.end() || face->second.construction.empty()) return {};
  std::string out;
  bool named = one_in(2);
  for (const Variable& one : face->second.construction) {
    if (named && one.initial && one_in(2)) continue;
    if (!out.empty()) out += ", ";
    out += (named ? one.name + " := " : "") + text(literal(one.type));
  }
  return out.empty() ? out : "(" + out + ")";
}

}  // namespace differential
