// How many events of one kind and source are told in a row: some at once in each period, and then a
// count when the period is over. A plant that never tires fills no log, and nothing is left out
// without a word. Times of any clock that never goes back; not thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "online_change/store/journal.h"

namespace stvm {

class EventLimits {
 public:
  static constexpr int64_t kPeriodNs = 10'000'000'000;
  static constexpr uint64_t kOfPlant = 5;
  static constexpr uint64_t kOfPeople = 50;
  static constexpr uint64_t kWhileFlooded = 1;  // in a period after one with too many
  // How many sources are counted apart at a time; more share a count.
  static constexpr size_t kMostSources = 256;

  struct LeftOut {
    online_change::Event event{};
    std::string source;
    uint64_t count = 0;
    int64_t span_ns = 0;  // in which they came
  };

  // False: it is left out, and counts.
  bool pass(online_change::Event event, const std::string& source, int64_t now_ns);
  // So many have been left out elsewhere.
  void count(online_change::Event event, uint64_t more, int64_t now_ns);
  // What was left out in periods that are over, or in `all`.
  std::vector<LeftOut> take_left_out(int64_t now_ns, bool all = false);

 private:
  struct Period {
    LeftOut left_out;
    int64_t begin_ns = 0;
    uint64_t left = 0;  // that pass
  };
  Period& period(online_change::Event event, const std::string& source, int64_t now_ns);

  Period* find(online_change::Event event, const std::string& source);

  std::vector<Period> periods_;
};

}  // namespace stvm
