#include "tools/common/fleet_parts.h"

#include "ir/bytecode/verify.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"
#include "tools/common/table.h"

namespace tools {
namespace {

constexpr base::Digest kNobody{};

std::string identity_text(const base::Digest& identity) {
  return identity == kNobody ? "-" : base::short_hex(identity);
}

base::Result<ir::VerifiedImage> verified(const base::Bytes& bytes, const char* which) {
  base::Result<ir::VerifiedImage> image = ir::verify(bytes);
  if (image.ok()) return image;
  return base::Error{image.error().refusal,
                     std::string("fleet file, ") + which + ": " + image.error().text};
}

}  // namespace

base::Result<FleetParts> parts_of(const online_change::FleetFile& file) {
  auto original = verified(file.original, "its original version");
  if (!original.ok()) return original.error();
  auto edited = verified(file.edited, "its edited version");
  if (!edited.ok()) return edited.error();
  const ir::UnitMembers& units = edited->image().unit_members;
  FleetParts parts{ir::parts_of(original->image(), units), ir::parts_of(edited->image()), {}, {}};
  parts.edited_image.emplace(std::move(*edited));
  parts.free_table = file.free_table;
  return parts;
}

std::vector<online_change::TableEdit> own_table_edits(const FleetParts& parts,
                                                      const ir::Image& own) {
  if (parts.free_table) return {};
  return online_change::table_edits(own, parts.edited_image->image(),
                                    online_change::TableSide::kOwn);
}

base::Result<OpenedFleetFile> open_fleet_file(const std::string& path) {
  base::Result<base::Bytes> bytes = read_content(path);
  if (!bytes.ok()) return bytes.error();
  base::Result<online_change::FleetFile> file = online_change::decode_fleet_file(*bytes);
  if (!file.ok()) return file.error();
  base::Result<FleetParts> parts = parts_of(*file);
  if (!parts.ok()) return parts.error();
  return OpenedFleetFile{std::move(*file), online_change::fleet_digest(*bytes), std::move(*parts)};
}

std::string part_change_name(const ir::PartEdit& edit) {
  if (edit.original == kNobody) return "added";
  return edit.edited == kNobody ? "removed" : "edited";
}

std::string_view part_state_name(ir::PartState state) {
  switch (state) {
    case ir::PartState::kOk:
      return "ok";
    case ir::PartState::kHasIt:
      return "has it";
    case ir::PartState::kMissing:
      return "missing";
    case ir::PartState::kDifferent:
      return "different";
  }
  return "different";
}

std::string part_edits_text(const std::vector<ir::PartEdit>& edits, bool here) {
  std::vector<std::string> titles = {"part", "change", "from", "to"};
  if (here) titles.insert(titles.end(), {"here", "state"});
  Table table(titles);
  for (const ir::PartEdit& edit : edits) {
    std::vector<std::string> row = {
        std::string(ir::part_kind_name(edit.kind)) + (edit.name.empty() ? "" : " " + edit.name),
        part_change_name(edit), identity_text(edit.original), identity_text(edit.edited)};
    if (here) {
      row.push_back(identity_text(edit.here));
      row.emplace_back(part_state_name(edit.state));
    }
    table.row(row);
  }
  return table.text();
}

void own_table_json(const std::vector<online_change::TableEdit>& edits, JsonWriter& json) {
  json.begin_array();
  for (const online_change::TableEdit& edit : edits) {
    json.begin_object().field("variable", edit.path);
    json.field("change", online_change::table_change_name(edit.change));
    json.field("what", edit.what).end_object();
  }
  json.end_array();
}

void part_edits_json(const std::vector<ir::PartEdit>& edits, bool here, JsonWriter& json) {
  json.begin_array();
  for (const ir::PartEdit& edit : edits) {
    json.begin_object().field("kind", std::string(ir::part_kind_name(edit.kind)));
    json.field("name", edit.name).field("change", part_change_name(edit));
    const auto identity = [&](const char* key, const base::Digest& value) {
      json.field(key, value == kNobody ? std::string() : base::to_hex(value));
    };
    identity("original", edit.original);
    identity("edited", edit.edited);
    if (here) {
      identity("here", edit.here);
      json.field("state", std::string(part_state_name(edit.state)));
    }
    json.end_object();
  }
  json.end_array();
}

}  // namespace tools
