// Globals that several RESOURCEs have in common: each is written by one of them, and exchanged.
#include "frontend/sema/configuration/common_uses.h"

#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"
#include "ir/types/plain_data.h"

namespace frontend {
namespace {

void report_writers(const ResourceUses& first, const CommonGlobal& use, const ResourceUses& second,
                    base::SourceSpan also, base::Diagnostics& diagnostics) {
  diagnostics.add({DiagnosticCode::kGlobalTwoResources,
                   also,
                   quoted(use.name) + " is written by RESOURCE " + quoted(first.resource) +
                       " and by RESOURCE " + quoted(second.resource),
                   "let one of them write it, and give the other a global of its own to tell what "
                   "it wants; or declare it inside each RESOURCE",
                   {{use.at, "RESOURCE " + quoted(first.resource) + " writes it here"}}});
}

void compare(const ResourceUses& first, const ResourceUses& second,
             base::Diagnostics& diagnostics) {
  for (const auto& [member, use] : first.globals) {
    const auto found = second.globals.find(member);
    if (found == second.globals.end()) continue;
    if (!use.plain) {
      diagnostics.add(DiagnosticCode::kGlobalNotExchanged, use.declared,
                      quoted(use.name) + " (" + use.type + ") is not exchanged: RESOURCE " +
                          quoted(first.resource) + " and RESOURCE " + quoted(second.resource) +
                          " have one each",
                      "declare it inside the RESOURCE that uses it; exchange values by globals of "
                      "plain types without an address");
    } else if (use.written && found->second.written) {
      report_writers(first, use, second, found->second.at, diagnostics);
    }
  }
  for (const auto& [byte, span] : second.outputs) {
    const auto found = first.outputs.find(byte);
    if (found == first.outputs.end()) continue;
    diagnostics.add({DiagnosticCode::kOutputTwoTasks,
                     span,
                     "output byte %QB" + std::to_string(byte) + " is written by RESOURCE " +
                         quoted(first.resource) + " and by RESOURCE " + quoted(second.resource),
                     "let one RESOURCE write it; the other sets a global that the first reads",
                     {{found->second, "RESOURCE " + quoted(first.resource) + " writes it here"}}});
    return;
  }
}

}  // namespace

bool CommonUses::is_outer(VarId global) const {
  const Variable& variable = sema_.declared.variables[global.index];
  return variable.storage == Storage::kGlobal && variable.index < sema_.declared.outer_globals &&
         variable.section == VarSection::kGlobal && !variable.hidden && !variable.constant &&
         !sema_.library.holds(variable.name.span);
}

std::vector<uint32_t> CommonUses::reached_from(const std::vector<ir::TypeId>& starts) const {
  std::vector<bool> seen(sema_.declared.pous.size());
  std::vector<uint32_t> found;
  const auto add = [&](uint32_t pou) {
    if (!seen[pou]) found.push_back(pou);
    seen[pou] = true;
  };
  for (ir::TypeId type : starts) {
    const auto start = sema_.declared.pou_by_type.find(type);
    if (start != sema_.declared.pou_by_type.end()) add(start->second);
  }
  for (size_t i = 0; i < found.size(); ++i) {
    for (uint32_t callee : sema_.declared.pous[found[i]].callees) add(callee);
  }
  return found;
}

// Code runs when somebody calls it, or an instance of its type exists.
std::vector<bool> CommonUses::other_code() const {
  const ir::Program& program = sema_.program;
  std::vector<bool> seen(sema_.declared.pous.size());
  std::vector<bool> seen_types(program.types.size());
  std::vector<uint32_t> found;
  std::vector<ir::TypeId> types{program.globals};
  const auto add = [&](uint32_t pou) {
    if (!seen[pou]) found.push_back(pou);
    seen[pou] = true;
  };
  for (const ir::ProgramInstance& instance : program.instances) types.push_back(instance.type);
  for (const PouInfo& info : sema_.declared.pous) {
    for (const ir::Migration& row : program.migrations) {
      if (info.id == row.function) add(info.number);
    }
  }
  for (size_t next = 0; next < found.size() || !types.empty();) {
    while (!types.empty()) {
      const ir::TypeId type = types.back();
      types.pop_back();
      if (!type.valid() || seen_types[type.index]) continue;
      seen_types[type.index] = true;
      const auto pou = sema_.declared.pou_by_type.find(type);
      if (pou != sema_.declared.pou_by_type.end()) add(pou->second);
      if (program.types[type].kind == ir::Kind::kArray) types.push_back(program.types[type].base);
      for (const ir::Member& member : program.types[type].members) types.push_back(member.type);
    }
    if (next == found.size()) break;
    for (uint32_t callee : sema_.declared.pous[found[next]].callees) add(callee);
    ++next;
  }
  std::vector<bool> others(program.pous.size(), true);
  for (uint32_t pou : found) {
    const ir::PouId id = sema_.declared.pous[pou].id;
    if (id.valid()) others[id.index] = false;
  }
  return others;
}

ResourceUses CommonUses::of_resource() {
  ResourceUses out;
  ir::Program& program = sema_.program;
  if (sema_.declared.resource == nullptr || sema_.tree.configs[0].resources.size() < 2) return out;
  out.resource = sema_.declared.resource->name.text;
  const ir::Layouts natural = ir::natural_layouts(program.types);
  const auto add = [&](VarId id) -> CommonGlobal& {
    const Variable& variable = sema_.declared.variables[id.index];
    const auto [entry, added] = out.globals.try_emplace(variable.index);
    if (!added) return entry->second;
    const bool plain = !variable.decl->has_address &&
                       ir::plain_signature(program.types, natural, variable.type).has_value();
    entry->second = {std::string(variable.name.text), sema_.report.type_text(variable.type),
                     variable.name.span, plain};
    return entry->second;
  };
  for (const ir::Task& task : program.tasks) {
    if (task.event >= sema_.declared.outer_globals) continue;
    const VarId event = sema_.declared.global_order[task.event];
    if (is_outer(event)) add(event);
  }
  std::vector<ir::TypeId> starts;
  for (const ir::ProgramInstance& instance : program.instances) starts.push_back(instance.type);
  for (const ir::BlockTask& block : program.block_tasks) {
    const ir::TypeId holder = program.instances[block.program].type;
    starts.push_back(program.types[holder].members[block.member].type);
  }
  for (uint32_t pou : reached_from(starts)) {
    for (VarId id : sema_.declared.pous[pou].variables) {
      const VarId external = sema_.declared.variables[id.index].external;
      if (external.valid() && is_outer(external)) add(external);
    }
    for (const OuterUse& use : sema_.declared.pous[pou].outer_uses) {
      CommonGlobal& global = add(use.global);
      if (use.written && !global.written) global.at = use.span;
      global.written = global.written || use.written;
    }
    add_outputs(sema_.declared.pous[pou].writes, natural, out);
  }
  out.other_code = other_code();
  std::erase_if(program.overrides, [&](const ir::Override& row) {
    return out.other_code[row.prototype.index] || out.other_code[row.target.index];
  });
  for (const auto& [member, global] : out.globals) {
    if (global.plain) program.shared.push_back({member, global.written});
  }
  return out;
}

void CommonUses::add_outputs(const std::vector<OutputWrite>& writes, const ir::Layouts& natural,
                             ResourceUses& out) const {
  for (const OutputWrite& write : writes) {
    const uint64_t bits = ir::located_bits(sema_.program.types, natural, write.type, write.address);
    const uint64_t last = (write.address.bit_offset + bits - 1) / 8;
    for (uint64_t byte = write.address.bit_offset / 8; byte <= last; ++byte) {
      out.outputs.try_emplace(static_cast<uint32_t>(byte), write.span);
    }
  }
}

void check_resources(const std::vector<ResourceUses>& resources, base::Diagnostics& diagnostics) {
  for (size_t second = 1; second < resources.size(); ++second) {
    for (size_t first = 0; first < second; ++first) {
      compare(resources[first], resources[second], diagnostics);
    }
  }
}

}  // namespace frontend
