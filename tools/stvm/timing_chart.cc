#include "tools/stvm/timing_chart.h"

#include <algorithm>

namespace stvm {

using vm::Moment;

TimingChart::TimingChart(const ir::Image& image) {
  std::vector<const ir::ImageTask*> tasks;
  for (const ir::ImageTask& task : image.tasks) {
    if (!task.programs.empty() && !task.once) tasks.push_back(&task);
  }
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const auto* a, const auto* b) { return a->priority < b->priority; });
  for (const ir::ImageTask* task : tasks) lane_of(task->name);
}

size_t TimingChart::lane_of(std::string_view task) {
  for (size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].task == task) return i;
  }
  lanes_.emplace_back().task = task;
  open_.emplace_back();
  return lanes_.size() - 1;
}

// What takes no time leaves no span.
void TimingChart::become(size_t lane, Open::State state, int64_t at_ns) {
  Open& open = open_[lane];
  TimingLane& row = lanes_[lane];
  std::vector<TimeSpan>* spans = open.state == Open::State::kDue         ? &row.due
                                 : open.state == Open::State::kRunning   ? &row.running
                                 : open.state == Open::State::kSuspended ? &row.suspended
                                                                         : nullptr;
  if (spans != nullptr && open.since_ns < at_ns) {
    const bool goes_on = !open.begun && !spans->empty() && spans->back().to_ns == open.since_ns;
    if (goes_on) {
      spans->back().to_ns = at_ns;
    } else {
      spans->push_back({open.since_ns, at_ns});
    }
    open.begun = false;
  }
  open.state = state;
  open.since_ns = at_ns;
}

void TimingChart::note(Moment moment, std::string_view task, int64_t at_ns) {
  if (cut_ || ++moments_ > kMostMoments) {
    if (!cut_) end(at_ns);
    cut_ = true;
    return;
  }
  if (moment == Moment::kCycle) return cycles_.push_back(at_ns);
  if (moment == Moment::kReceived && task.empty()) return received_.push_back(at_ns);
  if (moment == Moment::kSent && task.empty()) return sent_.push_back(at_ns);
  const size_t number = lane_of(task);
  TimingLane& lane = lanes_[number];
  switch (moment) {
    case Moment::kReleased:
      lane.released.push_back(at_ns);
      if (open_[number].state == Open::State::kIdle) become(number, Open::State::kDue, at_ns);
      break;
    case Moment::kMissed:
      return lane.missed.push_back(at_ns);
    case Moment::kBegun:
      become(number, Open::State::kRunning, at_ns);
      open_[number].begun = true;
      return;
    case Moment::kResumed:
      return become(number, Open::State::kRunning, at_ns);
    case Moment::kSuspended:
      return become(number, Open::State::kSuspended, at_ns);
    case Moment::kTrapped:
      lane.trapped.push_back(at_ns);
      return become(number, Open::State::kIdle, at_ns);
    case Moment::kEnded:
      return become(number, Open::State::kIdle, at_ns);
    case Moment::kInputsOf:
      return lane.inputs.push_back(at_ns);
    case Moment::kOutputsOf:
      return lane.outputs.push_back(at_ns);
    case Moment::kReceived:
      return lane.own_received.push_back(at_ns);
    case Moment::kSent:
      return lane.own_sent.push_back(at_ns);
    default:
      break;
  }
}

bool TimingChart::has_own() const {
  for (const TimingLane& lane : lanes_) {
    if (!lane.own_received.empty() || !lane.own_sent.empty()) return true;
  }
  return false;
}

void TimingChart::configured(int64_t from_ns, int64_t to_ns) {
  if (from_ns < to_ns) configuration_.push_back({from_ns, to_ns});
}

void TimingChart::end(int64_t at_ns) {
  if (cut_) return;
  end_ns_ = at_ns;
  for (size_t i = 0; i < lanes_.size(); ++i) become(i, open_[i].state, at_ns);
}

namespace {

void spans_json(tools::JsonWriter& json, const char* name, const std::vector<TimeSpan>& spans) {
  json.key(name).begin_array();
  for (const TimeSpan& span : spans) {
    json.begin_object().field("from_ns", span.from_ns).field("to_ns", span.to_ns).end_object();
  }
  json.end_array();
}

void times_json(tools::JsonWriter& json, const char* name, const std::vector<int64_t>& times) {
  json.key(name).begin_array();
  for (const int64_t at_ns : times) json.value(at_ns);
  json.end_array();
}

}  // namespace

void TimingChart::json(tools::JsonWriter& json) const {
  json.key("chart").begin_object().field("end_ns", end_ns_).field("cut_off", cut_);
  times_json(json, "cycles_ns", cycles_);
  times_json(json, "received_ns", received_);
  times_json(json, "sent_ns", sent_);
  json.key("tasks").begin_array();
  for (const TimingLane& lane : lanes_) {
    json.begin_object().field("name", lane.task);
    times_json(json, "released_ns", lane.released);
    times_json(json, "missed_ns", lane.missed);
    times_json(json, "trapped_ns", lane.trapped);
    spans_json(json, "running", lane.running);
    spans_json(json, "suspended", lane.suspended);
    times_json(json, "inputs_received_ns", lane.inputs);
    times_json(json, "outputs_sent_ns", lane.outputs);
    times_json(json, "own_received_ns", lane.own_received);
    times_json(json, "own_sent_ns", lane.own_sent);
    json.end_object();
  }
  json.end_array();
  spans_json(json, "configuration", configuration_);
  times_json(json, "switches_ns", switches_);
  json.end_object();
}

}  // namespace stvm
