// What `x.name` and `name()` mean where blocks, interfaces and bases have members with code.
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {}  // namespace

// Quiet for plain names.
bool Objects::names_method(const Expr& expr) {
  uint32_t owner = sema_.declared.block_of(scope_);
  if (expr.kind == ExprKind::kName && ask<Variables>().find_variable(expr).valid()) return false;
  if (expr.kind == ExprKind::kMember) {
    if (sema_.namespaces.is_scope(scope_, sema_.tree[expr.operand])) return false;
    owner = receiver(expr.operand);
  }
  return owner != kNoPou && find_code(owner, expr.name.text).code.method != kNoPou;
}

// Was a message given for it?
bool Objects::damaged(ExprId id) {
  return !sema_.namespaces.is_scope(scope_, sema_.tree[id]) && !infer(id).type.valid();
}

// The method or action of that name; nullopt: there is none. Reports when it may not be used.
std::optional<Callee> Objects::method_of(uint32_t owner, const Name& name) {
  if (owner == kNoPou) return std::nullopt;
  const Found found = find_code(owner, name.text);
  if (found.code.method == kNoPou) return std::nullopt;
  Callee callee;
  if (!check_access(sema_.declared.pous[found.code.method], name)) return callee;
  callee.kind = Callee::Kind::kMethod;
  callee.pou = found.code.method;
  return callee;
}

// SUPER^()
Callee Objects::base_body(const Expr& head) {
  Callee callee;
  const uint32_t base = super(head.span);
  if (base == kNoPou) return callee;
  if (sema_.declared.pous[base].decl->kind == PouKind::kClass) {
    error(DiagnosticCode::kNotCallable, head.span,
          quoted(sema_.declared.pous[base].decl->name) + " is a class and has no body",
          "call a method of it");
    return callee;
  }
  callee.kind = Callee::Kind::kBase;
  callee.pou = base;
  return callee;
}

// A function or method inside of itself.
Callee Objects::itself(const Expr& head) {
  Callee callee;
  const PouInfo& own = *scope_.pou;
  if (recursion_depth(*own.decl) == 0) {
    error(DiagnosticCode::kRecursiveCall, head.span, quoted(head.name) + " calls itself",
          "use a loop, or declare how deep it goes: {attribute 'recursion_depth' := '20'}");
    return callee;
  }
  callee.kind = own.owner == kNoPou ? Callee::Kind::kFunction : Callee::Kind::kMethod;
  callee.pou = scope_.number();
  return callee;
}

// A variable, property or method of an instance, or after an interface.
Note Objects::infer_member(const Expr& expr, uint32_t owner, Note note) {
  const bool own = is_own(sema_.tree[expr.operand]);
  const PouInfo& block = sema_.declared.pous[owner];
  if (VarId id = find_variable(owner, expr.name.text); id.valid()) {
    if (block.decl->kind == PouKind::kInterface) return {};  // said where it is declared
    const Variable& variable = resolve(id);
    if (own) {
      check_access(variable.access, variable.pou, expr.name);
      return ask<Expressions>().variable_note(id);
    }
    bool open = variable.access == Access::kPublic || variable.access == Access::kInternal;
    if (in_test() && variable.section != VarSection::kInOut) {
      if (variable.storage == Storage::kGlobal)
        return ask<Expressions>().variable_note(id);  // VAR_STAT
      open = variable.section != VarSection::kExternal;
    }
    open = open || is_read_only(variable);
    if (variable.section == VarSection::kInput || variable.section == VarSection::kOutput || open) {
      sema_.mark_used(id);
      check_access(variable.access, variable.pou, expr.name);
      if (variable.storage == Storage::kGlobal) return ask<Expressions>().variable_note(id);
      note.type = variable.type;
      return note;
    }
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          quoted(expr.name) + (in_test() ? " lies outside of " : " is private to ") +
              quoted(block.decl->name),
          in_test() ? "name the variable that it stands for"
                    : "only VAR_INPUT and VAR_OUTPUT are visible outside; declare it "
                      "there");
    return {};
  }
  if (in_test() && block.names.contains(expr.name.text)) {
    error(DiagnosticCode::kUnknownMember, expr.name.span,
          quoted(expr.name) + " lives only while " + quoted(block.decl->name) + " runs",
          "keep what the test asks for in VAR or VAR_OUTPUT");
    return {};
  }
  if (Found found = find_code(owner, expr.name.text); found.owner != kNoPou) {
    if (found.code.is_property()) return infer_property(expr.name, found);
    error(DiagnosticCode::kNotAValue, expr.name.span,
          quoted(expr.name) + " is a method of " + quoted(block.decl->name),
          "call it: `" + std::string(expr.name.text) + "()`");
    return {};
  }
  error(DiagnosticCode::kUnknownMember, expr.name.span,
        quoted(block.decl->name) + " has no member " + quoted(expr.name),
        is_drawn(expr.name) ? ways_out(block) : suggestion(owner, expr.name.text));
  return {};
}

// Power that leaves a box of a ladder by Q, which no source says.
bool Objects::is_drawn(const Name& name) const {
  const uint32_t file = sema_.sources.file_of(name.span.begin);
  const std::string_view all = sema_.sources.text(file);
  const size_t begin = name.span.begin.offset - sema_.sources.begin(file).offset;
  return all.substr(begin, name.span.end.offset - name.span.begin.offset) != name.text;
}

std::string Objects::ways_out(const PouInfo& block) const {
  std::string outputs;
  std::string first;
  for (VarId id : block.members) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kOutput) continue;
    if (first.empty()) first = variable.name.text;
    outputs += (outputs.empty() ? "" : ", ") + quoted(variable.name);
  }
  if (first.empty()) return "power leaves a box by Q, and this one has no outputs";
  return "power leaves a box by Q; this one has " + outputs + ": write `" + first + "=>_` there";
}

// CODESYS and TwinCAT let others read a VAR; they do not write it.
bool Objects::is_read_only(const Variable& variable) const {
  return sema_.options.dialect != Dialect::kIec && !in_test() &&
         variable.section == VarSection::kLocal && variable.access == Access::kDefault &&
         variable.storage != Storage::kLocal && variable.method.empty() && !variable.hidden;
}

// `f.n`, `f.t.IN`, `f.list[3]`: does the way lead through a VAR of another block? Reports.
bool Objects::refuse_change(ExprId id) {
  for (ExprId at = id; at.valid(); at = sema_.tree[at].operand) {
    const Expr& expr = sema_.tree[at];
    const bool part = expr.kind == ExprKind::kIndex || expr.kind == ExprKind::kBit;
    if (part && !sema_.program.types.is_reference(infer(expr.operand).type)) continue;
    if (expr.kind != ExprKind::kMember) return false;
    if (infer(at).reference.valid() && at != id) return false;
    if (sema_.namespaces.is_scope(scope_, sema_.tree[expr.operand]) ||
        is_own(sema_.tree[expr.operand]))
      return false;
    const uint32_t owner = receiver(expr.operand);
    const VarId variable = owner == kNoPou ? VarId() : find_variable(owner, expr.name.text);
    if (!variable.valid() || !is_read_only(resolve(variable))) continue;
    error(DiagnosticCode::kNotAssignable, expr.name.span,
          quoted(expr.name) + " is private to " + quoted(sema_.declared.pous[owner].decl->name) +
              ", and others only read it",
          "declare it as VAR_INPUT to set it from outside");
    return true;
  }
  return false;
}

VarId Objects::value_of(const PouInfo& accessor) const {
  const auto value = accessor.names.find(accessor.decl->name.text);
  return value == accessor.names.end() ? VarId() : value->second;
}

// Read or written: lowering knows which, and checks that there is GET or SET.
bool Objects::has_own_access(const MemberCode& code) const {
  if (code.getter == kNoPou || code.setter == kNoPou) return false;
  return sema_.declared.pous[code.getter].decl->access !=
         sema_.declared.pous[code.setter].decl->access;
}

Note Objects::infer_property(const Name& name, const Found& found) {
  const bool readable = found.code.getter != kNoPou;
  if (!readable && found.code.setter == kNoPou) return {};  // said where it is declared
  const PouInfo& accessor = sema_.declared.pous[readable ? found.code.getter : found.code.setter];
  // Where GET and SET differ, the code that reads or writes is checked.
  if (!has_own_access(found.code) && !check_access(accessor, name)) return {};
  const VarId value = value_of(accessor);
  if (!value.valid()) return {};  // said where it is declared
  Note note;
  note.property = found.owner;
  note.calls = true;
  note.can_trap = true;
  note.type = resolve(value).type;
  return note;
}

}  // namespace frontend
