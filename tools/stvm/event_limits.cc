#include "tools/stvm/event_limits.h"

#include <utility>

namespace stvm {
namespace {

uint64_t at_once(online_change::Event event) {
  const bool people = online_change::event_row(event).limit == online_change::Limit::kPeople;
  return people ? EventLimits::kOfPeople : EventLimits::kOfPlant;
}

}  // namespace

EventLimits::Period* EventLimits::find(online_change::Event event, const std::string& source) {
  for (Period& period : periods_) {
    if (period.event == event && period.source == source) return &period;
  }
  return nullptr;
}

// One that is over, and whose count nobody has taken, goes on.
EventLimits::Period& EventLimits::period(online_change::Event event, const std::string& source,
                                         int64_t now_ns) {
  const bool room = periods_.size() < kMostSources;
  Period* period = find(event, source);
  if (period == nullptr && !room) period = find(event, {});
  if (period == nullptr) {
    period = &periods_.emplace_back(
        Period{event, room ? source : std::string(), now_ns, at_once(event), 0});
  } else if (period->left_out == 0 && now_ns - period->begin_ns >= kPeriodNs) {
    period->begin_ns = now_ns;
    period->left = at_once(event);
  }
  return *period;
}

bool EventLimits::pass(online_change::Event event, const std::string& source, int64_t now_ns) {
  if (online_change::event_row(event).limit == online_change::Limit::kNone) return true;
  Period& now = period(event, source, now_ns);
  if (now.left == 0) {
    ++now.left_out;
    return false;
  }
  --now.left;
  return true;
}

void EventLimits::count(online_change::Event event, uint64_t more, int64_t now_ns) {
  if (more != 0) period(event, {}, now_ns).left_out += more;
}

std::vector<EventLimits::LeftOut> EventLimits::take_left_out(int64_t now_ns, bool all) {
  std::vector<LeftOut> out;
  for (size_t i = 0; i < periods_.size();) {
    Period& period = periods_[i];
    const int64_t span_ns = now_ns - period.begin_ns;
    const bool over = all || span_ns >= kPeriodNs;
    if (over && period.left_out == 0) {
      std::swap(period, periods_.back());
      periods_.pop_back();
      continue;
    }
    if (over) {
      out.push_back({period.event, period.source, period.left_out, span_ns});
      period.begin_ns = now_ns;
      period.left = kWhileFlooded;
      period.left_out = 0;
    }
    ++i;
  }
  return out;
}

}  // namespace stvm
