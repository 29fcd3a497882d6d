// stvm agent: an agent with its world.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/trust_file.h"
#include "tools/stvm/agent.h"
#include "tools/stvm/agent_command.h"
#include "tools/stvm/key_trust.h"
#include "tools/stvm/state_folder.h"
#include "tools/stvm/stop_signal.h"
#include "vm/runtime/file_storage.h"

namespace stvm {
namespace {

constexpr int64_t kBetweenAgentLooksMs = 1000;
constexpr int64_t kLastWordsMs = 2000;

int64_t agent_wall_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

int64_t agent_clock_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void log_agent(const std::string& text) { std::fprintf(stderr, "agent: %s\n", text.c_str()); }

base::Result<FleetEdit> open_agent_edit(base::ByteSpan file) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string path = folder->file("edit.fleet");
  if (base::Status written = tools::write_file(path, file); !written.ok()) return written.error();
  return read_fleet_edit(path);
}

// The name by which orders are for it.
base::Result<std::string> agent_name(const std::string& trust_path) {
  base::Result<tools::TrustFile> trust = tools::read_trust_file(trust_path);
  if (!trust.ok()) return trust.error();
  if (is_agent_name(trust->name)) return trust->name;
  return base::Error{base::Refusal::kBadKeys,
                     trust_path +
                         ": an agent needs `name = \"...\"` there, of letters, digits "
                         "and . _ - only"};
}

// Beside the folder of the controller, whose folders are its resources.
std::string own_folder(std::string directory) {
  while (directory.size() > 1 && directory.ends_with('/')) directory.pop_back();
  return directory + ".agent";
}

// SIGHUP: the file of the broker anew, and with it password and certificates. One that cannot be
// read changes nothing.
std::optional<FleetBroker> broker_anew(const std::string& path) {
  if (!StopSignal::take_hangup()) return std::nullopt;
  base::Result<FleetBroker> where = read_broker(path);
  log_agent(where.ok() ? "SIGHUP: connects anew"
                       : "SIGHUP: stays connected as it is: " + base::to_string(where.error()));
  if (!where.ok()) return std::nullopt;
  return *std::move(where);
}

// Null: stopped. Else where to connect anew.
std::optional<FleetBroker> run_until_stopped(mqtt::Broker& broker, Agent& agent,
                                             const std::string& path) {
  int64_t next_look_ms = agent_clock_ms();
  while (!StopSignal::received()) {
    if (std::optional<FleetBroker> anew = broker_anew(path)) return anew;
    const int64_t left = next_look_ms - agent_clock_ms();
    if (left <= 0) {
      agent.look();
      next_look_ms = agent_clock_ms() + kBetweenAgentLooksMs;
    } else if (std::optional<mqtt::Event> event = broker.wait(std::min<int64_t>(left, 200))) {
      agent.take(*event);
    }
  }
  return std::nullopt;
}

base::Status serve_broker(const tools::Options& options, ConnectBroker connect) {
  if (!options.has("--broker") || !options.has("--trust")) {
    return base::Error{base::Refusal::kUsage,
                       "agent: it needs --broker FILE and --trust KEYS: nobody else says whose "
                       "orders count"};
  }
  const std::string trust_path = options.text("--trust");
  base::Result<std::string> name = agent_name(trust_path);
  if (!name.ok()) return name.error();
  base::Result<FleetBroker> where = read_broker(options.text("--broker"));
  if (!where.ok()) return where.error();
  const std::string directory = state_directory(options);
  base::Result<StateFolder> folder = StateFolder::open(own_folder(directory), true);
  if (!folder.ok()) return folder.error();
  vm::FileStorage storage(folder->path(), folder->descriptor());
  online_change::Store store(storage);
  base::Result<std::unique_ptr<Trust>> trust = make_trust(trust_path, store);
  if (!trust.ok()) return trust.error();
  AgentMemory memory(storage);
  memory.read();
  StopSignal::install_service();
  std::optional<FleetBroker> next = *where;
  std::optional<FleetBroker> good;  // with which it was connected last
  while (next) {
    const AgentTopics topics{next->prefix};
    mqtt::Settings settings = next->settings;
    settings.client = "stvm-" + *name;
    settings.will = mqtt::Message{topics.of(*name, kAgentOnline), {'0'}, true};
    base::Result<std::unique_ptr<mqtt::Broker>> broker = connect(settings);
    if (!broker.ok()) {
      if (!good) return broker.error();
      log_agent("connects as before: " + base::to_string(broker.error()));
      next = std::exchange(good, std::nullopt);
      continue;
    }
    good = next;
    Agent agent(*name, topics,
                {**broker, memory, **trust,
                 [&] {
                   return ControllerClient::connect_here(directory,
                                                         vm::SocketClient::kPatienceSeconds);
                 },
                 open_agent_edit, fetch_file, agent_wall_s, agent_clock_ms, log_agent});
    next = run_until_stopped(**broker, agent, options.text("--broker"));
    // A clean end publishes no will.
    (void)(*broker)->publish(settings.will->topic, settings.will->payload, true);
    (void)(*broker)->flush(kLastWordsMs);
  }
  return base::Ok{};
}

}  // namespace

int run_agent(const tools::Options& options, ConnectBroker connect) {
  base::Status ended = serve_broker(options, connect);
  return ended.ok() ? tools::kOk : refuse(ended.error());
}

}  // namespace stvm
