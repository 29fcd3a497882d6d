// Controllers of this process with agents, and orders that somebody has signed for them. Signatures
// are hashes here: what a real key signs is the adapter's affair (tests/unit/store/keys_test.cc).
#pragma once

#include <gtest/gtest.h>

#include "online_change/store/store.h"
#include "tests/unit/fleet/fleet_of_plcs.h"
#include "tests/unit/fleet/hub.h"
#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/agent.h"
#include "tools/stvm/key_trust.h"

namespace fleet_test {

inline constexpr int64_t kAgentNow = 1'780'000'000;  // s
inline const online_change::PublicKey kOffice{1, 2, 3};
inline const stvm::AgentTopics kTopics{"plant"};

inline online_change::Signature signature_of(const online_change::PublicKey& key,
                                             base::ByteSpan message) {
  base::Bytes both(key.begin(), key.end());
  both.insert(both.end(), message.begin(), message.end());
  const base::Digest digest = base::sha256(both);
  online_change::Signature out{};
  std::copy(digest.begin(), digest.end(), out.begin());
  return out;
}

inline bool verify_hash(const online_change::PublicKey& key, base::ByteSpan message,
                        const online_change::Signature& signature) {
  return signature_of(key, message) == signature;
}

// How an order is signed; the fields of a statement that a test wants otherwise.
struct SignedAs {
  std::string target = "line1";
  uint64_t sequence = 1;
  int64_t expires_s = kAgentNow + 3600;
  online_change::PublicKey key = kOffice;
  online_change::SignedKind kind = online_change::SignedKind::kOrder;
};

inline base::Bytes sign_order(const stvm::AgentOrder& order, const SignedAs& as) {
  const base::Bytes content = encode(order);
  online_change::Statement said;
  said.kind = as.kind;
  said.key = online_change::key_id(as.key);
  said.plan = order.plan;
  said.sequence = as.sequence;
  said.made_s = kAgentNow;
  said.expires_s = as.expires_s;
  said.target = as.target;
  said.size = content.size();
  said.content = base::sha256(content);
  return online_change::encode(said, signature_of(as.key, online_change::message_of(said)),
                               content);
}

// One agent; its disk survives it.
class OneAgent {
 public:
  OneAgent(Fleet& fleet, Hub& hub, std::string name, std::string folder)
      : fleet_(fleet), hub_(hub), name_(std::move(name)), trust_(folder + "/" + name_) {
    trust(kOffice);
    start();
  }
  // From now on this key alone.
  void trust(const online_change::PublicKey& key) {
    const std::string text =
        "name = \"" + name_ + "\"\n[keys.office]\npublic = \"" + base::to_hex(key) + "\"\n";
    EXPECT_TRUE(
        tools::write_file(trust_, {reinterpret_cast<const uint8_t*>(text.data()), text.size()})
            .ok());
  }
  // As after `kill -9`: what is in memory is gone, and the broker publishes its will.
  void kill() {
    agent_.reset();
    broker_.reset();
    memory_.reset();
    key_trust_.reset();
    store_.reset();
  }
  void start() {
    store_.emplace(disk_);
    key_trust_.emplace(trust_, *store_, verify_hash);
    memory_.emplace(disk_);
    memory_->read();
    broker_.emplace(hub_, mqtt::Message{kTopics.of(name_, stvm::kAgentOnline), {'0'}, true});
    stvm::AgentPorts ports{
        *broker_,
        *memory_,
        *key_trust_,
        [this] { return fleet_.connect(name_, "agent"); },
        [this](base::ByteSpan) { return base::Result<stvm::FleetEdit>(fleet_.edit()); },
        [](const std::string&, uint64_t) { return base::Result<base::Bytes>(base::Bytes{}); },
        [this] { return wall_s; },
        [this] { return now_ms; },
        [this](const std::string& text) { log += text + "\n"; }};
    agent_.emplace(name_, kTopics, std::move(ports));
  }
  // All that has come.
  void work() {
    while (std::optional<mqtt::Event> event = broker_->wait(0)) agent_->take(*event);
  }
  void look() { agent_->look(); }
  bool runs() const { return agent_.has_value(); }
  std::optional<stvm::AgentAnswer> answer() {
    const auto all = hub_.retained();
    const auto found = all.find(kTopics.of(name_, stvm::kAgentAnswer));
    if (found == all.end()) return std::nullopt;
    auto read = stvm::decode_agent_answer(found->second);
    EXPECT_TRUE(read.ok());
    return *read;
  }

  int64_t wall_s = kAgentNow;
  int64_t now_ms = 0;
  std::string log;

 private:
  Fleet& fleet_;
  Hub& hub_;
  std::string name_;
  std::string trust_;
  sim::SimStorage disk_;
  std::optional<online_change::Store> store_;
  std::optional<stvm::KeyTrust> key_trust_;
  std::optional<stvm::AgentMemory> memory_;
  std::optional<HubBroker> broker_;
  std::optional<stvm::Agent> agent_;
};

}  // namespace fleet_test
