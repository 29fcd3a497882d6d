#include "frontend/sema/declarations/made_names.h"

#include <algorithm>

#include "frontend/lex/lexer.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sfc/declare.h"
#include "ir/types/old_names.h"

namespace frontend {
namespace {

using Names = std::vector<std::string>;

// Of one variable; more would not fit what a rule may say.
constexpr size_t kMost = 64;

// Each name goes on with each of the pieces; beyond the limit with the first alone. Takes no more
// time where a text is long.
void append_any(Names& names, const Names& pieces) {
  const size_t count = names.size();
  for (size_t k = 1; k < pieces.size() && (k + 1) * count <= kMost; ++k) {
    for (size_t i = 0; i < count; ++i) names.push_back(names[i] + pieces[k]);
  }
  for (size_t i = 0; i < count; ++i) names[i] += pieces[0];
}

// Each of the first with each of the second.
Names joined(const Names& fronts, const Names& ends) {
  Names out;
  for (const std::string& front : fronts) {
    for (const std::string& end : ends) {
      if (out.size() < kMost) out.push_back(front + end);
    }
  }
  return out;
}

// In a list of old names a comma stands between two of them.
bool can_be_listed(std::string_view name) {
  uint32_t depth = 0;
  for (const char c : name) {
    if (c == '[') ++depth;
    if (c == ']' && depth > 0) --depth;
    if (c == ';' || (c == ',' && depth == 0)) return false;
  }
  return true;
}

void add_old_names(Names& out, std::string_view rule) {
  for (std::string_view old_name : ir::old_names_of(rule)) {
    const bool path = old_name.find_first_of(".[") != std::string_view::npos;
    if (!path) out.emplace_back(old_name);
  }
}

// What stands after the last dot follows in the type.
struct Walk {
  ir::TypeId type;
  std::string_view list;  // of globals, which were named last
};

}  // namespace

MadeNames::MadeNames(Sema& sema, const Variable& variable)
    : Phase(sema, variable.pou == kNoPou ? PouScope() : PouScope(sema.declared.pous[variable.pou])),
      variable_(variable) {}

VarId MadeNames::global_in_list(std::string_view list, std::string_view name) const {
  const auto found = sema_.declared.lists.find(list);
  if (found == sema_.declared.lists.end()) return {};
  const auto global = found->second.names.find(name);
  return global == found->second.names.end() ? VarId() : global->second;
}

// Every name in it as it is and as it was.
Names MadeNames::of_operand(std::string_view text) const {
  base::Diagnostics unheard;
  Names out{""};
  std::vector<Walk> outer;  // in front of open brackets
  Walk at;
  size_t end = 0;
  bool after_dot = false;
  for (const Token& token : lex(text, {0}, unheard).tokens) {
    const std::string_view piece = text.substr(token.begin, token.length);
    const std::string gap(text.substr(end, token.begin - end));
    end = token.begin + token.length;
    Names pieces{gap + std::string(piece)};
    Names before;
    if (piece == "[") {
      outer.push_back(std::exchange(at, {}));
    } else if (piece == "]" && !outer.empty()) {
      at = outer.back();
      outer.pop_back();
      const bool array = at.type.valid() && sema_.program.types[at.type].kind == ir::Kind::kArray;
      at.type = array ? sema_.program.types[at.type].base : ir::TypeId();
    } else if (is_name(token.kind)) {
      VarId id;
      if (!after_dot) {
        id = Variables(sema_, scope_).find_variable(Name{piece, {}});
        at = {{}, id.valid() ? std::string_view() : piece};
      } else if (!at.list.empty()) {
        id = global_in_list(at.list, piece);
        at.list = {};
      } else if (at.type.valid() && sema_.program.types.has_members(at.type)) {
        const int32_t number = sema_.program.types.find_member(at.type, piece);
        const ir::Member* const member =
            number < 0 ? nullptr : &sema_.program.types[at.type].members[size_t(number)];
        if (member != nullptr && member->old_name.valid())
          add_old_names(before, sema_.program.types.old_name(member->old_name));
        at.type = member == nullptr ? ir::TypeId() : member->type;
      }
      if (id.valid()) {
        const Variable* variable = &sema_.declared.variables[id.index];
        if (variable->external.valid())
          variable = &sema_.declared.variables[variable->external.index];
        at.type = variable->type;
        if (variable->decl != nullptr)
          add_old_names(before, renamed_from(sema_.tree, variable->decl->attributes));
      }
    } else if (piece != ".") {
      at = {};
    }
    after_dot = piece == ".";
    for (const std::string& old_name : before) pieces.push_back(gap + old_name);
    append_any(out, pieces);
  }
  return out;
}

// "Block.", where it has a base, and "Action."; `front` begins behind them then.
Names MadeNames::prefixes(std::string_view& front) const {
  const PouInfo& block = *scope_.pou;
  const auto takes = [&](std::string_view name) {
    const bool there = front.size() > name.size() && front[name.size()] == '.' &&
                       ir::same_name(front.substr(0, name.size()), name);
    if (there) front.remove_prefix(name.size() + 1);
    return there;
  };
  const auto with_dot = [](std::string_view now, std::string_view rule) {
    Names out{std::string(now) + "."};
    for (std::string_view old_name : ir::old_names_of(rule))
      out.push_back(std::string(last_name(old_name)) + ".");
    return out;
  };
  const std::string_view own = block.decl->name.text;
  const bool derived = !block.decl->extends.empty() && takes(own);
  const bool may_extend = block.decl->kind == PouKind::kFunctionBlock;
  Names out = may_extend ? with_dot(own, block.old_name) : Names();
  if (derived) {
    // What a base remembers has the other name, and keeps it.
    bool of_base = false;
    for (uint32_t at = block.base; at != kNoPou; at = sema_.declared.pous[at].base) {
      of_base = of_base ||
                sema_.declared.pous[at].names.contains(variable_.name.text.substr(own.size() + 1));
    }
    if (!of_base) out.emplace_back();
  } else {
    out.insert(out.begin(), "");
  }
  for (const PouDecl& member : block.decl->members) {
    if (member.kind != PouKind::kAction || !takes(member.name.text)) continue;
    return joined(out, with_dot(member.name.text, renamed_from(sema_.tree, member.attributes)));
  }
  return out;
}

Names MadeNames::before() const {
  const std::string_view name = variable_.name.text;
  Names out;
  if (variable_.decl == nullptr || scope_.pou == nullptr) return out;
  if (name.ends_with(sfc::kRecordSuffix)) {
    const std::string_view action = name.substr(0, name.find('#'));
    out = joined(of_operand(action), {sfc::kRecordSuffix});
  }
  if (name.ends_with(sfc::kClock)) {
    std::string_view front = name;
    out = joined(prefixes(front), {sfc::kClock});
  }
  for (const std::string_view edge : {"#rising", "#falling"}) {
    const size_t at = name.find(edge);
    if (at == std::string_view::npos) continue;
    std::string_view front = name.substr(0, at);
    const std::string_view rest = name.substr(at + edge.size());
    const size_t target_end = std::min(rest.find('#', 1), rest.size());
    out = variable_.method.empty() ? prefixes(front) : Names{""};
    out = joined(joined(out, of_operand(front)), {std::string(edge)});
    if (!rest.empty()) {
      out = joined(joined(out, {"#"}), of_operand(rest.substr(1, target_end - 1)));
      out = joined(out, {std::string(rest.substr(target_end))});
    }
    break;
  }
  std::erase_if(
      out, [&](const std::string& one) { return ir::same_name(one, name) || !can_be_listed(one); });
  return out;
}

}  // namespace frontend
