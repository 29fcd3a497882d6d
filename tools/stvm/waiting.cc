#include "tools/stvm/waiting.h"

#include <chrono>
#include <thread>

namespace stvm {

bool others_change(const base::Error& error) {
  return error.refusal == base::Refusal::kStaleBase ||
         error.refusal == base::Refusal::kChangePending;
}

const base::Error* why_not(const base::Result<Outcome>& outcome) {
  if (!outcome.ok()) return &outcome.error();
  return outcome->refused ? &*outcome->refused : nullptr;
}

base::Status wait_for_others(ControllerClient& client) {
  constexpr auto kLook = std::chrono::milliseconds(100);
  constexpr int kStagedLooks = 50;
  for (int staged = 0;; ++staged) {
    base::Result<vm::StatusReport> status = client.status();
    if (!status.ok()) return status.error();
    if (status->change == "idle") return base::Ok{};
    if (status->edits != 0) {
      staged = 0;
    } else if (staged >= kStagedLooks) {
      return base::Ok{};
    }
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace stvm
