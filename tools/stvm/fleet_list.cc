#include "tools/stvm/fleet_list.h"

#include <algorithm>
#include <map>

#include "tools/common/files.h"
#include "tools/common/toml.h"
#include "tools/stvm/agent_answer.h"
#include "tools/stvm/fleet_broker.h"
#include "tools/stvm/fleet_waves.h"

namespace stvm {
namespace {

constexpr std::string_view kTable = "controllers.";

struct Listed {
  FleetMember member;
  uint32_t line = 0;
  uint32_t column = 0;
};

class FleetList {
 public:
  explicit FleetList(const std::string& file) : file_(file) {}

  base::Result<std::vector<FleetMember>> read(std::string_view text) {
    const base::Result<tools::TomlTable> table = tools::parse_toml(file_, text);
    if (!table.ok()) return table.error();
    for (const auto& [key, value] : *table) {
      if (is_roll_key(key) || is_broker_key(key)) continue;
      if (base::Status taken = take(key, value); !taken.ok()) return taken.error();
    }
    std::vector<Listed> rows;
    for (auto& [name, row] : rows_) rows.push_back(std::move(row));
    std::sort(rows.begin(), rows.end(),
              [](const Listed& a, const Listed& b) { return a.line < b.line; });
    std::vector<FleetMember> members;
    for (Listed& row : rows) {
      if (row.member.place.empty()) {
        return mistake(row.line, row.column,
                       "`" + row.member.name + "` has no `dir`, `host` or `agent`");
      }
      members.push_back(std::move(row.member));
    }
    return members;
  }

 private:
  base::Error mistake(uint32_t line, uint32_t column, const std::string& what) const {
    return tools::toml_error(file_, line, column, what);
  }

  base::Status take(const std::string& key, const tools::TomlValue& value) {
    const size_t dot = key.rfind('.');
    if (!key.starts_with(kTable) || dot < kTable.size()) {
      return mistake(value.line, value.column,
                     "`" + key +
                         "` is not known here: each controller is a table "
                         "[controllers.NAME]");
    }
    const std::string name = key.substr(kTable.size(), dot - kTable.size());
    const std::string setting = key.substr(dot + 1);
    Listed& row = rows_[name];
    if (row.member.name.empty() || value.line < row.line) {
      row.line = value.line;
      row.column = value.column;
    }
    if (row.member.name.empty()) row.member.name = name;
    if (setting == "name") return take_text(value, row.member.name);
    if (setting == "allow_loss") return take_flag(value, row.member.allow_loss);
    if (setting == "agent") return take_agent(value, row.member);
    if (setting == "dir" || setting == "host") {
      const bool folder = setting == "dir";
      return take_place(value, folder ? PlaceKind::kFolder : PlaceKind::kHost, row.member);
    }
    return mistake(
        value.line, value.column,
        "`" + setting + "` is not known; a controller has dir, host or agent, name and allow_loss");
  }

  base::Status take_flag(const tools::TomlValue& value, bool& flag) const {
    const bool* const given = std::get_if<bool>(&value.data);
    if (given == nullptr) {
      return mistake(value.place.line, value.place.column, "true or false is wanted");
    }
    flag = *given;
    return base::Ok{};
  }

  base::Status take_text(const tools::TomlValue& value, std::string& text) const {
    const std::string* const given = std::get_if<std::string>(&value.data);
    if (given == nullptr || given->empty()) {
      return mistake(value.place.line, value.place.column, "a text is wanted");
    }
    text = *given;
    return base::Ok{};
  }

  base::Status take_place(const tools::TomlValue& value, PlaceKind kind,
                          FleetMember& member) const {
    if (!member.place.empty()) {
      return mistake(value.line, value.column,
                     "`" + member.name + "` has two of dir, host and agent");
    }
    member.kind = kind;
    return take_text(value, member.place);
  }

  base::Status take_agent(const tools::TomlValue& value, FleetMember& member) const {
    base::Status taken = take_place(value, PlaceKind::kAtAgent, member);
    if (!taken.ok() || is_agent_name(member.place)) return taken;
    return mistake(value.place.line, value.place.column,
                   "a name of letters, digits and . _ - is wanted, as in the trust file there");
  }

  std::string file_;
  std::map<std::string, Listed> rows_;
};

}  // namespace

bool is_at_folder(const FleetMember& member) {
  if (member.kind == PlaceKind::kEither) return tools::is_folder(member.place);
  return member.kind == PlaceKind::kFolder;
}

bool is_at_agent(const FleetMember& member) { return member.kind == PlaceKind::kAtAgent; }

base::Result<std::vector<FleetMember>> read_fleet_list(const std::string& file) {
  base::Result<base::Bytes> bytes = tools::read_bytes(file);
  if (!bytes.ok()) return bytes.error();
  return FleetList(file).read(
      std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
}

base::Result<std::vector<FleetMember>> parse_fleet_list(const std::string& file,
                                                        const std::string& text) {
  return FleetList(file).read(text);
}

base::Result<std::vector<FleetMember>> fleet_members(const tools::Options& options) {
  std::vector<FleetMember> members;
  const auto add = [&](const char* option, PlaceKind kind) {
    for (const std::string& place : options.all(option)) {
      members.push_back({place, place, false, kind});
    }
  };
  add("--dir", PlaceKind::kFolder);
  add("--host", PlaceKind::kHost);
  if (options.has("--fleet")) {
    base::Result<std::vector<FleetMember>> listed = read_fleet_list(options.text("--fleet"));
    if (!listed.ok()) return listed.error();
    members.insert(members.end(), listed->begin(), listed->end());
  }
  for (size_t i = 1; i < members.size(); ++i) {
    for (size_t before = 0; before < i; ++before) {
      if (members[before].name != members[i].name) continue;
      return base::Error{base::Refusal::kUsage,
                         "fleet: two controllers are called `" + members[i].name + "`"};
    }
  }
  if (!members.empty()) return members;
  return base::Error{base::Refusal::kUsage, "fleet: name controllers by --dir, --host or --fleet"};
}

}  // namespace stvm
