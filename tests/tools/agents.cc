// F-04: many agents, each with a controller of its own, and a real broker that is restarted. One
// row of a table for each number of controllers: times, messages, bytes, memory. usage: agents
// MOSQUITTO FOLDER PORT SOURCE FLEET_FILE COUNT... (tests/tools/agents.sh)
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
#include "tests/tools/agent_group.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/stvm/fleet_agents.h"
#include "tools/stvm/fleet_walk.h"
#include "tools/stvm/package_making.h"

namespace {

using namespace agents_bench;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

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

class Bench {
 public:
  Bench(Place place, size_t count) : place_(std::move(place)), count_(count) {}

  void run() {
    base::Result<keys::NewKey> key = keys::make_key();
    base::check(key.ok(), "a key");
    key_ = *key;
    for (size_t i = 0; i < count_; i += kMostOfGroup) {
      const size_t end = std::min(count_, i + kMostOfGroup);
      groups_.push_back(std::make_unique<GroupProcess>(place_, key_.public_key, i, end));
    }
    BrokerProcess broker(place_);
    read_edit();
    Clock::time_point begin = Clock::now();
    for (auto& group : groups_) group->connect();
    make_tool();
    until([&](size_t i) { return tool_->is_online(members_[i]); });
    const double connected_s = seconds_since(begin);

    // A wave, and every second controller is away.
    for (auto& group : groups_) group->cut_half();
    const Traffic before = traffic();
    begin = Clock::now();
    each([&](const stvm::FleetMember& one) { return tool_->change(edit_, how_, talk_, one); });
    const double told_s = seconds_since(begin);
    base::check(on_trial() >= count_ / 2, "those that are there have it");
    begin = Clock::now();
    for (auto& group : groups_) group->connect_half();
    until([&](size_t i) { return tool_->look(members_[i], kPlan).on_trial; });
    const double back_s = seconds_since(begin);

    // The broker is restarted; all orders come twice, those of before too; then all accept.
    begin = Clock::now();
    broker.stop();
    broker.start();
    until([&](size_t i) { return tool_->is_online(members_[i]); });
    const double restart_s = seconds_since(begin);
    repeat_orders();
    begin = Clock::now();
    each([&](const stvm::FleetMember& one) {
      return tool_->decide(stvm::AgentAct::kMakeFinal, edit_, how_, talk_, one);
    });
    until([&](size_t i) { return tool_->look(members_[i], kPlan).accepted; });
    const double accepted_s = seconds_since(begin);
    repeat_orders();
    const Traffic after = traffic();
    const auto each_of = [&](uint64_t all) {
      return static_cast<double>(all) / static_cast<double>(count_);
    };
    const uint64_t broker_kb = resident_kb(broker.pid());
    tool_.reset();
    for (auto& group : groups_) group->check_journals();
    std::printf("| %zu | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f | %.0f | %.1f |\n", count_,
                connected_s, told_s, back_s, restart_s, accepted_s,
                each_of(after.messages - before.messages),
                each_of(after.bytes - before.bytes) / 1024, each_of(after.agents_kb),
                each_of(broker_kb));
    std::fflush(stdout);
  }

 private:
  static constexpr const char* kPlan = "0badcafe";

  void read_edit() {
    for (size_t i = 0; i < count_; ++i) {
      const std::string name = controller_name(i);
      members_.push_back({name, name, false, stvm::PlaceKind::kAtAgent});
    }
    base::Result<stvm::FleetEdit> edit = stvm::read_fleet_edit(place_.fleet_file);
    base::check(edit.ok(), "the fleet file");
    edit_ = std::move(*edit);
    how_ = fleet_test::quietly();
  }
  Traffic traffic() {
    Traffic all;
    for (auto& group : groups_) {
      const Traffic one = group->traffic();
      all.messages += one.messages;
      all.bytes += one.bytes;
      all.agents_kb += one.agents_kb;
    }
    return all;
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
    ports.wall_s = [] { return int64_t{::time(nullptr)}; };
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

  Place place_;
  size_t count_;
  std::vector<std::unique_ptr<GroupProcess>> groups_;
  std::vector<stvm::FleetMember> members_;
  keys::NewKey key_;
  std::atomic<uint64_t> sequence_{0};
  std::mutex sent_mutex_;
  std::vector<std::pair<std::string, base::Bytes>> sent_;
  stvm::FleetEdit edit_;
  stvm::SwitchOptions how_;
  stvm::FleetTalk talk_{true};
  std::optional<stvm::FleetAgents> tool_;
  std::unique_ptr<mqtt::Broker> repeats_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 7) {
    std::fprintf(stderr, "usage: agents MOSQUITTO FOLDER PORT SOURCE FLEET_FILE COUNT...\n");
    return 2;
  }
  const Place place{argv[1], argv[2], std::string("mqtts://localhost:") + argv[3], argv[4],
                    argv[5]};
  for (int i = 6; i < argc; ++i) {
    Bench(place, static_cast<size_t>(std::strtoul(argv[i], nullptr, 10))).run();
  }
  return 0;
}
