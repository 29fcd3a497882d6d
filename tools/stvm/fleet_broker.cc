#include "tools/stvm/fleet_broker.h"

#include <algorithm>
#include <ctime>

#include "base/joined.h"
#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/package_making.h"

namespace stvm {
namespace {

constexpr std::string_view kBrokerTable = "broker.";

struct BrokerKey {
  std::string_view name;
  std::string& (*of)(FleetBroker&);
};
constexpr BrokerKey kBrokerKeys[] = {
    {"url", [](FleetBroker& b) -> std::string& { return b.settings.url; }},
    {"ca", [](FleetBroker& b) -> std::string& { return b.settings.ca; }},
    {"certificate", [](FleetBroker& b) -> std::string& { return b.settings.certificate; }},
    {"key", [](FleetBroker& b) -> std::string& { return b.settings.key; }},
    {"user", [](FleetBroker& b) -> std::string& { return b.settings.user; }},
    {"password_file", [](FleetBroker& b) -> std::string& { return b.settings.password_file; }},
    {"prefix", [](FleetBroker& b) -> std::string& { return b.prefix; }},
    {"files", [](FleetBroker& b) -> std::string& { return b.files; }},
    {"files_folder", [](FleetBroker& b) -> std::string& { return b.files_folder; }},
};

base::Status take_key(const std::string& file, const std::string& name,
                      const tools::TomlValue& value, FleetBroker& out) {
  const std::string* const text = std::get_if<std::string>(&value.data);
  for (const BrokerKey& key : kBrokerKeys) {
    if (key.name != name) continue;
    const bool fits =
        text != nullptr && !text->empty() && (name != "prefix" || is_topic_prefix(*text));
    if (!fits) {
      return tools::toml_error(
          file, value.place.line, value.place.column,
          name == "prefix" ? "a prefix has letters, digits and . _ - / only" : "a text is wanted");
    }
    key.of(out) = *text;
    return base::Ok{};
  }
  return tools::toml_error(file, value.line, value.column,
                           "`" + name +
                               "` is not known; [broker] has url, ca, certificate, key, user, "
                               "password_file, prefix, files and files_folder");
}

}  // namespace

bool is_broker_key(const std::string& key) { return key.starts_with(kBrokerTable); }

base::Result<FleetBroker> parse_broker(const std::string& file, const std::string& text) {
  const base::Result<tools::TomlTable> table = tools::parse_toml(file, text);
  if (!table.ok()) return table.error();
  FleetBroker out;
  for (const auto& [key, value] : *table) {
    if (!is_broker_key(key)) continue;
    base::Status taken = take_key(file, key.substr(kBrokerTable.size()), value, out);
    if (!taken.ok()) return taken.error();
  }
  if (!out.settings.url.empty()) return out;
  return tools::toml_error(file, 1, 1, "it has no [broker] with a url");
}

base::Result<FleetBroker> read_broker(const std::string& file) {
  base::Result<std::string> text = tools::read_text(file);
  if (!text.ok()) return text.error();
  return parse_broker(file, *text);
}

std::string broker_text(const FleetBroker& broker) {
  FleetBroker copy = broker;
  std::string out = "[broker]\n";
  for (const BrokerKey& key : kBrokerKeys) {
    const std::string& value = key.of(copy);
    if (value.empty()) continue;
    out += base::joined({key.name, " = ", tools::toml_quoted(value), "\n"});
  }
  return out;
}

namespace {

base::Result<base::Bytes> sign_for_agent(base::ByteSpan order, const std::string& target,
                                         const std::string& plan, const std::string& key) {
  if (key.empty()) {
    return base::Error{base::Refusal::kUnsigned,
                       "agents carry out only what is signed: --sign KEY"};
  }
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("order");
  base::Status done = tools::write_file(file, order);
  if (!done.ok()) return done.error();
  done = tools::run_beside("stc", {"key", "sign", file, "--key", key, "--plan", plan, "--target",
                                   target, "--days", "1", "-o", file});
  if (!done.ok()) return done.error();
  return tools::read_bytes(file);
}

}  // namespace

base::Status reach_agents(const FleetBrokerUse& use, const std::vector<FleetMember>& members,
                          FleetAccess& access) {
  if (std::none_of(members.begin(), members.end(), is_at_agent)) return base::Ok{};
  base::Result<FleetBroker> where = parse_broker(use.file, use.list);
  if (!where.ok()) return where.error();
  mqtt::Settings settings = where->settings;
  settings.client = "stvm-fleet-" + use.plan;
  base::Result<std::unique_ptr<mqtt::Broker>> broker = use.connect(settings);
  if (!broker.ok()) return broker.error();
  FleetAgentsPorts ports;
  ports.broker = std::move(*broker);
  ports.sign = [key = use.key](base::ByteSpan order, const std::string& target,
                               const std::string& plan) {
    return sign_for_agent(order, target, plan, key);
  };
  ports.wall_s = [] { return int64_t{::time(nullptr)}; };
  ports.package = [make = access.package, key = use.key](const base::Bytes& running) {
    base::Result<base::Bytes> package = make(running, 0);
    return package.ok() ? sign_package(*package, key) : package;
  };
  access.agents =
      std::make_shared<FleetAgents>(FleetAgents::Settings{{where->prefix},
                                                          where->files,
                                                          where->files_folder,
                                                          use.plan,
                                                          use.who,
                                                          int64_t{use.patience_s} * 1000},
                                    std::move(ports), members);
  return base::Ok{};
}

}  // namespace stvm
