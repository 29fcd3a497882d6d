#include "tools/stvm/fleet_diff.h"

#include <map>

#include "base/joined.h"
#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"
#include "ir/types/address_text.h"
#include "tools/common/table.h"

namespace stvm {
namespace {

constexpr base::Digest kNoIdentity{};

struct Variable {
  std::string name;
  std::string text;    // its type and what it is besides
  base::Bytes begins;  // with this value
};
using Variables = std::map<std::string, Variable>;

class VariableTable {
 public:
  explicit VariableTable(const ir::Image& image) : image_(image), types_(*image.types) {}

  Variables run() {
    for (const ir::Member& member : types_[image_.globals].members) add(member.name, member);
    for (uint32_t i = ir::kElementaryCount; i < types_.size(); ++i) {
      const ir::Type& type = types_[ir::TypeId(i)];
      const bool block = type.kind == ir::Kind::kFunctionBlock || type.kind == ir::Kind::kProgram;
      if (type.name.empty() || !block) continue;
      for (const ir::Member& member : type.members) {
        if (ir::is_listed(member)) add(type.name + "." + member.name, member);
      }
    }
    return std::move(variables_);
  }

 private:
  void add(const std::string& name, const ir::Member& member) {
    constexpr const char* kSections[] = {"", " input", " output", " in_out", "", ""};
    std::string text = types_.text(member.type) + kSections[static_cast<size_t>(member.section)];
    if (member.constant) text += " CONSTANT";
    if (member.retain) text += " RETAIN";
    if (member.address.area != ir::DirectArea::kNone) {
      text += " AT " + ir::address_text(member.address);
    }
    base::ByteWriter begins;
    ir::write_canonical(begins, types_, image_.constants, member.type, member.init);
    variables_[base::fold_name(name)] = {name, std::move(text), begins.take()};
  }

  const ir::Image& image_;
  const ir::TypeTable& types_;
  Variables variables_;
};

void add_variables(const Variables& one, const Variables& other, FleetDifference& out) {
  Variables names = one;
  names.insert(other.begin(), other.end());
  for (const auto& [key, variable] : names) {
    const auto before = one.find(key);
    const auto after = other.find(key);
    VariableDifference row{variable.name, before == one.end() ? "" : before->second.text,
                           after == other.end() ? "" : after->second.text, false};
    row.value = before != one.end() && after != other.end() && row.one == row.other;
    if (row.value && before->second.begins == after->second.begins) continue;
    out.variables.push_back(std::move(row));
  }
}

std::string identity_text(const base::Digest& identity) {
  return identity == kNoIdentity ? "-" : base::short_hex(identity);
}

}  // namespace

FleetDifference fleet_difference(const ir::Image& one, const ir::Image& other) {
  FleetDifference out;
  const std::vector<ir::Part> here = ir::parts_of(one);
  const std::vector<ir::Part> there = ir::parts_of(other, one.unit_members);
  std::map<std::pair<ir::PartKind, std::string>, PartDifference> rows;
  for (const ir::Part& part : here) {
    rows[{part.kind, base::fold_name(part.name)}] = {part.kind, part.name, part.identity, {}};
  }
  for (const ir::Part& part : there) {
    PartDifference& row = rows[{part.kind, base::fold_name(part.name)}];
    row.kind = part.kind;
    if (row.name.empty()) row.name = part.name;
    row.other = part.identity;
  }
  for (auto& [key, row] : rows) {
    if (row.one != row.other) out.parts.push_back(std::move(row));
  }
  add_variables(VariableTable(one).run(), VariableTable(other).run(), out);
  return out;
}

std::string difference_text(const FleetDifference& difference) {
  const std::string head = base::joined({"== ", difference.one, " and ", difference.other, "\n"});
  if (difference.parts.empty()) return head + "nothing differs\n";
  tools::Table parts({"part", "one", "other"});
  for (const PartDifference& row : difference.parts) {
    const std::string kind(ir::part_kind_name(row.kind));
    parts.row({row.name.empty() ? kind : kind + " " + row.name, identity_text(row.one),
               identity_text(row.other)});
  }
  if (difference.variables.empty()) return head + parts.text();
  tools::Table variables({"variable", "one", "other"});
  for (const VariableDifference& row : difference.variables) {
    variables.row({row.name, row.one.empty() ? "-" : row.one,
                   row.value           ? "another initial value"
                   : row.other.empty() ? "-"
                                       : row.other});
  }
  return head + parts.text() + "\n" + variables.text();
}

void difference_json(const FleetDifference& difference, tools::JsonWriter& json) {
  json.begin_object().field("one", difference.one).field("other", difference.other);
  json.key("parts").begin_array();
  for (const PartDifference& row : difference.parts) {
    const auto identity = [&](const char* key, const base::Digest& value) {
      json.field(key, value == kNoIdentity ? std::string() : base::to_hex(value));
    };
    json.begin_object().field("kind", std::string(ir::part_kind_name(row.kind)));
    json.field("name", row.name);
    identity("one", row.one);
    identity("other", row.other);
    json.end_object();
  }
  json.end_array().key("variables").begin_array();
  for (const VariableDifference& row : difference.variables) {
    json.begin_object().field("name", row.name).field("one", row.one).field("other", row.other);
    json.field("initial_value", row.value).end_object();
  }
  json.end_array().end_object();
}

}  // namespace stvm
