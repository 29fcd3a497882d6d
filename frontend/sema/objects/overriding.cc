// What a block must have and may replace: abstract methods, methods of interfaces, OVERRIDE.
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

std::string full_name(const PouInfo& owner, const Name& name) {
  return "`" + std::string(owner.decl->name.text) + "." + std::string(name.text) + "`";
}

// Which of the three a member is.
uint32_t MemberCode::*slot_of(const PouDecl& member) {
  return member.kind == PouKind::kGetter   ? &MemberCode::getter
         : member.kind == PouKind::kSetter ? &MemberCode::setter
                                           : &MemberCode::method;
}

// Who may use it: the more, the higher. Without a word a method is PROTECTED in the standard.
int openness(Access access) {
  switch (access) {
    case Access::kPrivate:
      return 0;
    case Access::kDefault:
    case Access::kProtected:
      return 1;
    case Access::kInternal:
      return 2;
    case Access::kPublic:
      return 3;
  }
  return 3;
}

const char* slot_text(uint32_t MemberCode::*slot) {
  return slot == &MemberCode::getter   ? "GET of property "
         : slot == &MemberCode::setter ? "SET of property "
                                       : "";
}

}  // namespace

// After all interfaces are resolved.
void Objects::check() {
  for (uint32_t i = 0; i < sema_.declared.pous.size(); ++i) {
    const PouInfo& info = sema_.declared.pous[i];
    if (info.owner != kNoPou || !info.self.valid()) continue;
    check_names(info);
    for (const PouDecl& member : info.decl->members) check_member(info, member);
    if (info.decl->kind != PouKind::kFunctionBlock && info.decl->kind != PouKind::kClass) continue;
    check_abstract(info);
    for (ir::TypeId type : std::vector(sema_.program.types[info.self].interfaces)) {
      check_implements(info, sema_.declared.pous[sema_.declared.pou_by_type.find(type)->second]);
    }
  }
}

// A derived block adds to its base's names and hides none.
void Objects::check_names(const PouInfo& info) {
  for (VarId id : info.variables) {
    const Variable& variable = sema_.declared.variables[id.index];
    const std::string_view name = variable.name.text;
    if (!variable.method.empty() || info.base == kNoPou) continue;
    if (!find_variable(info.base, name).valid() && find_code(info.base, name).owner == kNoPou) {
      continue;
    }
    error(DiagnosticCode::kDuplicateName, variable.name.span,
          quoted(variable.name) + " is declared in the base " +
              quoted(sema_.declared.pous[info.base].decl->name) + " already",
          "give it another name; the base's is there too");
  }
}

// A method or accessor against what the bases have under its name.
void Objects::check_member(const PouInfo& info, const PouDecl& decl) {
  const auto known = info.code.find(decl.name.text);
  if (known == info.code.end() || !has_frame(decl.kind)) return;
  uint32_t MemberCode::*const slot = slot_of(decl);
  if (known->second.*slot == kNoPou) return;  // a method with the name of a property
  const PouInfo& method = sema_.declared.pous[known->second.*slot];
  if (method.decl != &decl) return;  // a second one of that name
  if (find_variable(info.base, decl.name.text).valid()) {
    error(DiagnosticCode::kDuplicateName, decl.name.span,
          quoted(decl.name) + " is a variable of the base", "give it another name");
    return;
  }
  const bool concrete = !info.decl->is_abstract && info.decl->kind != PouKind::kInterface;
  if (decl.is_abstract && concrete) {
    error(DiagnosticCode::kNotImplemented, decl.name.span,
          quoted(decl.name) + " is ABSTRACT, but " + quoted(info.decl->name) + " is not",
          "declare the block ABSTRACT, or give the method a body");
  }
  // Each block has its own; nothing calls it virtually.
  if (ir::same_name(decl.name.text, kFbInit)) return;
  const Found inherited = find_code(info.base, decl.name.text);
  if (inherited.owner != kNoPou) return check_override(method, inherited, slot);
  if (!decl.is_override) return;
  error(DiagnosticCode::kBadOverride, decl.name.span,
        quoted(decl.name) + " overrides nothing: no base of " + quoted(info.decl->name) + " has it",
        info.base == kNoPou ? std::string() : suggestion(info.base, decl.name.text));
}

void Objects::check_override(const PouInfo& method, const Found& inherited,
                             uint32_t MemberCode::*slot) {
  const PouInfo& owner = sema_.declared.pous[inherited.owner];
  const Name& name = method.decl->name;
  const bool accessor = slot != &MemberCode::method;
  if (accessor != inherited.code.is_property()) {
    error(DiagnosticCode::kBadOverride, name.span,
          full_name(owner, name) + (accessor ? " is no property" : " is a property"));
    return;
  }
  // A property may get its other accessor here.
  const uint32_t base = inherited.code.*slot;
  if (base == kNoPou) return;
  const PouInfo& replaced = sema_.declared.pous[base];
  const bool hidden = replaced.decl->access == Access::kPrivate;
  if (replaced.decl->is_final || hidden) {
    error(
        DiagnosticCode::kBadOverride, name.span,
        full_name(owner, name) + (hidden ? " is PRIVATE" : " is FINAL") + " and cannot be replaced",
        "give the method another name");
    return;
  }
  if (sema_.options.dialect == Dialect::kIec && !accessor) check_words(method, replaced);
  check_signature(method, replaced, DiagnosticCode::kBadOverride);
  for (uint32_t at = inherited.owner; at != kNoPou; at = sema_.declared.pous[at].base) {
    auto found = sema_.declared.pous[at].code.find(name.text);
    if (found == sema_.declared.pous[at].code.end() || found->second.*slot == kNoPou) continue;
    sema_.declared.pous[found->second.*slot].overrides.push_back(method.number);
  }
}

// What the standard asks of a method that replaces another one (edition 3, 6.6.5.5).
void Objects::check_words(const PouInfo& method, const PouInfo& replaced) const {
  const Name& name = method.decl->name;
  const std::string whose = full_name(sema_.declared.pous[replaced.owner], name);
  if (!method.decl->is_override) {
    error(DiagnosticCode::kBadOverride, name.span,
          quoted(name) + " replaces " + whose + " without OVERRIDE", "write METHOD OVERRIDE");
  }
  if (openness(method.decl->access) >= openness(replaced.decl->access)) return;
  error(DiagnosticCode::kBadOverride, name.span,
        quoted(name) + " is seen by fewer than " + whose + ", which it replaces",
        "give it the same word: PUBLIC, INTERNAL or PROTECTED");
}

// Virtual calls pass arguments by the prototype: order, kind, type and name must agree.
bool Objects::check_signature(const PouInfo& method, const PouInfo& wanted, DiagnosticCode code) {
  auto parameters = [this](const PouInfo& pou) {
    std::vector<VarId> all;
    for (VarId id : pou.locals) {
      if (id == pou.result || is_parameter(sema_.declared.variables[id.index].section))
        all.push_back(id);
    }
    return all;
  };
  const std::vector<VarId> own = parameters(method);
  const std::vector<VarId> theirs = parameters(wanted);
  const std::string whose = full_name(sema_.declared.pous[wanted.owner], wanted.decl->name);
  auto fail = [&](base::SourceSpan span, const std::string& text) {
    error(code, span, text, "declare the same parameters and result as " + whose);
    return false;
  };
  for (size_t i = 0; i < own.size() && i < theirs.size(); ++i) {
    const Variable& a = resolve(own[i]);
    const Variable& b = resolve(theirs[i]);
    if (!a.type.valid() || !b.type.valid()) return false;
    const bool results = own[i] == method.result && theirs[i] == wanted.result;
    const bool same = a.section == b.section &&
                      (own[i] == method.result) == (theirs[i] == wanted.result) &&
                      ir::same_name(a.name.text, b.name.text);
    if (same && a.type == b.type) continue;
    if (same || results) {
      return fail(a.name.span, (results ? "the result" : quoted(a.name)) + " is `" +
                                   sema_.report.type_text(a.type) + "`, in " + whose + " it is `" +
                                   sema_.report.type_text(b.type) + "`");
    }
    return fail(a.name.span, "parameter " + std::to_string(i + 1) + " is not that of " + whose +
                                 ", which has " + quoted(b.name) + " there");
  }
  if (own.size() == theirs.size()) return true;
  const bool more = own.size() > theirs.size();
  const Variable& odd = resolve(more ? own[theirs.size()] : theirs[own.size()]);
  const bool result = odd.decl == nullptr;
  return fail(method.decl->name.span,
              (result ? "the result" : "the parameter " + quoted(odd.name)) +
                  (more ? " is not in " : " is missing, it is in ") + whose);
}

void Objects::check_abstract(const PouInfo& info) {
  if (info.decl->is_abstract) return;
  std::string missing;
  for (uint32_t at = info.base; at != kNoPou; at = sema_.declared.pous[at].base) {
    for (const PouDecl& member : sema_.declared.pous[at].decl->members) {
      if (!member.is_abstract || !has_frame(member.kind)) continue;
      uint32_t MemberCode::*const slot = slot_of(member);
      const Found found = find_code(info.number, member.name.text);
      if (found.code.*slot != kNoPou && found.owner != at) continue;
      missing += (missing.empty() ? "" : ", ") + std::string(slot_text(slot)) +
                 full_name(sema_.declared.pous[at], member.name);
    }
  }
  if (missing.empty()) return;
  error(DiagnosticCode::kNotImplemented, info.decl->name.span,
        quoted(info.decl->name) + " gives no body to " + missing,
        "add it, or declare the block ABSTRACT");
}

void Objects::check_implements(const PouInfo& info, const PouInfo& interface) {
  std::string missing;
  for (const PouDecl& member : interface.decl->members) {
    const auto wanted = interface.code.find(member.name.text);
    if (wanted == interface.code.end() || !has_frame(member.kind)) continue;
    uint32_t MemberCode::*const slot = slot_of(member);
    if (wanted->second.*slot == kNoPou) continue;
    PouInfo& prototype = sema_.declared.pous[wanted->second.*slot];
    if (prototype.decl != &member) continue;
    const Found found = find_code(info.number, member.name.text);
    if (found.code.*slot == kNoPou) {
      if (info.decl->is_abstract) continue;
      missing += (missing.empty() ? "" : ", ") + std::string(slot_text(slot)) + quoted(member.name);
      continue;
    }
    const PouInfo& method = sema_.declared.pous[found.code.*slot];
    prototype.overrides.push_back(method.number);
    const Access access = method.decl->access;
    if (sema_.options.dialect == Dialect::kIec &&
        (access == Access::kPrivate || access == Access::kProtected)) {
      error(DiagnosticCode::kNotImplemented, method.decl->name.span,
            quoted(method.decl->name) +
                (access == Access::kPrivate ? " is PRIVATE" : " is PROTECTED") + ", but " +
                quoted(interface.decl->name) + " lets everybody call it",
            "write METHOD PUBLIC");
    }
    if (found.owner == info.number || !inherits(info, interface)) {
      check_signature(method, prototype, DiagnosticCode::kNotImplemented);
    }
  }
  if (missing.empty()) return;
  error(DiagnosticCode::kNotImplemented, info.decl->name.span,
        quoted(info.decl->name) + " implements " + quoted(interface.decl->name) + " without " +
            missing,
        "add it, or declare the block ABSTRACT");
}

// Does the base implement it already?
bool Objects::inherits(const PouInfo& info, const PouInfo& interface) const {
  return info.base != kNoPou &&
         sema_.program.types.is_a(sema_.declared.pous[info.base].self, interface.self);
}

void Objects::check_instance(ir::TypeId type, base::SourceSpan span) {
  while (sema_.program.types[type].kind == ir::Kind::kArray) type = sema_.program.types[type].base;
  const PouInfo* block = sema_.declared.pou_of(type);
  if (block == nullptr || !block->decl->is_abstract) return;
  error(DiagnosticCode::kAbstractInstance, span,
        "`" + sema_.report.type_text(type) + "` is ABSTRACT and has no instances",
        "declare a block that extends it, or a reference");
}

}  // namespace frontend
