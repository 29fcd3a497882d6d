// What an agent is told to do (F-02): the one message that its controller's topic holds. It is the
// content of a signed file (SignedKind::kOrder), for that controller alone. It says what is wanted,
// not what is to be done next: an order that is lost, repeated or late changes nothing. A question
// is written like an order, but changes nothing at the controller, and the topic does not hold it:
// what waits there goes on waiting.
#pragma once

#include <string>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace stvm {

enum class AgentAct : uint8_t {
  kShow,       // the running program, in pieces: who has the sources makes a package for it
  kCheck,      // what would become of the edit there (E-11 to E-15); nothing is changed
  kBring,      // the edit goes on trial
  kMakeFinal,  // it becomes final
  kTakeBack,   // it goes again
};
inline constexpr AgentAct kLastAgentAct = AgentAct::kTakeBack;
constexpr bool is_question(AgentAct act) {
  return act == AgentAct::kShow || act == AgentAct::kCheck;
}

// A file that the broker or a server holds in pieces, by its SHA-256.
struct AgentFile {
  base::Digest digest{};
  uint64_t size = 0;
};

struct AgentOrder {
  AgentAct act = AgentAct::kCheck;
  std::string plan;  // of the roll-out
  uint32_t wave = 1;
  std::string note;     // the journal says it of the switch
  base::Digest base{};  // image that the package is made for
  AgentFile fleet;      // the fleet file
  AgentFile package;    // of kCheck and kBring
  std::string source;   // URL of the folder of both; "": topics of the broker
  uint32_t stage_flags = 0;
  uint32_t switch_flags = 0;
  bool matching = false;
  base::Bytes guard;      // conditions of the trial (GuardOrder)
  int64_t window_ms = 0;  // so long the controller looks at values before the switch
};

inline constexpr uint64_t kMostAgentFile = 64u << 20;  // bytes
inline constexpr size_t kMostOrderBytes = 256u << 10;  // with its signature

base::Bytes encode(const AgentOrder& order);
// kBadFormat. What a newer tool has added is not left out: whoever sends it relies on it.
base::Result<AgentOrder> decode_agent_order(base::ByteSpan bytes);

}  // namespace stvm
