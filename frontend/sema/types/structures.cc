// Structures: members, those of the base (EXTENDS), and BIT members, which share bytes.
#include <algorithm>
#include <utility>

#include "frontend/parse/declared_twice.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/old_names.h"
#include "frontend/sema/declarations/rename_rules.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"
#include "ir/types/old_names.h"

namespace frontend {
namespace {

constexpr uint32_t kBitsPerByte = 8;

// Names that the byte of renamed BIT members may have had. The rest are not tried.
constexpr size_t kMostBitNames = 64;

std::string joined_bits(const std::vector<std::string>& names, size_t count) {
  std::string out;
  for (size_t i = 0; i < count; ++i) out += (i == 0 ? "" : "-") + names[i];
  return out;
}

// What the byte was called when its bits had their old names, or when the last of them were not
// there: those come as FALSE. A single bit is not told from another variable of its name.
std::vector<std::string> old_names_of_bits(const std::vector<std::string>& names,
                                           const std::vector<std::string>& rules,
                                           uint64_t defaults) {
  std::vector<std::vector<std::string>> before{{""}};  // by the number of bits
  for (size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> next;
    const std::string choices = rules[i] + (rules[i].empty() ? "" : ",") + names[i];
    for (std::string_view choice : ir::old_names_of(choices)) {
      for (const std::string& name : before.back()) {
        if (next.size() == kMostBitNames) break;
        next.push_back(name + (i == 0 ? "" : "-") + std::string(choice));
      }
    }
    before.push_back(std::move(next));
  }
  std::vector<std::string> out = before.back();
  for (size_t count = names.size(); count-- > 2;) {
    if (defaults >> count == 0) out.insert(out.end(), before[count].begin(), before[count].end());
  }
  const std::string now = joined_bits(names, names.size());
  std::erase_if(out, [&](const std::string& name) { return ir::same_name(name, now); });
  return out;
}

}  // namespace

uint32_t packing_of(const Tree& tree, Range32 attributes) {
  const Attribute* attribute = tree.find_attribute(attributes, kPackMode);
  if (attribute == nullptr) return 0;
  for (std::string_view mode : {"1", "2", "4", "8"}) {
    if (attribute->value == mode) return static_cast<uint32_t>(mode[0] - '0');
  }
  return attribute->value == "0" ? 1 : 0;
}

// A structure on its way into the type table.
struct Types::StructBuild {
  ir::Type type;
  NameMap<StructureField> names;
  int32_t bit_member = -1;  // BIT members still go there
  uint32_t bits = 0;
  uint64_t bit_defaults = 0;
  std::vector<std::string> bit_names;  // of the byte
  std::vector<std::string> bit_rules;  // their old names (ir/types/old_names.h)
};

TypeUse Types::resolve_struct(SpecId id, const Spec& spec) {
  StructBuild build;
  build.type.kind = spec.kind == SpecKind::kUnion ? ir::Kind::kUnion : ir::Kind::kStruct;
  build.type.overlap = spec.kind == SpecKind::kUnion || spec.overlap;
  build.type.capacity = packing_of(sema_.tree, spec.attributes);
  build.type.name = sema_.facts.of(scope_, id).name.text;
  bool good = !spec.element.valid() || add_base(build, spec);
  for (const VarDecl& field : spec.fields) good = add_field(build, field) && good;
  close_bits(build);
  if (!good) return {};
  if (build.type.members.empty()) {
    error(DiagnosticCode::kEmptyList, spec.span, "a structure without members");
    return {};
  }
  if (build.type.overlap && !check_overlap(build.type, spec.span)) return {};
  ir::TypeId made = sema_.facts.of(scope_, id).forward;
  if (made.valid()) {
    sema_.program.types.edit(made) = std::move(build.type);
  } else {
    made = sema_.program.types.declare(std::move(build.type));
  }
  sema_.declared.structures.emplace(made, std::move(build.names));
  return {made, {}};
}

bool Types::add_base(StructBuild& build, const Spec& spec) {
  TypeUse base = resolve_type(spec.element);
  if (!base.type.valid()) return false;
  const bool unions = build.type.kind == ir::Kind::kUnion;
  if (sema_.program.types[base.type].kind != build.type.kind) {
    error(DiagnosticCode::kTypeMismatch, sema_.tree[spec.element].span,
          "`" + sema_.report.type_text(base.type) +
              (unions ? "` is no union; a union extends unions only"
                      : "` is no structure; only structures can be extended"));
    return false;
  }
  build.type.members = sema_.program.types[base.type].members;
  if (build.type.capacity == 0) build.type.capacity = sema_.program.types[base.type].capacity;
  build.names = sema_.declared.structures[base.type];
  return true;
}

// What lies on top of each other must be plain data: an ID of an instance would be damaged.
bool Types::check_overlap(const ir::Type& type, base::SourceSpan span) {
  for (const ir::Member& member : type.members) {
    ir::TypeId inner = member.type;
    while (sema_.program.types[inner].kind == ir::Kind::kArray)
      inner = sema_.program.types[inner].base;
    bool good = !sema_.program.types.is_instance(inner);
    if (good && ir::is_structure(sema_.program.types[inner].kind)) {
      good = check_overlap(sema_.program.types[inner], span);
    } else if (!good) {
      error(DiagnosticCode::kBadReference, span,
            "`" + member.name + "` is an instance of `" + sema_.report.type_text(inner) +
                "` and cannot share its place with other members",
            "keep function blocks outside of unions");
    }
    if (!good) return false;
  }
  return true;
}

bool Types::is_bit(SpecId id) const {
  const Spec& spec = sema_.tree[id];
  return spec.kind == SpecKind::kNamed && spec.qualifiers.count == 0 &&
         ir::same_name(spec.name.text, "BIT") && !sema_.declared.types.contains(spec.name.text);
}

bool Types::add_field(StructBuild& build, const VarDecl& field) {
  TypeUse use = resolve_type(field.spec);
  if (!use.type.valid()) return false;
  if (!field.names.empty()) ask<Objects>().check_instance(use.type, field.names[0].span);
  bool bit = is_bit(field.spec);
  ir::Member member;
  member.type = use.type;
  ask<Variables>().check_binding(field, use.type);
  const Bound bound = build.type.overlap ? Bound::kNow : Bound::kAtStart;
  member.init = use.init;
  if (field.init.valid()) {
    member.init =
        ask<Constants>().initial_value(field.init, use.type, use.init, Known::kInitially, bound);
  }
  if (!bit) close_bits(build);
  if (field.has_address) {
    member.address = field.address;
    if (field.address.area != ir::DirectArea::kNone) {
      if (!ask<Variables>().check_field_address(field, use.type)) return false;
      member.address.bit_offset = ir::kOpenAddress;
      member.address.bit_size = ask<Variables>().address_bits(use.type);
    }
  }
  for (const Name& name : field.names) {
    StructureField where{static_cast<uint32_t>(build.type.members.size()), -1};
    if (bit) where = add_bit(build, name, member.init, renamed_from(sema_.tree, field.attributes));
    where.spec = field.spec;
    where.name = name.span;
    if (auto [other, is_new] = build.names.emplace(name.text, where); !is_new) {
      error(DiagnosticCode::kDuplicateName, name.span,
            declared_twice(sema_.sources, name.text, name.span, other->second.name));
      return false;
    }
    if (bit) continue;
    member.name = name.text;
    member.old_name = ask<OldNames>().of_rule(field.attributes);
    build.type.overlap |= field.has_address && field.address.area == ir::DirectArea::kNone;
    build.type.members.push_back(member);
  }
  return true;
}

// Neighbouring BIT members share a BYTE, which has the names of all of them.
StructureField Types::add_bit(StructBuild& build, const Name& name, ir::ConstId init,
                              std::string rule) {
  if (build.bits == kBitsPerByte) close_bits(build);
  if (build.bit_member < 0) {
    build.bit_member = static_cast<int32_t>(build.type.members.size());
    ir::Member word;
    word.type = sema_.program.types.elementary(ir::Kind::kByte);
    build.type.members.push_back(std::move(word));
  }
  build.bit_names.emplace_back(name.text);
  build.bit_rules.push_back(std::move(rule));
  if (init.valid() && sema_.program.constants[init].bits != 0) {
    build.bit_defaults |= uint64_t{1} << build.bits;
  }
  return {static_cast<uint32_t>(build.bit_member), static_cast<int32_t>(build.bits++)};
}

void Types::close_bits(StructBuild& build) {
  if (build.bit_member >= 0) {
    ir::Member& word = build.type.members[static_cast<size_t>(build.bit_member)];
    word.name = joined_bits(build.bit_names, build.bit_names.size());
    const std::vector<std::string> rules =
        old_names_of_bits(build.bit_names, build.bit_rules, build.bit_defaults);
    word.old_name = ask<OldNames>().add(ir::old_names_rule(rules));
    if (build.bit_defaults != 0) word.init = sema_.program.constants.scalar(build.bit_defaults);
  }
  build.bit_member = -1;
  build.bits = 0;
  build.bit_defaults = 0;
  build.bit_names.clear();
  build.bit_rules.clear();
}

}  // namespace frontend
