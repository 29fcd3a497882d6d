// What a broker says of the agents that a tool talks to: what it is told is kept until somebody
// asks.
#include <algorithm>
#include <chrono>

#include "tools/stvm/fleet_agents.h"

namespace stvm {

using std::chrono::milliseconds;

// In this order: whose `about` is known, of that one the rest is known, too.
void FleetAgents::subscribe_all() {
  std::vector<std::string> names;
  {
    const std::lock_guard<std::mutex> one(mutex_);
    held_.clear();
    (void)ports_.broker->subscribe(settings_.topics.of("+", kAgentDesired));
    for (const auto& [name, known] : known_) names.push_back(name);
    if (pieces_) {
      (void)ports_.broker->subscribe(settings_.topics.file(pieces_->file().digest, "+"));
    }
  }
  for (const std::string& name : names) {
    for (const char* what : {kAgentOnline, kAgentAnswer, kAgentAbout}) {
      (void)ports_.broker->subscribe(settings_.topics.of(name, what));
    }
  }
}

void FleetAgents::take(const mqtt::Event& event) {
  using Kind = mqtt::Event::Kind;
  if (event.kind == Kind::kConnected) return subscribe_all();
  {
    const std::lock_guard<std::mutex> one(mutex_);
    if (event.kind == Kind::kMessage) take(event.message);
    // Without a broker nobody answers.
    if (event.kind == Kind::kLost) {
      for (auto& [name, known] : known_) known.online = false;
    }
  }
  came_.notify_all();
}

void FleetAgents::take(const mqtt::Message& message) {
  if (pieces_) {
    const std::string topic = settings_.topics.file(pieces_->file().digest, "");
    if (message.topic.starts_with(topic)) {
      (void)pieces_->add(std::string_view(message.topic).substr(topic.size()), message.payload);
      return;
    }
  }
  const size_t slash = message.topic.rfind('/');
  const size_t before = slash == std::string::npos ? slash : message.topic.rfind('/', slash - 1);
  if (before == std::string::npos) return;
  const std::string name = message.topic.substr(before + 1, slash - before - 1);
  const std::string what = message.topic.substr(slash + 1);
  if (what == kAgentDesired) return take_order(name, message.payload);
  const auto found = known_.find(name);
  if (found == known_.end()) return;
  Known& known = found->second;
  if (what == kAgentOnline) {
    known.online = message.payload.size() == 1 && message.payload[0] == '1';
    for (const auto& [id, asked] : asked_) {
      if (!known.online || asked.agent != name || asked.question.empty()) continue;
      (void)ports_.broker->publish(settings_.topics.of(name, kAgentDesired), asked.question, false);
    }
  } else if (what == kAgentAbout) {
    base::Result<AgentAbout> about = decode_agent_about(message.payload);
    if (about.ok()) known.about = std::move(*about);
  } else if (what == kAgentAnswer) {
    base::Result<AgentAnswer> answer = decode_agent_answer(message.payload);
    if (answer.ok()) take_answer(name, std::move(*answer));
  }
}

void FleetAgents::take_answer(const std::string& agent, AgentAnswer answer) {
  Known& known = known_[agent];
  if (answer.ends() && known.waits_for == answer.order) known.waits_for.reset();
  const auto held = held_.find(agent);
  if (held != held_.end() && held->second.id == answer.order) held->second.over = answer.ends();
  const auto asked = asked_.find(answer.order);
  if (asked != asked_.end()) asked->second.answer = std::move(answer);
}

base::Result<FleetAgents::Known> FleetAgents::wait_for(const FleetMember& member) {
  std::unique_lock<std::mutex> held(mutex_);
  const Known& known = known_[member.place];
  came_.wait_for(held, milliseconds(settings_.patience_ms),
                 [&] { return known.about.has_value(); });
  if (known.about) return known;
  return base::Error{base::Refusal::kNotRunning,
                     "the broker knows no agent `" + member.place + "`, or does not answer"};
}

bool FleetAgents::is_online(const FleetMember& member) {
  base::Result<Known> known = wait_for(member);
  return known.ok() && known->online;
}

}  // namespace stvm
