#include "tools/stvm/first_scans.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/stvm/controller_service.h"
#include "tools/stvm/trap_text.h"

namespace stvm {
namespace {

constexpr uint64_t kScans = 10;
constexpr int64_t kLongestPeriodNs = 50'000'000;
constexpr auto kBetween = std::chrono::milliseconds(10);
constexpr auto kLongest = std::chrono::seconds(2);

bool have_run(const vm::StatusReport& before, const vm::StatusReport& now) {
  if (now.faulted || now.tasks.size() != before.tasks.size()) return false;
  for (size_t i = 0; i < now.tasks.size(); ++i) {
    const int64_t period = before.tasks[i].period_ns;
    const bool fast = period > 0 && period <= kLongestPeriodNs;
    if (fast && now.tasks[i].scans < before.tasks[i].scans + kScans) return false;
  }
  return true;
}

// The alarm of that, which the next change ends.
const std::string* given_back(const vm::StatusReport& now) {
  const auto alarm = std::ranges::find_if(now.alarms, [](const std::string& text) {
    return text.find(kGivenBackMark) != std::string::npos;
  });
  return alarm == now.alarms.end() ? nullptr : &*alarm;
}

// Until `ends` says why, or the tasks have run.
template <class Ends>
base::Status watch_scans(ControllerClient& client, const Ends& ends) {
  base::Result<vm::StatusReport> before = client.status();
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (before.ok()) {
    const base::Result<vm::StatusReport> now = client.status();
    if (!now.ok()) break;
    if (base::Status goes_on = ends(*now); !goes_on.ok()) return goes_on;
    if (have_run(*before, *now) || std::chrono::steady_clock::now() >= end) break;
    std::this_thread::sleep_for(kBetween);
  }
  return base::Ok{};
}

}  // namespace

base::Status first_scans(ControllerClient& client) {
  return watch_scans(client, [](const vm::StatusReport& now) -> base::Status {
    const std::string* const why = given_back(now);
    if (why == nullptr) return base::Ok{};
    return base::Error{base::Refusal::kGivenBack, *why};
  });
}

base::Status first_scans_back(ControllerClient& client, uint64_t from) {
  return watch_scans(client, [&](const vm::StatusReport& now) -> base::Status {
    const bool stops = now.faulted || std::ranges::any_of(now.tasks, &vm::TaskStatus::stopped);
    if (!stops || now.traps.empty() || now.traps.back().cycle < from) return base::Ok{};
    return base::Error{base::Refusal::kFault,
                       "the program that came back stops: " + trap_text(now.traps.back()) +
                           "; `stvm redo` brings the edit again, with the values"};
  });
}

}  // namespace stvm
