// Addresses that overlap and cannot share bytes, as far as all bodies have to be known for it.
#include <algorithm>
#include <tuple>

#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"
#include "ir/types/address_text.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"

namespace frontend {
namespace {

bool meets(const ir::DirectAddress& a, const ir::DirectAddress& b) {
  return a.area == b.area && a.bit_offset < b.bit_offset + std::max(b.bit_size, 1u) &&
         b.bit_offset < a.bit_offset + std::max(a.bit_size, 1u);
}

// How many instances of each type there are, two standing for more. What is in an instance of a
// derived block is in the derived type too, and counts for it.
class InstanceCounts {
 public:
  InstanceCounts(const ir::TypeTable& types, size_t kinds) : types_(types), counts_(kinds) {}

  void add(ir::TypeId type, uint64_t count) {
    std::vector<std::pair<ir::TypeId, uint64_t>> open{{type, count}};
    while (!open.empty()) {
      auto [at, more] = open.back();
      open.pop_back();
      const ir::Type& part = types_[at];
      if (part.kind == ir::Kind::kArray) {
        for (const ir::Dimension& dim : part.dims) more = std::min(more * dim.count(), kMany);
        open.emplace_back(part.base, more);
        continue;
      }
      if (!types_.has_members(at) || types_.is_reference(at)) continue;
      uint64_t& known = counts_[at.index];
      more = std::min(more, kMany - known);
      if (more == 0) continue;
      known += more;
      for (const ir::Member& member : part.members) {
        if (member.section != ir::Section::kInOut) open.emplace_back(member.type, more);
      }
    }
  }
  uint64_t of(ir::TypeId type) const { return counts_[type.index]; }

  static constexpr uint64_t kMany = 2;

 private:
  const ir::TypeTable& types_;
  std::vector<uint64_t> counts_;  // by type
};

bool keeps_value(ir::DirectArea area) {
  return area == ir::DirectArea::kMarker || area == ir::DirectArea::kOutput;
}

}  // namespace

// Inputs may overlap: nobody writes them.
void SharedAddresses::check() const {
  std::vector<Located> all = sema_.addresses.direct_uses;
  for (const Variable& variable : sema_.declared.variables) {
    const VarDecl* decl = variable.decl;
    const bool located = decl != nullptr && decl->has_address && !decl->incomplete &&
                         decl->levels.count == 0 && variable.type.valid();
    if (!located) continue;
    all.push_back(
        {decl->address, variable.type, variable.name.span, std::string(variable.name.text)});
  }
  check_inputs_in_tests(all);
  check_instances();
  const std::vector<Located>& configured = sema_.addresses.configured;
  if (configured.empty() || sema_.report.has_errors()) return;
  all.insert(all.end(), configured.begin(), configured.end());
  std::erase_if(all, [](const Located& one) { return !keeps_value(one.address.area); });
  std::stable_sort(all.begin(), all.end(), [](const Located& a, const Located& b) {
    return std::tuple(a.address.area, a.address.bit_offset) <
           std::tuple(b.address.area, b.address.bit_offset);
  });
  const ir::Layouts natural = ir::natural_layouts(sema_.program.types);
  struct Furthest {  // of those in front
    const Located* one = nullptr;
    uint64_t end = 0;
  };
  Furthest placed;  // by VAR_CONFIG
  Furthest others;
  for (const Located& one : all) {
    const auto reaches = [&](const Furthest& last) {
      return last.one != nullptr && last.one->address.area == one.address.area &&
             one.address.bit_offset < last.end;
    };
    const Located* last = reaches(placed) ? placed.one : nullptr;
    if (one.configured && last == nullptr && reaches(others)) last = others.one;
    if (last != nullptr && one.configured) report_configured(one, *last);
    if (last != nullptr && !one.configured) report_configured(*last, one);
    Furthest& mine = one.configured ? placed : others;
    const uint64_t end = one.address.bit_offset +
                         ir::located_bits(sema_.program.types, natural, one.type, one.address);
    if (reaches(mine) && end <= mine.end) continue;
    mine = {&one, end};
  }
}

// A fixed %M or %Q of a block is one place for all of its instances, but each has a variable.
void SharedAddresses::check_instances() const {
  if (sema_.report.has_errors() || sema_.for_tests()) return;  // a TEST has one of its own
  const auto places = [&](const PouInfo& pou, VarId id) {
    const Variable& variable = sema_.declared.variables[id.index];
    const VarDecl* decl = variable.decl;
    return pou.decl != nullptr && pou.decl->kind == PouKind::kFunctionBlock && decl != nullptr &&
           decl->has_address && !decl->incomplete && variable.storage == Storage::kMember &&
           keeps_value(decl->address.area);
  };
  std::vector<std::pair<const PouInfo*, VarId>> fixed;
  for (const PouInfo& pou : sema_.declared.pous) {
    for (const VarId id : pou.members) {
      if (places(pou, id)) fixed.emplace_back(&pou, id);
    }
  }
  if (fixed.empty()) return;
  InstanceCounts counts(sema_.program.types, sema_.program.types.size());
  for (const ir::ProgramInstance& program : sema_.program.instances) counts.add(program.type, 1);
  counts.add(sema_.program.globals, 1);
  for (const auto& [pou, id] : fixed) {
    uint64_t instances = 0;
    for (const PouInfo& other : sema_.declared.pous) {
      const bool is_one = other.self.valid() && other.owner == kNoPou &&
                          ask<Objects>().extends(other.number, pou->number);
      if (is_one) instances += counts.of(other.self);
    }
    if (instances < InstanceCounts::kMany) continue;
    const Variable& variable = sema_.declared.variables[id.index];
    error(DiagnosticCode::kBadAddress, variable.name.span,
          "`" + std::string(pou->name) + "." + std::string(variable.name.text) + "` AT " +
              ir::address_text(variable.decl->address) +
              " is one place for several instances, but each has a variable of its own",
          "write AT %M* or %Q* and give each instance its address in VAR_CONFIG, or declare "
          "it in VAR_GLOBAL");
  }
}

void SharedAddresses::report_configured(const Located& one, const Located& other) const {
  const uint32_t line = sema_.sources.locate(other.span.begin).line;
  error(DiagnosticCode::kBadAddress, one.span,
        "`" + one.name + "` AT " + ir::address_text(one.address) + " lies on bytes of `" +
            other.name + "` AT " + ir::address_text(other.address) + " (line " +
            std::to_string(line) + "), but cannot share them: it lies in an instance",
        "give one of them another address");
}

// In tests nothing copies an input into all variables that have its address.
void SharedAddresses::check_inputs_in_tests(const std::vector<Located>& all) const {
  for (const Located& direct : sema_.addresses.direct_uses) {
    const bool input = direct.address.area == ir::DirectArea::kInput;
    if (!input || !is_in_test(sema_.tree, direct.span.begin)) continue;
    for (const Located& other : all) {
      const bool itself = other.span.begin.offset == direct.span.begin.offset;
      if (itself || !meets(other.address, direct.address)) continue;
      error(DiagnosticCode::kBadAddress, direct.span,
            "`" + other.name + "` has this input, too, and is not set by its address",
            "name the variable: `" + other.name + "`, `instance." + other.name + "`");
      break;
    }
  }
}

}  // namespace frontend
