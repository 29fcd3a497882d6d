// F-04: many agents in one process, each with a controller of its own, and a real broker that is
// restarted. One line of a table for each number of controllers: times, messages, bytes, memory.
// usage: agents MOSQUITTO FOLDER PORT SOURCE FLEET_FILE COUNT... (tests/tools/agents.sh)
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "adapters/keys/keys.h"
#include "base/check.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/common/files.h"
#include "tools/common/trust_file.h"
#include "tools/stvm/agent.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_walk.h"
#include "tools/stvm/key_trust.h"
#include "tools/stvm/package_making.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kWorkers = 4;
constexpr const char* kPrefix = "bench";

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

uint64_t resident_kb(int pid) {
  const std::string path = "/proc/" + std::to_string(pid) + "/status";
  std::FILE* const file = std::fopen(path.c_str(), "r");
  char line[256];
  uint64_t kb = 0;
  while (file != nullptr && std::fgets(line, sizeof line, file) != nullptr) {
    if (std::sscanf(line, "VmRSS: %lu", &kb) == 1) break;
  }
  if (file != nullptr) std::fclose(file);
  return kb;
}

struct Traffic {
  std::atomic<uint64_t> messages{0};
  std::atomic<uint64_t> bytes{0};
  void add(const std::string& topic, size_t payload) {
    ++messages;
    bytes += topic.size() + payload;
  }
};

// The real connection, and a count of what goes through it, both ways.
class Counted : public mqtt::Broker {
 public:
  Counted(std::unique_ptr<mqtt::Broker> real, Traffic& traffic)
      : real_(std::move(real)), traffic_(traffic) {}
  base::Status publish(const std::string& topic, base::ByteSpan payload, bool retained) override {
    traffic_.add(topic, payload.size());
    return real_->publish(topic, payload, retained);
  }
  base::Status subscribe(const std::string& filter) override { return real_->subscribe(filter); }
  base::Status unsubscribe(const std::string& f) override { return real_->unsubscribe(f); }
  std::optional<mqtt::Event> wait(int64_t ms) override {
    std::optional<mqtt::Event> event = real_->wait(ms);
    if (event && event->kind == mqtt::Event::Kind::kMessage) {
      traffic_.add(event->message.topic, event->message.payload.size());
    }
    return event;
  }
  bool flush(int64_t ms) override { return real_->flush(ms); }

 private:
  std::unique_ptr<mqtt::Broker> real_;
  Traffic& traffic_;
};

struct Place {
  std::string mosquitto;
  std::string folder;
  std::string url;
  std::string source;
  std::string fleet_file;
};

class BrokerProcess {
 public:
  explicit BrokerProcess(const Place& place) : place_(place) { start(); }
  ~BrokerProcess() { stop(); }
  BrokerProcess(const BrokerProcess&) = delete;
  BrokerProcess& operator=(const BrokerProcess&) = delete;
  void start() {
    const std::string conf = place_.folder + "/broker.conf";
    pid_ = ::fork();
    if (pid_ == 0) {
      ::execl(place_.mosquitto.c_str(), "mosquitto", "-c", conf.c_str(), nullptr);
      ::_exit(127);
    }
  }
  void stop() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  int pid() const { return pid_; }

 private:
  const Place& place_;
  pid_t pid_ = -1;
};

base::Result<std::unique_ptr<mqtt::Broker>> connect_to(const Place& place,
                                                       const std::string& client,
                                                       std::optional<mqtt::Message> will) {
  mqtt::Settings settings;
  settings.url = place.url;
  settings.ca = place.folder + "/ca.pem";
  settings.client = client;
  settings.will = std::move(will);
  return mqtt::connect(settings);
}

// One agent with its disk and its keys.
struct BenchAgent {
  BenchAgent(std::string agent_name, const Place& where, fleet_test::Fleet& all,
             const std::string& trust_file, Traffic& count)
      : name(std::move(agent_name)),
        place(where),
        fleet(all),
        traffic(count),
        store(disk),
        trust(trust_file, store, keys::verify),
        memory(disk) {}
  void connect() {
    const mqtt::Message will{stvm::AgentTopics{kPrefix}.of(name, stvm::kAgentOnline), {'0'}, true};
    auto real = connect_to(place, "stvm-" + name, will);
    base::check(real.ok(), "an agent has a connection");
    broker = std::make_unique<Counted>(std::move(*real), traffic);
    agent.emplace(
        name, stvm::AgentTopics{kPrefix},
        stvm::AgentPorts{*broker, memory, trust, [this] { return fleet.connect(name, "agent"); },
                         [this](base::ByteSpan) { return stvm::read_fleet_edit(place.fleet_file); },
                         stvm::fetch_file, [] { return static_cast<int64_t>(::time(nullptr)); },
                         [] { return int64_t{0}; }, [](const std::string&) {}});
  }
  void cut() {
    agent.reset();
    broker.reset();
  }
  void work(bool looks) {
    if (!agent) return;
    while (std::optional<mqtt::Event> event = broker->wait(0)) agent->take(*event);
    if (looks) agent->look();
  }

  std::string name;
  const Place& place;
  fleet_test::Fleet& fleet;
  Traffic& traffic;
  sim::SimStorage disk;
  online_change::Store store;
  stvm::KeyTrust trust;
  stvm::AgentMemory memory;
  std::unique_ptr<mqtt::Broker> broker;
  std::optional<stvm::Agent> agent;
};

class Bench {
 public:
  Bench(Place place, size_t count) : place_(std::move(place)), count_(count) {}

  void run() {
    BrokerProcess broker(place_);
    make_controllers();
    const uint64_t before_kb = resident_kb(::getpid());
    const Clock::time_point begin = Clock::now();
    for (auto& one : agents_) one->connect();
    start_workers();
    make_tool();
    until([&](size_t i) { return tool_->is_online(members_[i]); });
    const double connected_s = seconds_since(begin);
    const uint64_t agents_kb = resident_kb(::getpid()) - before_kb;

    // A wave, and every second controller is away.
    with_workers_stopped([&](size_t i) {
      if (i % 2 == 1) agents_[i]->cut();
    });
    const Traffic& t = traffic_;
    const uint64_t messages_before = t.messages;
    const uint64_t bytes_before = t.bytes;
    Clock::time_point wave = Clock::now();
    each([&](const stvm::FleetMember& one) { return tool_->change(edit_, how_, talk_, one); });
    const double told_s = seconds_since(wave);
    base::check(on_trial() >= count_ / 2, "those that are there have it");
    wave = Clock::now();
    with_workers_stopped([&](size_t i) {
      if (i % 2 == 1) agents_[i]->connect();
    });
    until([&](size_t i) { return tool_->look(members_[i], kPlan).on_trial; });
    const double back_s = seconds_since(wave);

    // The broker is restarted; all orders come twice, those of before too; then all accept.
    wave = Clock::now();
    broker.stop();
    broker.start();
    until([&](size_t i) { return tool_->is_online(members_[i]); });
    const double restart_s = seconds_since(wave);
    repeat_orders();
    wave = Clock::now();
    each([&](const stvm::FleetMember& one) {
      return tool_->decide(stvm::AgentAct::kMakeFinal, edit_, how_, talk_, one);
    });
    until([&](size_t i) { return tool_->look(members_[i], kPlan).accepted; });
    const double accepted_s = seconds_since(wave);
    repeat_orders();
    const auto each_of = [&](uint64_t all) {
      return static_cast<double>(all) / static_cast<double>(count_);
    };
    const double messages = each_of(t.messages - messages_before);
    const double kb = each_of(t.bytes - bytes_before) / 1024;
    const uint64_t broker_kb = resident_kb(broker.pid());
    stop_workers();
    tool_.reset();
    check_journals();
    std::printf("| %zu | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.0f | %.1f |\n", count_,
                connected_s, told_s, back_s, restart_s, accepted_s, messages, kb,
                each_of(agents_kb), each_of(broker_kb));
    std::fflush(stdout);
  }

 private:
  static constexpr const char* kPlan = "0badcafe";

  void make_controllers() {
    base::Result<keys::NewKey> key = keys::make_key();
    base::check(key.ok(), "a key");
    key_ = *key;
    tools::TrustedKey trusted;
    trusted.name = "office";
    trusted.key = key_.public_key;
    base::Result<std::string> source = tools::read_text(place_.source);
    base::check(source.ok(), "the program");
    for (size_t i = 0; i < count_; ++i) {
      const std::string name = "plc" + std::to_string(i);
      const std::string trust = place_.folder + "/" + name + ".trust";
      const std::string text = "name = \"" + name + "\"\n" + tools::trust_lines(trusted);
      const auto* const bytes = reinterpret_cast<const uint8_t*>(text.data());
      base::check(tools::write_file(trust, {bytes, text.size()}).ok(), "a trust file");
      fleet_.add(name, *source);
      members_.push_back({name, name, false, stvm::PlaceKind::kAtAgent});
      agents_.push_back(std::make_unique<BenchAgent>(name, place_, fleet_, trust, traffic_));
    }
    base::Result<stvm::FleetEdit> edit = stvm::read_fleet_edit(place_.fleet_file);
    base::check(edit.ok(), "the fleet file");
    edit_ = std::move(*edit);
    how_ = fleet_test::quietly();
  }

  base::Bytes sign(base::ByteSpan content, const std::string& target, const std::string& plan,
                   online_change::SignedKind kind) {
    online_change::Statement said;
    said.kind = kind;
    said.key = online_change::key_id(key_.public_key);
    said.plan = plan;
    said.sequence = ++sequence_;
    said.made_s = ::time(nullptr);
    said.expires_s = said.made_s + 86'400;
    said.target = target;
    said.size = content.size();
    said.content = base::sha256(content);
    const auto signature = keys::sign(key_.pem, online_change::message_of(said));
    base::check(signature.ok(), "a signature");
    return online_change::encode(said, *signature, content);
  }

  void make_tool() {
    stvm::FleetAgentsPorts ports;
    auto real = connect_to(place_, "tool", std::nullopt);
    base::check(real.ok(), "the tool has a connection");
    ports.broker = std::move(*real);
    ports.sign = [this](base::ByteSpan order, const std::string& target, const std::string& plan) {
      base::Bytes out = sign(order, target, plan, online_change::SignedKind::kOrder);
      const std::lock_guard<std::mutex> one(sent_mutex_);
      sent_.emplace_back(target, out);
      return base::Result<base::Bytes>(out);
    };
    ports.package = [this](const base::Bytes& running) {
      return stvm::make_package({{place_.fleet_file}, {}}, {}, running);
    };
    stvm::FleetAgents::Settings settings;
    settings.topics = {kPrefix};
    settings.plan = kPlan;
    settings.who = "bench";
    settings.patience_ms = 300'000;
    tool_.emplace(std::move(settings), std::move(ports), members_);
    auto again = connect_to(place_, "repeats", std::nullopt);
    base::check(again.ok(), "who repeats orders has a connection");
    repeats_ = std::move(*again);
  }

  // Each order that was ever sent, twice, the oldest last.
  void repeat_orders() {
    std::vector<std::pair<std::string, base::Bytes>> all;
    {
      const std::lock_guard<std::mutex> one(sent_mutex_);
      all = sent_;
    }
    for (int twice = 0; twice < 2; ++twice) {
      for (size_t i = all.size(); i-- > 0;) {
        const std::string topic = stvm::AgentTopics{kPrefix}.of(all[i].first, stvm::kAgentDesired);
        (void)repeats_->publish(topic, all[i].second, false);
      }
    }
    base::check(repeats_->flush(300'000), "repeated orders are with the broker");
  }

  void start_workers() {
    stop_ = false;
    for (size_t w = 0; w < kWorkers; ++w) {
      workers_.emplace_back([this, w] {
        Clock::time_point looked = Clock::now();
        while (!stop_) {
          const bool looks = seconds_since(looked) >= 1;
          if (looks) looked = Clock::now();
          for (size_t i = w; i < count_; i += kWorkers) agents_[i]->work(looks);
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
      });
    }
  }
  void stop_workers() {
    stop_ = true;
    for (std::thread& worker : workers_) worker.join();
    workers_.clear();
  }
  template <class Each>
  void with_workers_stopped(Each&& each_one) {
    stop_workers();
    for (size_t i = 0; i < count_; ++i) each_one(i);
    start_workers();
  }
  template <class Holds>
  void until(Holds&& holds) {
    for (size_t i = 0; i < count_; ++i) {
      while (!holds(i)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  template <class Visit>
  void each(Visit&& visit) {
    stvm::FleetWalk all;
    all.jobs = 256;
    all.visit = visit;
    all.told = [](const stvm::FleetMember&, const stvm::FleetRow&) {};
    (void)stvm::walk(members_, all);
  }
  size_t on_trial() {
    size_t count = 0;
    for (const auto& member : members_) count += tool_->look(member, kPlan).on_trial ? 1 : 0;
    return count;
  }

  // Whatever the network did: one switch and one acceptance each.
  void check_journals() {
    using online_change::Event;
    for (const auto& member : members_) {
      size_t switched = 0;
      size_t accepted = 0;
      auto client = fleet_.connect(member.name, "bench");
    const auto journal = client->journal();
    for (const auto& entry : *journal) {
        switched += entry.event == Event::kSwitched ? 1 : 0;
        accepted += entry.event == Event::kAccepted ? 1 : 0;
      }
      base::check(switched == 1 && accepted == 1, "each edit is made once and accepted once");
    }
  }

  Place place_;
  size_t count_;
  fleet_test::Fleet fleet_;
  std::vector<stvm::FleetMember> members_;
  std::vector<std::unique_ptr<BenchAgent>> agents_;
  Traffic traffic_;  // of all agents
  keys::NewKey key_;
  std::atomic<uint64_t> sequence_{0};
  std::mutex sent_mutex_;
  std::vector<std::pair<std::string, base::Bytes>> sent_;
  stvm::FleetEdit edit_;
  stvm::SwitchOptions how_;
  stvm::FleetTalk talk_{true};
  std::optional<stvm::FleetAgents> tool_;
  std::unique_ptr<mqtt::Broker> repeats_;
  std::vector<std::thread> workers_;
  std::atomic<bool> stop_{false};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fprintf(stderr, "usage: agents MOSQUITTO FOLDER PORT SOURCE FLEET_FILE COUNT...\n");
    return 2;
  }
  const Place place{argv[1], argv[2], std::string("mqtts://localhost:") + argv[3], argv[4],
                    argv[5]};
  std::printf(
      "| controllers | all connected, s | half has it, s | the others, s | broker again, s "
      "| accepted, s | messages each | KiB each | agent, KiB | broker, KiB each |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (int i = 6; i < argc; ++i) {
    Bench(place, static_cast<size_t>(std::strtoul(argv[i], nullptr, 10))).run();
  }
  return 0;
}
