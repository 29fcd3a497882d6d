#include "tools/stvm/stop_signal.h"

#include <atomic>
#include <csignal>

namespace stvm {
namespace {

std::atomic<bool> stop_received{false};
std::atomic<bool> hangup_received{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_stop(int) { stop_received = true; }
void on_hangup(int) { hangup_received = true; }

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

// `nohup` starts a process so.
bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void StopSignal::install() {
  handle(SIGINT, on_stop);
  handle(SIGTERM, on_stop);
}

void StopSignal::install_for_outputs() {
  install();
  if (!is_ignored(SIGHUP)) handle(SIGHUP, on_stop);
  for (const int number : {SIGPIPE, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF,
                           SIGXCPU, SIGPOLL, SIGPWR, SIGSTKFLT}) {
    handle(number, on_stop);
  }
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) handle(number, on_stop);
  for (const int number : {SIGTSTP, SIGTTIN, SIGTTOU}) handle(number, SIG_IGN);
}

void StopSignal::install_service() {
  install_for_outputs();
  handle(SIGHUP, on_hangup);
  handle(SIGPIPE, SIG_IGN);
}

bool StopSignal::received() { return stop_received; }

bool StopSignal::take_hangup() { return hangup_received && hangup_received.exchange(false); }

}  // namespace stvm
