// A broker in this process: it keeps what is retained, and does to messages what a test wants of a
// bad network: it loses them, repeats them, turns their order around.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <vector>

#include "adapters/mqtt/broker.h"

namespace fleet_test {

class Hub;

class HubBroker : public mqtt::Broker {
 public:
  HubBroker(Hub& hub, std::optional<mqtt::Message> will);
  ~HubBroker() override;
  base::Status publish(const std::string& topic, base::ByteSpan payload, bool retained) override;
  base::Status subscribe(const std::string& filter) override;
  base::Status unsubscribe(const std::string& filter) override;
  std::optional<mqtt::Event> wait(int64_t ms) override;
  bool flush(int64_t) override { return true; }

 private:
  friend class Hub;
  Hub& hub_;
  std::optional<mqtt::Message> will_;
  std::set<std::string> filters_;
  std::deque<mqtt::Event> events_;
};

class Hub {
 public:
  // What becomes of one message on its way to a subscriber; without it, it comes once.
  std::function<std::vector<mqtt::Message>(const mqtt::Message&)> bad_network;

  std::map<std::string, base::Bytes> retained() {
    const std::lock_guard<std::mutex> one(mutex_);
    return retained_;
  }
  size_t published(const std::string& topic) {
    const std::lock_guard<std::mutex> one(mutex_);
    return published_[topic];
  }
  // What was said there last, whether or not it is kept.
  base::Bytes last(const std::string& topic) {
    const std::lock_guard<std::mutex> one(mutex_);
    return last_[topic];
  }
  void publish(const std::string& topic, base::ByteSpan payload, bool retained) {
    const std::lock_guard<std::mutex> one(mutex_);
    send(topic, payload, retained);
  }

 private:
  friend class HubBroker;
  static bool fits(const std::string& filter, const std::string& topic) {
    const size_t plus = filter.find('+');
    if (plus == std::string::npos) return filter == topic;
    const std::string_view before(filter.data(), plus);
    const std::string_view after = std::string_view(filter).substr(plus + 1);
    return topic.starts_with(before) && topic.ends_with(after) &&
           topic.find('/', plus) == (after.empty() ? std::string::npos : topic.size() - after.size());
  }
  void give(HubBroker& to, mqtt::Message message) {
    std::vector<mqtt::Message> all{message};
    if (bad_network) all = bad_network(message);
    for (mqtt::Message& one : all) to.events_.push_back({mqtt::Event::Kind::kMessage, one, ""});
  }
  void send(const std::string& topic, base::ByteSpan payload, bool retained) {
    ++published_[topic];
    base::Bytes bytes(payload.begin(), payload.end());
    last_[topic] = bytes;
    if (retained) retained_[topic] = bytes;
    if (retained && bytes.empty()) retained_.erase(topic);
    for (HubBroker* to : connected_) {
      const bool wants = std::any_of(to->filters_.begin(), to->filters_.end(),
                                     [&](const std::string& one) { return fits(one, topic); });
      if (wants) give(*to, {topic, bytes, false});
    }
    came_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable came_;
  std::map<std::string, base::Bytes> retained_;
  std::map<std::string, base::Bytes> last_;
  std::map<std::string, size_t> published_;
  std::set<HubBroker*> connected_;
};

inline HubBroker::HubBroker(Hub& hub, std::optional<mqtt::Message> will)
    : hub_(hub), will_(std::move(will)) {
  const std::lock_guard<std::mutex> one(hub_.mutex_);
  hub_.connected_.insert(this);
  events_.push_back({mqtt::Event::Kind::kConnected, {}, ""});
}
inline HubBroker::~HubBroker() {
  const std::lock_guard<std::mutex> one(hub_.mutex_);
  hub_.connected_.erase(this);
  if (will_) hub_.send(will_->topic, will_->payload, true);
}
inline base::Status HubBroker::publish(const std::string& topic, base::ByteSpan payload,
                                       bool retained) {
  hub_.publish(topic, payload, retained);
  return base::Ok{};
}
inline base::Status HubBroker::subscribe(const std::string& filter) {
  const std::lock_guard<std::mutex> one(hub_.mutex_);
  filters_.insert(filter);
  for (const auto& [topic, payload] : hub_.retained_) {
    if (Hub::fits(filter, topic)) hub_.give(*this, {topic, payload, true});
  }
  hub_.came_.notify_all();
  return base::Ok{};
}
inline base::Status HubBroker::unsubscribe(const std::string& filter) {
  const std::lock_guard<std::mutex> one(hub_.mutex_);
  filters_.erase(filter);
  return base::Ok{};
}
inline std::optional<mqtt::Event> HubBroker::wait(int64_t ms) {
  std::unique_lock<std::mutex> held(hub_.mutex_);
  hub_.came_.wait_for(held, std::chrono::milliseconds(ms), [this] { return !events_.empty(); });
  if (events_.empty()) return std::nullopt;
  mqtt::Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

}  // namespace fleet_test
