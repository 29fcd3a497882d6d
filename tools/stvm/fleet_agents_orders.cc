// Orders and questions on their way to agents, and what of that the broker holds: an order until it
// is over, a file until no order names it.
#include <algorithm>
#include <chrono>

#include "online_change/package/signed_file.h"
#include "tools/stvm/fleet_agents.h"

namespace stvm {

using std::chrono::milliseconds;

namespace {

constexpr int64_t kOfflineMs = 2000;  // for the answer of one that is not connected
// Nobody takes an order then, also where a clock is behind.
constexpr int64_t kLongOverS = 86'400;
constexpr const char* kWaits =
    "; the order waits for it at the broker, a day long, and an undo takes it back";

base::Error not_reached(bool online, const char* more) {
  return {base::Refusal::kNotRunning,
          std::string(online ? "its agent does not answer"
                             : "its agent is not connected to the broker") +
              more};
}

}  // namespace

base::Result<base::Bytes> FleetAgents::signed_for(const AgentOrder& order,
                                                  const std::string& agent) {
  return ports_.sign(encode(order), agent, settings_.plan);
}

base::Status FleetAgents::give(const std::string& agent, const base::Bytes& order_signed) {
  {
    const std::lock_guard<std::mutex> one(mutex_);
    known_[agent].waits_for = base::sha256(order_signed);
    has_ordered_ = true;
    if (const auto before = held_.find(agent); before != held_.end()) {
      replaced_.push_back(std::move(before->second));
    }
    take_order(agent, order_signed);
  }
  return ports_.broker->publish(settings_.topics.of(agent, kAgentDesired), order_signed, true);
}

base::Result<AgentAnswer> FleetAgents::ask(const AgentOrder& order, const std::string& agent) {
  const bool asks = is_question(order.act);
  base::Result<base::Bytes> order_signed = signed_for(order, agent);
  if (!order_signed.ok()) return order_signed.error();
  const base::Digest id = base::sha256(*order_signed);
  bool online = false;
  {
    const std::lock_guard<std::mutex> one(mutex_);
    online = known_[agent].online;
    if (asks && !online) return not_reached(online, "");
    asked_[id] = {agent, asks ? *order_signed : base::Bytes(), std::nullopt};
  }
  base::Status sent =
      asks ? ports_.broker->publish(settings_.topics.of(agent, kAgentDesired), *order_signed, false)
           : give(agent, *order_signed);
  std::unique_lock<std::mutex> held(mutex_);
  const int64_t ms = online ? settings_.patience_ms + order.window_ms
                            : std::min(settings_.patience_ms, kOfflineMs);
  if (sent.ok()) {
    came_.wait_for(held, milliseconds(ms), [&] { return asked_[id].answer.has_value(); });
  }
  std::optional<AgentAnswer> answer = std::move(asked_[id].answer);
  asked_.erase(id);
  if (!sent.ok()) return sent.error();
  if (!answer) return not_reached(online, asks ? "" : kWaits);
  if (asks) return std::move(*answer);
  Known& known = known_[agent];
  if (known.about) {
    known.about->plan = order.plan;
    known.about->trace = answer->trace;
  }
  held.unlock();
  if (answer->ends()) {
    order_is_over(agent, id);
  } else if (answer->row.why) {
    answer->row.why->text += kWaits;
  }
  return std::move(*answer);
}

// What the broker holds for an agent from now on; nothing any more where it is empty. Whoever has
// signed it is the agent's affair.
void FleetAgents::take_order(const std::string& agent, base::ByteSpan payload) {
  if (payload.empty()) {
    held_.erase(agent);
    return;
  }
  base::Bytes content(payload.begin(), payload.end());
  const base::Result<online_change::SignedFile> file = online_change::open_signed(content);
  const base::Result<AgentOrder> order = decode_agent_order(content);
  if (!file.ok() || !order.ok() || is_question(order->act)) return;
  Held held{base::sha256(payload), file->statement.expires_s, {}, false};
  if (order->source.empty()) held.files = {order->fleet, order->package};
  held_[agent] = std::move(held);
}

// Nobody is to find it there again: it would be taken for one that waits.
void FleetAgents::order_is_over(const std::string& agent, const base::Digest& id) {
  {
    const std::lock_guard<std::mutex> one(mutex_);
    const auto found = held_.find(agent);
    if (found == held_.end() || found->second.id != id) return;  // another one is there
  }
  (void)ports_.broker->publish(settings_.topics.of(agent, kAgentDesired), {}, true);
}

void FleetAgents::clear(const AgentFile& file) {
  for (uint64_t at = 0; at * kAgentPiece < std::min(file.size, kMostAgentFile); ++at) {
    (void)ports_.broker->publish(settings_.topics.file(file.digest, std::to_string(at)), {}, true);
  }
}

// At the end of a run: its files, unless orders that wait name them; and where it has ordered
// something, orders of runs before it that are over by now or have long expired, with their files.
void FleetAgents::clear_up() {
  const int64_t now_s = ports_.wall_s();
  std::map<base::Digest, AgentFile> files;
  if (settings_.files.empty()) files = put_;
  std::map<std::string, base::Digest> over;
  const auto add = [&](const Held& order) {
    for (const AgentFile& file : order.files) files[file.digest] = file;
  };
  {
    const std::lock_guard<std::mutex> one(mutex_);
    for (const auto& [agent, order] : held_) {
      const bool ended = order.over || order.expires_s + kLongOverS < now_s;
      if (!ended || !has_ordered_) continue;
      over[agent] = order.id;
      add(order);
    }
    for (const Held& order : replaced_) add(order);
    for (const auto& [agent, order] : held_) {
      if (over.contains(agent)) continue;
      for (const AgentFile& file : order.files) files.erase(file.digest);
    }
  }
  for (const auto& [agent, id] : over) order_is_over(agent, id);
  for (const auto& [digest, file] : files) clear(file);
}

}  // namespace stvm
