#include "frontend/sema/declarations/migrations.h"
#include "frontend/sema/types/types.h"

#include <algorithm>
#include <set>

#include "frontend/lex/pragma.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

bool names_pou(ir::Op op) {
  return op == ir::Op::kCallFunction || op == ir::Op::kCallMethod || op == ir::Op::kCallBody ||
         op == ir::Op::kCallVirtual;
}

constexpr std::string_view kGlobalsName = "VAR_GLOBAL";

}  // namespace

void Migrations::refuse(base::SourceSpan span, std::string text, std::string fix) {
  error(DiagnosticCode::kBadMigration, span, std::move(text), std::move(fix));
}

void Migrations::collect() {
  std::set<uint32_t> seen;  // pragmas that stand before a function
  for (size_t i = 0; i < sema_.declared.pous.size(); ++i) {
    PouInfo& info = sema_.declared.pous[i];
    const Attribute* rule = sema_.tree.find_attribute(info.decl->attributes, kMigrationAttribute);
    if (rule == nullptr || info.library) continue;
    seen.insert(rule->name.span.begin.offset);
    add(info, *rule);
  }
  for (const Attribute& attribute : sema_.tree.attributes) {
    const bool stray = ir::same_name(attribute.name.text, kMigrationAttribute) &&
                       !seen.contains(attribute.name.span.begin.offset);
    if (stray) refuse(attribute.name.span, "this stands before no FUNCTION", "put it before one");
  }
}

void Migrations::add(PouInfo& info, const Attribute& rule) {
  if (info.decl->kind != PouKind::kFunction || info.open || info.owner != kNoPou) {
    return refuse(rule.name.span,
                  quoted(info.name) + " is no FUNCTION with parameters of fixed types",
                  "let a FUNCTION compute the values");
  }
  if (!rule.has_value) {
    return refuse(
        rule.name.span, "this pragma cannot be read",
        "write {migration of := 'Type'}, with `, from := 'Other'` where it was of another "
        "type, and `, inverse` for the way back");
  }
  ir::Migration row;
  row.function = info.id;
  row.inverse = rule.marked;
  row.type = type_of(rule);
  if (!row.type.valid() || !read_other(row, rule)) return;
  bool gives = false;
  for (VarId id : info.locals) {
    const Variable& variable = resolve(id);
    const bool parameter = variable.section == VarSection::kInput ||
                           variable.section == VarSection::kOutput ||
                           variable.section == VarSection::kInOut;
    if (!parameter || id == info.result) continue;
    if (!add_value(row, variable)) return;
    gives = gives || variable.section == VarSection::kOutput;
  }
  if (!gives && row.from.empty()) {
    return refuse(info.decl->name.span, quoted(info.name) + " gives no value",
                  "declare VAR_OUTPUT with the name of the variable that it makes");
  }
  sema_.program.migrations.push_back(std::move(row));
}

ir::TypeId Migrations::type_of(const Attribute& rule) {
  if (ir::same_name(rule.value, kGlobalsName)) return sema_.program.globals;
  const PouInfo* found = sema_.declared.find_pou(rule.value);
  const bool good = found != nullptr && found->self.valid() && found->owner == kNoPou &&
                    found->decl->kind != PouKind::kInterface;
  if (good) return found->self;
  const std::optional<TypeUse> type = ask<Types>().find_type(rule.value);
  const ir::TypeTable& types = sema_.program.types;
  const bool structure = type && type->type.valid() &&
                         types[type->type].kind == ir::Kind::kStruct &&
                         !types[type->type].name.empty();
  if (structure && !types.overlaps(type->type)) return type->type;
  refuse(rule.name.span, quoted(rule.value) + " is no program, function block or structure",
         "name the one whose variables migrate, or VAR_GLOBAL");
  return {};
}

// What the running version calls it need not be in the sources any more.
bool Migrations::read_other(ir::Migration& row, const Attribute& rule) {
  if (rule.from.empty()) return true;
  const ir::TypeTable& types = sema_.program.types;
  const std::string& name = types[row.type].name;
  row.from = rule.from;
  ir::TypeId other;
  if (const PouInfo* found = sema_.declared.find_pou(rule.from); found != nullptr) {
    other = found->self;
  } else if (const std::optional<TypeUse> type = ask<Types>().find_type(rule.from)) {
    other = type->type;
  }
  if (other.valid()) row.from = types[other].name;
  const bool is_other = row.type != sema_.program.globals && !ir::same_name(row.from, name);
  if (is_other && (!other.valid() || types[other].kind == types[row.type].kind)) return true;
  refuse(rule.name.span,
         quoted(rule.from) + " is nothing that " + quoted(rule.value) + " can have been",
         "name another type of the same kind: a structure, a function block or a program");
  return false;
}

bool Migrations::add_value(ir::Migration& row, const Variable& variable) {
  const bool input = variable.section == VarSection::kInput;
  if (variable.section == VarSection::kInOut) {
    refuse(variable.name.span, quoted(variable.name.text) + " goes both ways",
           "take VAR_INPUT for what is read and VAR_OUTPUT for what is made");
    return false;
  }
  const bool is_old = input != row.inverse;
  const Attribute* own =
      sema_.tree.find_attribute(variable.decl->attributes, is_old ? "old" : "new");
  const Attribute* wrong =
      sema_.tree.find_attribute(variable.decl->attributes, is_old ? "new" : "old");
  if (wrong != nullptr || (own != nullptr && !own->has_value)) {
    const char* fix = is_old ? "write {old := 'name'}" : "write {new := 'name'}";
    refuse((wrong != nullptr ? wrong : own)->name.span,
           quoted(variable.name.text) + " is a variable of the " + (is_old ? "old" : "new") +
               " version",
           fix);
    return false;
  }
  const std::string name(own != nullptr ? own->value : variable.name.text);
  if (!variable.type.valid()) return false;
  if (!is_plain(variable.type)) {
    refuse(variable.name.span,
           quoted(variable.name.text) + " is a reference or holds one; it would mean nothing here",
           "migrate plain data");
    return false;
  }
  // `.x`, `Main.p.x`: of another area; found when the change is planned, as all of the old version.
  const bool elsewhere = input && name.find_first_of(".[") != std::string::npos &&
                         sema_.program.types.find_member(row.type, name) < 0;
  if (!is_old && !elsewhere && !is_new_member(row, variable, name)) return false;
  const bool twice = std::any_of(row.values.begin(), row.values.end(), [&](const auto& other) {
    return !input && other.output && ir::same_name(other.member, name);
  });
  if (twice) {
    refuse(variable.name.span, quoted(name) + " is given twice", "take one of the outputs away");
    return false;
  }
  row.values.push_back({std::string(variable.name.text), name, !input});
  return true;
}

// What the sources know, they check; the old version is compared when the change is planned.
bool Migrations::is_new_member(const ir::Migration& row, const Variable& variable,
                               const std::string& name) {
  const ir::TypeTable& types = sema_.program.types;
  const int32_t number = types.find_member(row.type, name);
  if (number < 0) {
    refuse(variable.name.span, quoted(types.shown(row.type)) + " has no variable " + quoted(name),
           "give the parameter its name, or write {new := 'name'} before it");
    return false;
  }
  const ir::Member& member = types[row.type].members[static_cast<size_t>(number)];
  if (member.section == ir::Section::kInOut || member.constant || types.is_instance(member.type)) {
    refuse(variable.name.span, quoted(name) + " holds no value that could migrate",
           "name a variable of data");
    return false;
  }
  if (member.type == variable.type) return true;
  refuse(variable.name.span,
         quoted(name) + " is " + types.shown(member.type) + ", " + quoted(variable.name.text) +
             " is " + types.shown(variable.type),
         "declare it as " + types.text(member.type));
  return false;
}

bool Migrations::is_plain(ir::TypeId id) const {
  const ir::TypeTable& types = sema_.program.types;
  return !ir::any_part(types, id, [&](ir::TypeId part) {
    return types.is_reference(part) || types.is_instance(part);
  });
}

void Migrations::check_code() {
  for (const ir::Migration& row : sema_.program.migrations) check_function(row);
}

void Migrations::check_function(const ir::Migration& row) {
  const ir::Program& program = sema_.program;
  std::vector<ir::PouId> reached{row.function};
  std::set<ir::PouId> seen{row.function};
  const PouInfo& info = *std::find_if(sema_.declared.pous.begin(), sema_.declared.pous.end(),
                                      [&](const PouInfo& pou) { return pou.id == row.function; });
  for (size_t i = 0; i < reached.size(); ++i) {
    const ir::Pou& pou = program.pous[reached[i].index];
    for (const ir::Place& place : pou.places) {
      if (place.base != ir::PlaceBase::kGlobal || place.steps.empty()) continue;
      const ir::Member& global = program.types[program.globals].members[place.steps[0].index];
      return refuse(info.decl->name.span,
                    quoted(pou.name) + " uses " + quoted(global.name) +
                        ", but a migration has nothing but its parameters",
                    "take the value as a parameter");
    }
    for (const ir::Block& block : pou.blocks) {
      for (const ir::Inst& inst : block.insts) {
        if (names_pou(inst.op) && seen.insert(inst.pou).second) reached.push_back(inst.pou);
      }
    }
  }
}

}  // namespace frontend
