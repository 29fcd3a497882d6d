// A timing chart of a run (B11): when each task was due, ran and was suspended, when
// inputs were received and outputs sent, and when the configuration of a change had idle time. As
// an SVG picture, as text for a terminal, as JSON; the same run gives the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/common/json.h"
#include "vm/runtime/controller.h"

namespace stvm {

struct TimeSpan {
  int64_t from_ns = 0;
  int64_t to_ns = 0;
};

struct TimingLane {
  std::string task;
  std::vector<TimeSpan> due;  // released, and not begun
  std::vector<TimeSpan> running;
  std::vector<TimeSpan> suspended;
  std::vector<int64_t> released;
  std::vector<int64_t> missed;
  std::vector<int64_t> trapped;
  std::vector<int64_t> inputs;   // receptions that its scans work with
  std::vector<int64_t> outputs;  // transmissions with what its scans have written
  std::vector<int64_t> own_received;  // further ones, for it alone (B12)
  std::vector<int64_t> own_sent;
};

class TimingChart : public vm::Timeline {
 public:
  // Memory is bounded: what comes after so many moments is left out, and the chart says so.
  static constexpr size_t kMostMoments = 100'000;

  // Lanes of the tasks that have programs, the most urgent first.
  explicit TimingChart(const ir::Image& image);

  void note(vm::Moment moment, std::string_view task, int64_t at_ns) override;
  // Idle time in which a change was configured; its switch.
  void configured(int64_t from_ns, int64_t to_ns);
  void switched(int64_t at_ns) { switches_.push_back(at_ns); }
  // Nothing comes after.
  void end(int64_t at_ns);

  std::string svg(const std::string& title) const;
  std::string text() const;
  void json(tools::JsonWriter& json) const;  // "chart" into an open object

 private:
  struct Open {  // what a lane is in the middle of
    enum class State : uint8_t { kIdle, kDue, kRunning, kSuspended } state = State::kIdle;
    int64_t since_ns = 0;
    bool begun = false;  // its scan has no span yet
  };
  size_t lane_of(std::string_view task);
  // Has any of its tasks exchanged by itself?
  bool has_own() const;
  void become(size_t lane, Open::State state, int64_t at_ns);

  std::vector<TimingLane> lanes_;
  std::vector<Open> open_;
  std::vector<int64_t> cycles_;
  std::vector<int64_t> received_;
  std::vector<int64_t> sent_;
  std::vector<TimeSpan> configuration_;
  std::vector<int64_t> switches_;
  int64_t end_ns_ = 0;
  size_t moments_ = 0;
  bool cut_ = false;
};

}  // namespace stvm
