// The agent of a controller (F-01 to F-03): a client of its control channel, as `stvm fleet` is
// one, that is told by a broker what is wanted. It does nothing that is not signed for this
// controller by a key of its trust file, and nothing twice.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "adapters/mqtt/broker.h"
#include "tools/stvm/admission.h"
#include "tools/stvm/agent_answer.h"
#include "tools/stvm/agent_files.h"
#include "tools/stvm/agent_memory.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fleet_edit.h"

namespace stvm {

// The world around an agent. All of it must outlive the agent.
struct AgentPorts {
  mqtt::Broker& broker;
  AgentMemory& memory;
  Trust& trust;
  std::function<base::Result<ControllerClient>()> connect;  // to its controller
  std::function<base::Result<FleetEdit>(base::ByteSpan file)> open_edit;
  std::function<base::Result<base::Bytes>(const std::string& url, uint64_t size)> fetch;
  std::function<int64_t()> wall_s;              // UTC, since 1970
  std::function<int64_t()> now_ms;              // of a clock that nobody sets
  std::function<void(const std::string&)> say;  // a line for the log
};

class Agent {
 public:
  Agent(std::string name, AgentTopics topics, AgentPorts ports);

  // What the broker says.
  void take(const mqtt::Event& event);
  // From time to time: what the controller is and has is published where it is another than before,
  // and files that do not come are given up.
  void look();

 private:
  void connected();
  void desired(base::ByteSpan payload);
  base::Result<AgentOrder> admit(base::ByteSpan payload);
  base::Status take_statement(const online_change::SignedFile& file, base::ByteSpan payload,
                              bool asks);
  void begin(const base::Digest& id, AgentOrder order);
  // What has waited for the end of the work, or for the controller.
  void begin_waiting();
  // The next file that is not here; done: the order is carried out.
  void go_on();
  void want(const AgentFile& file);
  void piece(const mqtt::Message& message);
  void came(base::Result<base::Bytes> bytes);
  void forget_work();

  void carry_out();
  AgentAnswer do_it(const FleetEdit& edit);
  AgentAnswer show();
  PlanTrace trace(const std::string& plan);
  // Kept: it is said again to whoever repeats the order.
  void answer(AgentAnswer answer, bool kept);
  void say_refused(const base::Digest& id, const base::Error& why);
  void refuse(const base::Error& why);
  // What the controller is and has, where it is another than before.
  void say_state();
  // Null: the controller does not answer.
  void publish_state(const vm::StatusReport* status);

  std::string name_;
  AgentTopics topics_;
  AgentPorts ports_;
  bool connected_ = false;

  base::Digest order_id_{};          // of what is at work
  std::optional<AgentOrder> order_;  // at work
  base::Bytes question_;             // the last one, until it is answered
  bool waits_ = false;               // the order that is remembered, for its controller
  std::optional<AgentPieces> pieces_;
  int64_t waits_since_ms_ = 0;
  base::Bytes fleet_;  // the last fleet file that came, and its hash
  base::Digest fleet_digest_{};
  base::Bytes package_;  // of the order at work
  bool has_package_ = false;

  AgentAbout about_;
  std::map<std::string, std::string> facts_;  // E-06
  base::Bytes sent_about_;
  std::string sent_status_;
};

// JSON for people and other programs: what the controller is, has, and how it is.
std::string agent_status_json(const std::string& name, const AgentAbout& about,
                              const vm::StatusReport* status,
                              const std::map<std::string, std::string>& facts);

}  // namespace stvm
