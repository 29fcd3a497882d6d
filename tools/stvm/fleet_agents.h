// Controllers that a broker leads to (F-01, F-02), from the side of the tool: what `stvm fleet`
// does with each goes out as a signed order that the broker keeps, and comes back as an answer. The
// broker is not trusted with more than that: what it makes up about a controller is believed, what
// it makes up for one is refused there.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "tools/stvm/agent_answer.h"
#include "tools/stvm/agent_files.h"
#include "tools/stvm/fleet_broker.h"
#include "tools/stvm/fleet_visit.h"

namespace stvm {

struct FleetAgentsPorts {
  std::unique_ptr<mqtt::Broker> broker;
  // For that controller, as part of that plan.
  std::function<base::Result<base::Bytes>(base::ByteSpan order, const std::string& target,
                                          const std::string& plan)>
      sign;
  std::function<int64_t()> wall_s;  // UTC, since 1970
  // Of the edit, for that program; signed.
  std::function<base::Result<base::Bytes>(const base::Bytes& running)> package;
};

// Threads may share one.
class FleetAgents {
 public:
  struct Settings {
    AgentTopics topics;
    std::string files;         // URL; "": over the broker
    std::string files_folder;  // what that URL leads to
    std::string plan;          // of all orders
    std::string who;
    int64_t patience_ms = 60'000;
  };
  FleetAgents(Settings settings, FleetAgentsPorts ports, const std::vector<FleetMember>& members);
  ~FleetAgents();
  FleetAgents(const FleetAgents&) = delete;
  FleetAgents& operator=(const FleetAgents&) = delete;

  FleetRow look_at(const FleetEdit* edit, const FleetTalk& talk, const FleetMember& member);
  FleetRow change(const FleetEdit& edit, SwitchOptions how, FleetTalk& talk,
                  const FleetMember& member);
  // kTakeBack or kMakeFinal.
  FleetRow decide(AgentAct act, const FleetEdit& edit, const SwitchOptions& how, FleetTalk& talk,
                  const FleetMember& member);
  // What is known of a plan there; nobody is asked.
  PlanTrace look(const FleetMember& member, const std::string& plan);
  bool is_online(const FleetMember& member);
  // Whoever has not answered is told to take the edit back when it comes; nobody waits for it.
  void withdraw(const FleetEdit& edit, const SwitchOptions& how, const FleetMember& member);

 private:
  struct Known {
    bool online = false;
    std::optional<AgentAbout> about;
    std::optional<base::Digest> waits_for;  // its last order, while that is not over
  };
  // What somebody waits for an answer to.
  struct Asked {
    std::string agent;
    base::Bytes question;  // asked again when the agent comes back; empty: an order, which is kept
    std::optional<AgentAnswer> answer;
  };
  // An order that the broker holds, whoever has given it.
  struct Held {
    base::Digest id{};
    int64_t expires_s = 0;
    std::vector<AgentFile> files;  // that the broker holds for it
    bool over = false;             // by its answer
  };
  struct Program {
    base::Bytes bytes;
    ir::VerifiedImage image;
    std::optional<base::Result<AgentFile>> package;
  };

  void pump();
  void take(const mqtt::Event& event);
  void take(const mqtt::Message& message);
  void take_order(const std::string& agent, base::ByteSpan payload);
  void take_answer(const std::string& agent, AgentAnswer answer);
  void subscribe_all();
  void order_is_over(const std::string& agent, const base::Digest& id);
  void clear_up();
  void clear(const AgentFile& file);
  base::Result<Known> wait_for(const FleetMember& member);
  base::Result<Program*> program_of(const base::Digest& running, const FleetMember& member);
  std::vector<std::string> who_runs(const base::Digest& running, const FleetMember& first);
  base::Result<base::Bytes> shown(const std::string& agent, const base::Digest& running);
  base::Result<AgentFile> package_for(Program& program);
  base::Result<AgentFile> fleet_file(const FleetEdit& edit);
  base::Result<AgentFile> put(base::ByteSpan file);
  AgentOrder order_of(AgentAct act, const FleetEdit& edit, const SwitchOptions& how,
                      const AgentFile& fleet) const;
  base::Result<base::Bytes> signed_for(const AgentOrder& order, const std::string& agent);
  base::Status give(const std::string& agent, const base::Bytes& order_signed);
  // A question is asked of who is there; an order waits at the broker for who is not.
  base::Result<AgentAnswer> ask(const AgentOrder& order, const std::string& agent);
  FleetRow decided(FleetRow row, AgentAct act, const FleetEdit& edit, const SwitchOptions& how,
                   FleetTalk& talk, const FleetMember& member);
  FleetRow finished(FleetRow row, const base::Result<AgentAnswer>& answer,
                    const FleetTalk& talk) const;

  const Settings settings_;
  FleetAgentsPorts ports_;
  std::mutex mutex_;  // of what comes
  std::condition_variable came_;
  std::map<std::string, Known> known_;  // by the name at the broker
  std::map<base::Digest, Asked> asked_;
  std::map<std::string, Held> held_;  // likewise, of all that are there
  std::vector<Held> replaced_;        // by orders of this run
  bool has_ordered_ = false;
  std::optional<AgentPieces> pieces_;  // of an image that is being shown

  std::mutex making_;  // one program or package at a time
  std::map<base::Digest, Program> programs_;
  std::map<base::Digest, AgentFile> put_;         // files that were published, by hash
  std::map<std::string, AgentFile> fleet_files_;  // by path
  std::atomic<bool> stops_{false};
  std::thread pump_;
};

// In fleet_broker.cc. For those members that need it; where none does, `access` stays as it is.
// `list`: the text of fleet.toml, `file` its name. `key`: file of the private key that signs; "":
// nothing can be ordered. `plan`: its number.
struct FleetBrokerUse {
  ConnectBroker connect = nullptr;
  std::string file;
  std::string list;
  std::string key;
  std::string plan;
  std::string who;
  uint32_t patience_s = 60;
};
base::Status reach_agents(const FleetBrokerUse& use, const std::vector<FleetMember>& members,
                          FleetAccess& access);

}  // namespace stvm
