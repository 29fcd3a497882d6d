#include "frontend/sema/declarations/rename_rules.h"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "frontend/lex/characters.h"
#include "frontend/lex/pragma.h"
#include "frontend/sema/names.h"
#include "frontend/sema/quoted.h"
#include "ir/types/old_names.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

using Code = base::DiagnosticCode;

bool is_number(std::string_view text) {
  if (!text.empty() && text[0] == '-') text.remove_prefix(1);
  return !text.empty() && text.size() <= 18 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// `.name`, `[1,-2]`, one after the other.
bool is_part(std::string_view text) {
  if (text.empty()) return false;
  while (!text.empty()) {
    const bool index = text[0] == '[';
    const size_t end = index ? text.find(']') : std::min(text.find_first_of(".[", 1), text.size());
    if (end == std::string_view::npos || (!index && text[0] != '.')) return false;
    std::string_view inside = text.substr(1, end - 1);
    if (inside.empty()) return false;
    if (!index && !std::all_of(inside.begin(), inside.end(), is_name_part)) return false;
    for (size_t at = 0; index && at <= inside.size();) {
      const size_t comma = std::min(inside.find(',', at), inside.size());
      if (!is_number(inside.substr(at, comma - at))) return false;
      at = comma + 1;
    }
    text.remove_prefix(end + (index ? 1 : 0));
  }
  return true;
}

// A name, or one of a part of a variable; `.name` is one of no list and no namespace.
bool is_path(std::string_view text) {
  if (text.starts_with('.')) return is_part(text) && text.find_first_of(".[", 1) == text.npos;
  return !text.empty() && is_name_part(text[0]) && is_part("." + std::string(text));
}

bool has_parts(std::string_view text) { return text.find_first_of(".[") != std::string_view::npos; }

const Attribute* own_rule(const Tree& tree, Range32 attributes) {
  for (uint32_t i = 0; i < attributes.count; ++i) {
    const Attribute& attribute = tree.attributes[attributes.first + i];
    const bool rule = ir::same_name(attribute.name.text, kRenamedAttribute);
    if (rule && attribute.part.empty()) return &attribute;
  }
  return nullptr;
}

// What of a POU's variables goes on from call to call.
bool is_kept(PouKind pou, VarSection section) {
  const bool frame = pou == PouKind::kFunction || pou >= PouKind::kMethod;
  switch (section) {
    case VarSection::kStatic:
    case VarSection::kInstance:
      return true;
    case VarSection::kLocal:
    case VarSection::kInput:
    case VarSection::kOutput:
      return !frame;
    default:
      return false;
  }
}

// What an old name may lead to, beside what is declared at the same place.
enum class Reach : uint8_t {
  kNeighbours,  // nothing
  kParts,       // parts of neighbours
  kProgram,     // and what has another list or namespace
};

class Checker {
 public:
  Checker(const Tree& tree, base::Diagnostics& diagnostics)
      : tree_(tree), diagnostics_(diagnostics) {}

  void run() {
    const bool any = std::any_of(tree_.attributes.begin(), tree_.attributes.end(), is_rule);
    if (!any) return;
    check_file_level();
    for (const PouDecl& pou : tree_.pous) check_pou(pou);
    for (const ConfigDecl& config : tree_.configs) check_configuration(config);
    for (const Attribute& attribute : tree_.attributes) {
      if (!is_rule(attribute) || seen_.contains(attribute.name.span.begin.offset)) continue;
      if (!attribute.part.empty()) {
        report(attribute, "this rule for a part stands before no variable of an area",
               "put it in front of a variable of a program, a function block or VAR_GLOBAL");
        continue;
      }
      report(attribute, "this rule stands before nothing that can be renamed",
             "put it in front of a variable, member, literal, type, POU, step or program instance");
    }
  }

 private:
  using Scope = NameMap<std::string_view>;  // old name -> who has it now

  static bool is_rule(const Attribute& attribute) {
    return ir::same_name(attribute.name.text, kRenamedAttribute);
  }

  void report(const Attribute& rule, std::string text, std::string fix) {
    diagnostics_.add(Code::kBadRename, rule.name.span, std::move(text), std::move(fix));
  }

  void check_file_level() {
    Scope types;
    for (const TypeDecl& decl : tree_.types) {
      check_rule(decl.attributes, decl.name, types, Reach::kProgram);
      if (decl.spec.valid()) check_spec(decl.spec);
    }
    for (const PouDecl& pou : tree_.pous)
      check_rule(pou.attributes, pou.name, types, Reach::kProgram);
    Scope globals;
    for (const VarBlock& block : tree_.globals) check_block(block, globals);
  }

  void check_pou(const PouDecl& pou) {
    Scope variables;
    for (const VarBlock& block : pou.blocks) {
      for (const VarDecl& decl : block.vars) check_variable(pou, block, decl, variables);
    }
    Scope members;
    for (const PouDecl& member : pou.members) {
      check_rule(member.attributes, member.name, members, Reach::kNeighbours);
      check_pou(member);
    }
  }

  void check_variable(const PouDecl& pou, const VarBlock& block, const VarDecl& decl,
                      Scope& variables) {
    if (decl.spec.valid()) check_spec(decl.spec);
    if (is_kept(pou.kind, block.section)) {
      const bool plain = block.section == VarSection::kLocal ||
                         block.section == VarSection::kInput ||
                         block.section == VarSection::kOutput;
      return check_declaration(decl, variables, plain ? Reach::kParts : Reach::kNeighbours);
    }
    const Attribute* rule = own_rule(tree_, decl.attributes);
    if (rule == nullptr || decl.names.empty()) return;
    seen_.insert(rule->name.span.begin.offset);
    report(*rule, quoted(decl.names[0].text) + " keeps no value that a rule could carry over",
           "take the rule away");
  }

  void check_block(const VarBlock& block, Scope& scope) {
    for (const VarDecl& decl : block.vars) {
      if (decl.spec.valid()) check_spec(decl.spec);
      if (block.section == VarSection::kGlobal) check_declaration(decl, scope, Reach::kProgram);
    }
  }

  void check_configuration(const ConfigDecl& config) {
    Scope globals;
    for (const VarBlock& block : config.globals) check_block(block, globals);
    for (const ResourceDecl& resource : config.resources) {
      for (const VarBlock& block : resource.globals) check_block(block, globals);
      Scope programs;
      for (const ProgramDecl& program : resource.programs) {
        check_rule(program.attributes, program.name, programs, Reach::kNeighbours);
      }
    }
  }

  // Structures and enumerations, also those inside others.
  void check_spec(SpecId id) {
    const Spec& spec = tree_[id];
    if (spec.kind == SpecKind::kArray && spec.element.valid()) return check_spec(spec.element);
    Scope members;
    for (const VarDecl& field : spec.fields) {
      if (field.spec.valid()) check_spec(field.spec);
      if (is_bit(field)) check_bit(field, spec);
      check_declaration(field, members, Reach::kNeighbours);
    }
    Scope literals;
    for (const Enumerator& literal : spec.enumerators) {
      check_rule(literal.attributes, literal.name, literals, Reach::kNeighbours);
    }
  }

  bool is_bit(const VarDecl& field) const {
    const Spec* spec = field.spec.valid() ? &tree_[field.spec] : nullptr;
    return spec != nullptr && spec->kind == SpecKind::kNamed &&
           ir::same_name(spec->name.text, "BIT");
  }

  // A bit goes on in its place: two of them cannot change names.
  void check_bit(const VarDecl& field, const Spec& structure) {
    const Attribute* rule = own_rule(tree_, field.attributes);
    if (rule == nullptr || field.names.size() != 1) return;
    const std::string old_names = renamed_from(tree_, field.attributes);
    for (const VarDecl& other : structure.fields) {
      if (!is_bit(other) || &other == &field) continue;
      for (const Name& name : other.names) {
        if (!ir::gives_old_name(old_names, name.text)) continue;
        return report(*rule,
                      quoted(name.text) + " is a BIT of this structure; bits that share a byte " +
                          "cannot change names",
                      "take the rule away, and exchange them where they are used");
      }
    }
  }

  void check_declaration(const VarDecl& decl, Scope& scope, Reach reach) {
    if (reach != Reach::kNeighbours) check_parts(decl, scope);
    const Attribute* rule = own_rule(tree_, decl.attributes);
    if (rule == nullptr || decl.names.empty()) return;
    if (decl.names.size() == 1) return check_rule(decl.attributes, decl.names[0], scope, reach);
    seen_.insert(rule->name.span.begin.offset);
    report(*rule, "this declares several variables, and the rule gives one old name",
           "declare the renamed variable by itself");
  }

  void check_parts(const VarDecl& decl, Scope& scope) {
    for (const Attribute* rule : part_rules(tree_, decl.attributes)) {
      seen_.insert(rule->name.span.begin.offset);
      const std::vector<std::string_view> old_names = quoted_texts(rule->value);
      if (!rule->has_value || !is_part(rule->part) || old_names.size() > kMostOldNames ||
          !std::all_of(old_names.begin(), old_names.end(), is_path)) {
        report(*rule, "this rule cannot be read", "write {renamed '.member' from := 'OldName'}");
      } else if (decl.names.size() != 1) {
        report(*rule, "this declares several variables, and the rule is for a part of one",
               "declare the variable by itself");
      } else {
        for (std::string_view old_name : old_names) {
          const bool first = scope.emplace(old_name, decl.names[0].text).second;
          if (first) continue;
          report(*rule, quoted(old_name) + " has two rules", "keep the rule of what goes on");
        }
      }
    }
  }

  void check_rule(Range32 attributes, const Name& name, Scope& scope, Reach reach) {
    const Attribute* rule = own_rule(tree_, attributes);
    if (rule == nullptr || name.empty()) return;
    seen_.insert(rule->name.span.begin.offset);
    const std::vector<std::string_view> old_names = quoted_texts(rule->value);
    if (!rule->has_value || !std::all_of(old_names.begin(), old_names.end(), is_path)) {
      return report(*rule, "this rule cannot be read",
                    "write {renamed from := 'OldName'}, or several: 'OldName', 'OlderName'");
    }
    if (old_names.size() > kMostOldNames) {
      return report(*rule, "more than " + std::to_string(kMostOldNames) + " old names",
                    "leave out those that no controller has any more");
    }
    for (std::string_view old_name : old_names) {
      if (!check_old_name(*rule, old_name, name, scope, reach)) return;
    }
  }

  bool check_old_name(const Attribute& rule, std::string_view old_name, const Name& name,
                      Scope& scope, Reach reach) {
    if (ir::same_name(old_name, name.text)) {
      report(rule, quoted(name.text) + " is said to be renamed from itself",
             "give the name that it had, or take the rule away");
      return false;
    }
    const bool far = old_name.starts_with('.') && reach != Reach::kProgram;
    if (far || (reach == Reach::kNeighbours && has_parts(old_name))) {
      report(rule, quoted(old_name) + " is a variable of another place",
             "a rule names something of the same place; one before a variable of a program, a "
             "function block or VAR_GLOBAL also names parts of its neighbours, and '.member' "
             "before `from` a part of it; a migration can carry over others");
      return false;
    }
    const auto [other, first] = scope.emplace(old_name, name.text);
    if (first) return true;
    if (other->second == name.text) {
      report(rule, quoted(old_name) + " stands twice in this rule", "take one of them away");
    } else {
      report(rule,
             quoted(other->second) + " and " + quoted(name.text) + " are both renamed from " +
                 quoted(old_name),
             "keep the rule at the one that goes on");
    }
    return false;
  }

  const Tree& tree_;
  base::Diagnostics& diagnostics_;
  std::set<uint32_t> seen_;  // rules by their place
};

}  // namespace

void check_renames(const Tree& tree, base::Diagnostics& diagnostics) {
  Checker(tree, diagnostics).run();
}

std::string renamed_from(const Tree& tree, Range32 attributes) {
  const Attribute* rule = own_rule(tree, attributes);
  if (rule == nullptr || !rule->has_value) return {};
  std::vector<std::string> names;
  for (std::string_view name : quoted_texts(rule->value)) names.emplace_back(name);
  return ir::old_names_rule(names);
}

std::vector<const Attribute*> part_rules(const Tree& tree, Range32 attributes) {
  std::vector<const Attribute*> out;
  for (uint32_t i = 0; i < attributes.count; ++i) {
    const Attribute& attribute = tree.attributes[attributes.first + i];
    const bool rule = ir::same_name(attribute.name.text, kRenamedAttribute);
    if (rule && !attribute.part.empty()) out.push_back(&attribute);
  }
  return out;
}

std::string_view without_dot(std::string_view old_name) {
  return old_name.substr(old_name.starts_with('.') ? 1 : 0);
}

std::string whole_old_names(std::string_view name, std::string_view rule) {
  const size_t dot = name.rfind('.');
  std::vector<std::string> out;
  for (std::string_view old_name : ir::old_names_of(rule)) {
    const bool whole =
        dot == std::string_view::npos || old_name.find('.') != std::string_view::npos;
    out.push_back((whole ? "" : std::string(name.substr(0, dot + 1))) +
                  std::string(without_dot(old_name)));
  }
  return ir::old_names_rule(out);
}

}  // namespace frontend
