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
    if (period.left_out.event == event && period.left_out.source == source) return &period;
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
    LeftOut none{event, room ? source : std::string(), 0, 0};
    periods_.push_back({std::move(none), now_ns, at_once(event)});
    period = &periods_.back();
  } else if (period->left_out.count == 0 && now_ns - period->begin_ns >= kPeriodNs) {
    period->begin_ns = now_ns;
    period->left = at_once(event);
  }
  return *period;
}

bool EventLimits::pass(online_change::Event event, const std::string& source, int64_t now_ns) {
  if (online_change::event_row(event).limit == online_change::Limit::kNone) return true;
  Period& now = period(event, source, now_ns);
  if (now.left == 0) {
    ++now.left_out.count;
    return false;
  }
  --now.left;
  return true;
}

void EventLimits::count(online_change::Event event, uint64_t more, int64_t now_ns) {
  if (more != 0) period(event, {}, now_ns).left_out.count += more;
}

std::vector<EventLimits::LeftOut> EventLimits::take_left_out(int64_t now_ns, bool all) {
  std::vector<LeftOut> out;
  for (size_t i = 0; i < periods_.size();) {
    Period& period = periods_[i];
    LeftOut& left_out = period.left_out;
    left_out.span_ns = now_ns - period.begin_ns;
    const bool over = all || left_out.span_ns >= kPeriodNs;
    if (over && left_out.count == 0) {
      std::swap(period, periods_.back());
      periods_.pop_back();
      continue;
    }
    if (over) {
      out.push_back(left_out);
      left_out.count = 0;
      period.begin_ns = now_ns;
      period.left = kWhileFlooded;
    }
    ++i;
  }
  return out;
}

}  // namespace stvm
