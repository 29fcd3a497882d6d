// A timing chart as text, for a terminal of 80 columns.
#include <algorithm>

#include "tools/stvm/timing_chart.h"
#include "tools/stvm/timing_scale.h"

namespace stvm {
namespace {

constexpr size_t kChartColumns = 64;
constexpr size_t kNameWidth = 14;

// What is drawn later lies on top.
class TextRow {
 public:
  TextRow(std::string name, int64_t end_ns) : name_(std::move(name)), end_ns_(end_ns) {
    if (name_.size() > kNameWidth) name_ = name_.substr(0, kNameWidth - 2) + "..";
    name_.resize(kNameWidth + 1, ' ');
  }
  void span(const TimeSpan& span, char c) {
    const size_t from = column(span.from_ns);
    const size_t to = std::max(column(span.to_ns - 1), from);
    for (size_t i = from; i <= to; ++i) cells_[i] = c;
  }
  void spans(const std::vector<TimeSpan>& all, char c) {
    for (const TimeSpan& one : all) span(one, c);
  }
  void times(const std::vector<int64_t>& all, char c) {
    for (const int64_t at_ns : all) cells_[column(at_ns)] = c;
  }
  size_t column(int64_t at_ns) const {
    const double share = static_cast<double>(at_ns) / static_cast<double>(end_ns_);
    const auto number = static_cast<size_t>(share * static_cast<double>(kChartColumns));
    return std::min(number, kChartColumns - 1);
  }
  void words(size_t at, const std::string& words) {
    if (at + words.size() <= kChartColumns) cells_.replace(at, words.size(), words);
  }
  std::string text() const {
    std::string out = name_ + cells_;
    out.erase(out.find_last_not_of(' ') + 1);
    return out + "\n";
  }

 private:
  std::string name_;
  int64_t end_ns_;
  std::string cells_ = std::string(kChartColumns, ' ');
};

}  // namespace

TimeScale TimeScale::of(int64_t end_ns, int64_t ticks) {
  for (int64_t ten = 1;; ten *= 10) {
    for (const int64_t digit : {1, 2, 5}) {
      if (end_ns / (digit * ten) <= ticks) return {digit * ten};
    }
  }
}

std::string TimeScale::text(int64_t at_ns) const {
  static constexpr struct {
    int64_t unit;
    const char* name;
  } kUnits[] = {{1'000'000'000, " s"}, {1'000'000, " ms"}, {1'000, " us"}, {1, " ns"}};
  for (const auto& [unit, name] : kUnits) {
    if (step_ns % unit == 0) return std::to_string(at_ns / unit) + name;
  }
  return "";
}

std::string TimingChart::text() const {
  const int64_t end = std::max<int64_t>(end_ns_, 1);
  TextRow axis("", end);
  const TimeScale scale = TimeScale::of(end, 5);
  for (int64_t at_ns = 0; at_ns < end; at_ns += scale.step_ns) {
    axis.words(axis.column(at_ns), scale.text(at_ns));
  }
  TextRow received("received", end);
  for (const TimingLane& lane : lanes_) received.times(lane.own_received, '+');
  received.times(received_, '|');
  std::string out = axis.text() + received.text();
  for (const TimingLane& lane : lanes_) {
    TextRow row(lane.task, end);
    row.spans(lane.due, '.');
    row.spans(lane.suspended, '-');
    row.spans(lane.running, '#');
    row.times(lane.missed, 'x');
    row.times(lane.trapped, '!');
    out += row.text();
  }
  TextRow sent("sent", end);
  for (const TimingLane& lane : lanes_) sent.times(lane.own_sent, '+');
  sent.times(sent_, '|');
  out += sent.text();
  if (!configuration_.empty() || !switches_.empty()) {
    TextRow row("configuration", end);
    row.spans(configuration_, '=');
    row.times(switches_, 'S');
    out += row.text();
  }
  out += "  # running  - suspended  . due, others run  x missed  ! trapped";
  if (!switches_.empty()) out += "  S switch";
  if (has_own()) out += "\n  + for one task alone";
  return out + (cut_ ? "\n  the beginning of a longer run\n" : "\n");
}

}  // namespace stvm
