#include "tools/stvm/stop_signal.h"

#include <csignal>

namespace stvm {
namespace {

volatile std::sig_atomic_t stop_received = 0;

void on_signal(int) { stop_received = 1; }

}  // namespace

void StopSignal::install() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A file that may not grow any further is an error of the write, not the end of the process.
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
}

bool StopSignal::received() { return stop_received != 0; }

}  // namespace stvm
