// EXTENDS and IMPLEMENTS: which block or interface is meant, without circles.
#include <algorithm>

#include "base/limits.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/objects/query_interface.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

bool is_block(PouKind kind) { return kind == PouKind::kFunctionBlock || kind == PouKind::kClass; }

void add_once(std::vector<ir::TypeId>& list, ir::TypeId type) {
  if (std::find(list.begin(), list.end(), type) == list.end()) list.push_back(type);
}

}  // namespace

void Objects::inherit() {
  // Grows while library blocks are found.
  for (uint32_t i = 0; i < sema_.declared.pous.size(); ++i) inherit(i, 0);
}

// The block or interface that a name after EXTENDS or IMPLEMENTS means; reports.
uint32_t Objects::named_ancestor(const PouInfo& info, SpecId spec, bool interface) {
  if (is_query_interface(sema_.tree, sema_.tree[spec])) return kNoPou;
  ir::TypeId type = Types(sema_, PouScope(info)).resolve_type(spec).type;
  if (!type.valid()) return kNoPou;
  if (is_interface(sema_.program.types, type)) type = sema_.program.types[type].base;
  const auto found = sema_.declared.pou_by_type.find(type);
  const PouDecl* decl =
      found == sema_.declared.pou_by_type.end() ? nullptr : sema_.declared.pous[found->second].decl;
  const bool good =
      decl != nullptr && (interface ? decl->kind == PouKind::kInterface : is_block(decl->kind));
  if (good) return found->second;
  error(DiagnosticCode::kBadBase, sema_.tree[spec].span,
        "`" + sema_.report.type_text(type) + "` is no " +
            (interface ? "interface" : "function block or class"),
        interface         ? "extend it, or declare an INTERFACE"
        : decl != nullptr ? "write IMPLEMENTS"
                          : "");
  return kNoPou;
}

// Is what `info` is about to inherit from finished? Reports circles and endless chains.
bool Objects::finish_ancestor(const PouInfo& info, uint32_t ancestor, SpecId spec, uint32_t depth) {
  uint32_t length = depth + 1;
  if (depth < base::kMaxNesting) {
    inherit(ancestor, depth + 1);
    if (sema_.declared.pous[ancestor].inheritance != Progress::kDone) {
      error(DiagnosticCode::kBadBase, sema_.tree[spec].span,
            quoted(info.decl->name) + " extends itself" +
                (ancestor == info.number
                     ? std::string()
                     : ", through " + quoted(sema_.declared.pous[ancestor].decl->name)));
      return false;
    }
    length = 1;
    for (uint32_t at = ancestor; at != kNoPou; at = sema_.declared.pous[at].base) ++length;
  }
  if (length <= base::kMaxNesting) return true;
  error(DiagnosticCode::kTooDeep, sema_.tree[spec].span,
        "more than " + std::to_string(base::kMaxNesting) + " bases after each other");
  return false;
}

void Objects::inherit(uint32_t number, uint32_t depth) {
  PouInfo& info = sema_.declared.pous[number];
  if (info.inheritance != Progress::kNew) return;
  info.inheritance = Progress::kBusy;
  const PouDecl& decl = *info.decl;
  const bool interface = decl.kind == PouKind::kInterface;
  std::vector<ir::TypeId> interfaces;
  auto take = [&](uint32_t parent) {
    info.interfaces.push_back(parent);
    add_once(interfaces, sema_.declared.pous[parent].self);
    for (ir::TypeId more : sema_.program.types[sema_.declared.pous[parent].self].interfaces) {
      add_once(interfaces, more);
    }
  };
  for (SpecId spec : decl.extends) {
    const uint32_t ancestor = named_ancestor(info, spec, interface);
    if (ancestor == kNoPou || !finish_ancestor(info, ancestor, spec, depth)) continue;
    if (interface) {
      take(ancestor);
    } else if (is_block(decl.kind) && info.base == kNoPou) {
      set_base(info, ancestor, sema_.tree[spec].span);
      for (ir::TypeId more : sema_.program.types[sema_.declared.pous[ancestor].self].interfaces) {
        add_once(interfaces, more);
      }
    }
  }
  for (SpecId spec : decl.implements) {
    const uint32_t ancestor = named_ancestor(info, spec, true);
    if (ancestor == kNoPou || !is_block(decl.kind)) continue;
    if (finish_ancestor(info, ancestor, spec, depth)) take(ancestor);
  }
  if (info.self.valid() && info.owner == kNoPou) {
    sema_.program.types.edit(info.self).interfaces = std::move(interfaces);
  }
  if (is_block(decl.kind)) add_stamp(info);
  info.inheritance = Progress::kDone;
}

// The members of the base come first.
void Objects::set_base(PouInfo& info, uint32_t number, base::SourceSpan span) {
  const PouInfo& base = sema_.declared.pous[number];
  if (base.decl->is_final) {
    error(DiagnosticCode::kBadBase, span,
          quoted(base.decl->name) + " is FINAL; nothing extends it");
  }
  info.base = number;
  info.inherited = base.inherited + static_cast<uint32_t>(base.members.size());
  constexpr uint32_t kMockMembers = 2;
  if (sema_.for_tests() && base.decl->kind == PouKind::kFunctionBlock) {
    info.inherited += kMockMembers;
  }
  for (VarId id : info.members) sema_.declared.variables[id.index].index += info.inherited;
  sema_.program.types.edit(info.self).base = base.self;
}

}  // namespace frontend
