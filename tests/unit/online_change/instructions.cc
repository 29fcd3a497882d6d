#include "tests/unit/online_change/instructions.h"

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace plant {
namespace {

// The child stops itself around the call, so that its parent knows where it begins and ends.
[[noreturn]] void run_traced(const std::function<void()>& call) {
  if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
  raise(SIGSTOP);
  call();
  raise(SIGUSR1);
  _exit(0);
}

bool stopped_by(pid_t child, int signal) {
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFSTOPPED(status) && WSTOPSIG(status) == signal;
}

uint64_t steps_until_end(pid_t child) {
  for (uint64_t steps = 0;; ++steps) {
    int status = 0;
    if (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0) return 0;
    if (waitpid(child, &status, 0) != child || !WIFSTOPPED(status)) return 0;
    if (WSTOPSIG(status) == SIGUSR1) return steps;
    if (WSTOPSIG(status) != SIGTRAP) return 0;
  }
}

std::optional<uint64_t> count(const std::function<void()>& call) {
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) run_traced(call);
  const uint64_t steps = stopped_by(child, SIGSTOP) ? steps_until_end(child) : 0;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return steps == 0 ? std::nullopt : std::optional<uint64_t>(steps);
}

}  // namespace

std::optional<uint64_t> count_instructions(const std::function<void()>& call) {
  const std::optional<uint64_t> nothing = count([] {});
  const std::optional<uint64_t> all = count(call);
  if (!nothing || !all) return std::nullopt;
  return *all - *nothing;
}

}  // namespace plant
