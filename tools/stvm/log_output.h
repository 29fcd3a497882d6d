// The lines of a service on its standard error. Whoever adds one never waits: a thread writes them,
// and what a terminal, a pipe that nobody reads or a full disk does not take is counted, and said
// where it is missing.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "online_change/store/journal.h"

namespace stvm {

class LogOutput {
 public:
  static constexpr size_t kMostLines = 512;  // that wait

  // `for_journald`: lines begin with the level as journald reads it, else with time and level.
  LogOutput(int descriptor, bool for_journald);
  // Writes what waits, for a second at most.
  ~LogOutput();
  LogOutput(const LogOutput&) = delete;
  LogOutput& operator=(const LogOutput&) = delete;

  // From here on a thread writes; until then lines wait.
  void start();
  // Any thread. `time_ns`: of the wall clock.
  void add(online_change::Level level, int64_t time_ns, const std::string& text);

  // Lines that are not written yet.
  size_t waiting() const;

  // Does `stream`, the value of $JOURNAL_STREAM ("device:inode"), name what `descriptor` leads to?
  static bool is_journal(int descriptor, const char* stream);

 private:
  struct Core;
  std::shared_ptr<Core> core_;  // its thread may outlive this, inside of a call that does not end
  std::thread thread_;
};

}  // namespace stvm
