// What an agent says (F-01, F-02): what its controller is and has, and what came of its last order.
// Nobody signs it: a broker can lie about a controller, but not change one. JSON for people and
// other programs is agent_status.cc.
#pragma once

#include <map>

#include "ir/bytecode/identities.h"
#include "tools/stvm/agent_order.h"
#include "tools/stvm/fleet_result.h"
#include "tools/stvm/plan_trace.h"

namespace stvm {

// Retained; published again when something in it has changed.
struct AgentAbout {
  base::Digest running{};
  std::string program;
  std::vector<ir::Part> parts;  // E-02, E-04
  std::string plan;             // of the last order
  PlanTrace trace;              // what became of it
  uint64_t edits = 0;           // on trial there, whoever has brought them
};

struct AgentAnswer {
  base::Digest order{};  // SHA-256 of the signed order, as it came
  FleetRow row;          // without `has`, `table` and `mixtures`
  PlanTrace trace;
  AgentFile shown;  // by kShow
  // The order is over: it is not done later. Else it waits until its controller answers.
  bool ends() const { return row.outcome != FleetOutcome::kUnreachable; }
};

base::Bytes encode(const AgentAbout& about);
base::Bytes encode(const AgentAnswer& answer);
// kBadFormat. Whatever a broker sends; texts can be shown at a terminal.
base::Result<AgentAbout> decode_agent_about(base::ByteSpan bytes);
base::Result<AgentAnswer> decode_agent_answer(base::ByteSpan bytes);

// Topics of a controller, and of files. `prefix`: where the fleet lives at the broker.
struct AgentTopics {
  std::string prefix;
  std::string of(const std::string& controller, const char* what) const {
    return prefix + "/1/" + controller + "/" + what;
  }
  std::string file(const base::Digest& digest, const std::string& piece) const {
    return prefix + "/1/-/file/" + base::to_hex(digest) + "/" + piece;
  }
};
inline constexpr const char* kAgentOnline = "online";    // "1"; "0" by its will
inline constexpr const char* kAgentStatus = "status";    // JSON
inline constexpr const char* kAgentAbout = "about";      // AgentAbout
inline constexpr const char* kAgentDesired = "desired";  // a signed AgentOrder
inline constexpr const char* kAgentAnswer = "answer";    // AgentAnswer
inline constexpr uint64_t kAgentPiece = 64u << 10;       // bytes of each but the last

// Of controllers as topics have them: no wildcard, no slash, not "-".
bool is_agent_name(std::string_view name);
// A prefix: names with slashes between them.
bool is_topic_prefix(std::string_view prefix);

}  // namespace stvm
