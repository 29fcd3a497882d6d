#include "tools/stvm/log_output.h"

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_text.h"

namespace stvm {
namespace {

using std::chrono::steady_clock;

constexpr int kLookMs = 50;
constexpr std::chrono::milliseconds kLastPatience{1000};

}  // namespace

struct LogOutput::Core {
  Core(int to, bool journald) : descriptor(to), for_journald(journald) {}

  void run();
  bool write(const std::string& line);
  bool gives_up() const { return ending && steady_clock::now() >= end_by; }  // with `mutex`
  bool must_give_up();
  std::string lost_line(uint64_t count) const;
  uint64_t say_missing(uint64_t count);

  const int descriptor;
  const bool for_journald;

  std::mutex mutex;  // never held while a line is written
  std::condition_variable changed;
  std::vector<std::string> lines;  // that wait
  size_t in_hand = 0;              // that the thread has taken, and not written yet
  uint64_t lost = 0;               // after those that wait
  bool ending = false;
  steady_clock::time_point end_by{};
  bool ended = false;
};

bool LogOutput::Core::must_give_up() {
  const std::lock_guard lock(mutex);
  return gives_up();
}

// Waits until some of it has room, so that the call itself does not wait, mostly.
bool LogOutput::Core::write(const std::string& line) {
  if (descriptor < 0) return false;
  for (size_t done = 0; done < line.size();) {
    pollfd wanted{descriptor, POLLOUT, 0};
    const int ready = ::poll(&wanted, 1, kLookMs);
    if (ready == 0 && must_give_up()) return false;
    if (ready == 0) continue;
    const ssize_t written = ::write(descriptor, line.data() + done, line.size() - done);
    const bool again = written < 0 && (errno == EINTR || errno == EAGAIN);
    if (written < 0 && !again) return false;
    if (written > 0) done += static_cast<size_t>(written);
    if (again && must_give_up()) return false;
  }
  return true;
}

std::string LogOutput::Core::lost_line(uint64_t count) const {
  return log_line(online_change::Level::kWarning, wall_time_ns(),
                  std::to_string(count) +
                      " lines are missing here: they could not be written; "
                      "`stvm events` has the newest",
                  for_journald);
}

// So many lines have not been written where it writes now. How many are still to be said.
uint64_t LogOutput::Core::say_missing(uint64_t count) {
  return count == 0 || write(lost_line(count)) ? 0 : count;
}

void LogOutput::Core::run() {
  uint64_t unsaid = 0;
  std::vector<std::string> batch;
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return ending || !lines.empty() || lost != 0; });
    if ((lines.empty() && lost == 0) || gives_up()) break;
    std::swap(batch, lines);
    in_hand = batch.size();
    const uint64_t behind = std::exchange(lost, 0);
    for (const std::string& line : batch) {
      if (gives_up()) break;
      lock.unlock();
      unsaid = say_missing(unsaid);
      if (unsaid != 0 || !write(line)) ++unsaid;
      lock.lock();
      --in_hand;
    }
    batch.clear();
    lock.unlock();
    unsaid = say_missing(unsaid + behind);
    lock.lock();
  }
  ended = true;
  changed.notify_all();
}

LogOutput::LogOutput(int descriptor, bool for_journald)
    : core_(std::make_shared<Core>(descriptor, for_journald)) {}

LogOutput::~LogOutput() {
  std::unique_lock lock(core_->mutex);
  core_->ending = true;
  core_->end_by = steady_clock::now() + kLastPatience;
  core_->changed.notify_all();
  if (!thread_.joinable()) {
    lock.unlock();
    core_->run();
    return;
  }
  const bool ended =
      core_->changed.wait_for(lock, 2 * kLastPatience, [this] { return core_->ended; });
  lock.unlock();
  ended ? thread_.join() : thread_.detach();
}

void LogOutput::start() {
  thread_ = std::thread([core = core_] { core->run(); });
}

void LogOutput::add(online_change::Level level, int64_t time_ns, const std::string& text) {
  std::string line = log_line(level, time_ns, text, core_->for_journald);
  const std::lock_guard lock(core_->mutex);
  // After one that is missing all are, until that can be said: they stay in their order.
  if (core_->lost != 0 || core_->lines.size() + core_->in_hand >= kMostLines) {
    ++core_->lost;
    return;
  }
  core_->lines.push_back(std::move(line));
  core_->changed.notify_all();
}

size_t LogOutput::waiting() const {
  const std::lock_guard lock(core_->mutex);
  return core_->lines.size() + core_->in_hand;
}

bool LogOutput::is_journal(int descriptor, const char* stream) {
  struct stat info {};
  if (stream == nullptr || ::fstat(descriptor, &info) != 0) return false;
  char own[48];
  std::snprintf(own, sizeof own, "%llu:%llu", static_cast<unsigned long long>(info.st_dev),
                static_cast<unsigned long long>(info.st_ino));
  return std::strcmp(own, stream) == 0;
}

}  // namespace stvm
