#include "tests/tools/agent_group.h"

#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "adapters/keys/keys.h"
#include "base/check.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tools/common/files.h"
#include "tools/common/trust_file.h"
#include "tools/stvm/agent.h"
#include "tools/stvm/key_trust.h"

namespace agents_bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kWorkers = 2;

struct Counters {
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
  Counted(std::unique_ptr<mqtt::Broker> real, Counters& traffic)
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
  Counters& traffic_;
};

// One agent with its disk and its keys.
struct BenchAgent {
  BenchAgent(std::string agent_name, const Place& where, fleet_test::Fleet& all,
             const std::string& trust_file, Counters& count)
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
  // As an agent that ends: it says so itself, since a broker publishes no will of who leaves well.
  void cut() {
    (void)broker->publish(stvm::AgentTopics{kPrefix}.of(name, stvm::kAgentOnline), base::Bytes{'0'},
                          true);
    (void)broker->flush(60'000);
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
  Counters& traffic;
  sim::SimStorage disk;
  online_change::Store store;
  stvm::KeyTrust trust;
  stvm::AgentMemory memory;
  std::unique_ptr<mqtt::Broker> broker;
  std::optional<stvm::Agent> agent;
};

// Controllers, agents, and the threads that let agents work.
class Group {
 public:
  Group(const Place& place, const online_change::PublicKey& key, size_t begin, size_t end)
      : place_(place) {
    tools::TrustedKey trusted;
    trusted.name = "office";
    trusted.key = key;
    base::Result<std::string> source = tools::read_text(place_.source);
    base::check(source.ok(), "the program");
    for (size_t i = begin; i < end; ++i) {
      const std::string name = controller_name(i);
      const std::string trust = place_.folder + "/" + name + ".trust";
      const std::string text = "name = \"" + name + "\"\n" + tools::trust_lines(trusted);
      const auto* const bytes = reinterpret_cast<const uint8_t*>(text.data());
      base::check(tools::write_file(trust, {bytes, text.size()}).ok(), "a trust file");
      fleet_.add(name, *source);
      agents_.push_back(std::make_unique<BenchAgent>(name, place_, fleet_, trust, counters_));
    }
  }
  // One command of the parent.
  Traffic obey(char what) {
    if (what == 'j') check_journals();
    if (what == 'c' || what == '-' || what == '+') {
      stop_workers();
      const uint64_t before_kb = resident_kb(::getpid());
      for (size_t i = 0; i < agents_.size(); ++i) {
        if (what == '-' && i % 2 == 1) agents_[i]->cut();
        if (what == 'c' || (what == '+' && i % 2 == 1)) agents_[i]->connect();
      }
      start_workers();
      if (what == 'c') connected_kb_ = resident_kb(::getpid()) - before_kb;
    }
    return {counters_.messages, counters_.bytes, connected_kb_};
  }

 private:
  void start_workers() {
    stop_ = false;
    for (size_t w = 0; w < kWorkers; ++w) {
      workers_.emplace_back([this, w] {
        Clock::time_point looked = Clock::now();
        while (!stop_) {
          const bool looks = Clock::now() - looked >= std::chrono::seconds(1);
          if (looks) looked = Clock::now();
          for (size_t i = w; i < agents_.size(); i += kWorkers) agents_[i]->work(looks);
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
  void check_journals() {
    using online_change::Event;
    stop_workers();
    for (const auto& agent : agents_) {
      size_t switched = 0;
      size_t accepted = 0;
      auto client = fleet_.connect(agent->name, "bench");
      const auto journal = client->journal();
      for (const auto& entry : *journal) {
        switched += entry.event == Event::kSwitched ? 1 : 0;
        accepted += entry.event == Event::kAccepted ? 1 : 0;
      }
      base::check(switched == 1 && accepted == 1, "each edit is made once and accepted once");
    }
    start_workers();
  }

  const Place& place_;
  fleet_test::Fleet fleet_;
  Counters counters_;
  std::vector<std::unique_ptr<BenchAgent>> agents_;
  std::vector<std::thread> workers_;
  std::atomic<bool> stop_{false};
  uint64_t connected_kb_ = 0;
};

bool read_all(int from, void* to, size_t size) {
  auto* at = static_cast<char*>(to);
  while (size != 0) {
    const ssize_t got = ::read(from, at, size);
    if (got <= 0) return false;
    at += got;
    size -= static_cast<size_t>(got);
  }
  return true;
}

}  // namespace

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

GroupProcess::GroupProcess(const Place& place, const online_change::PublicKey& key, size_t begin,
                           size_t end) {
  int ends[2];
  base::check(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "a channel");
  pid_ = ::fork();
  channel_ = ends[0];
  if (pid_ != 0) {
    ::close(ends[1]);
    return;
  }
  ::close(ends[0]);
  {
    Group group(place, key, begin, end);
    char what = 0;
    while (read_all(ends[1], &what, 1)) {
      const Traffic reply = group.obey(what);
      if (::write(ends[1], &reply, sizeof reply) != sizeof reply) break;
    }
  }
  ::_exit(0);
}

GroupProcess::~GroupProcess() {
  ::close(channel_);
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

Traffic GroupProcess::ask(char what) {
  Traffic reply;
  const bool done = ::write(channel_, &what, 1) == 1 && read_all(channel_, &reply, sizeof reply);
  base::check(done, "a group of agents answers");
  return reply;
}

}  // namespace agents_bench
