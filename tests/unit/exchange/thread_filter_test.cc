// What each kind of thread may ask of Linux. A filter cannot be taken away, so each test is a
// process of its own.
#include "vm/runtime/thread_filter.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <functional>
#include <thread>

namespace vm {
namespace {

enum Call : uint32_t {
  kExecute = 1,
  kTrace = 2,
  kSocket = 4,
  kProtect = 8,     // makes memory executable
  kMap = 16,        // gets executable memory
  kNamespace = 32,  // by unshare and by clone
  kNewer = 64,      // a call that libraries do without
  kOthers = 128,    // to stop another process, and to change its limits
};

// Which of them fail because they are not permitted.
uint32_t refused() {
  uint32_t out = 0;
  const auto note = [&](Call call, int64_t result, int error = EPERM) {
    if (result == -1 && errno == error) out |= call;
  };
  char* const arguments[] = {nullptr};
  note(kExecute, ::execve("/nowhere/at/all", arguments, arguments));
  note(kTrace, ::ptrace(PTRACE_PEEKDATA, 1, nullptr, nullptr));
  note(kSocket, ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  void* const page = ::mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  note(kProtect, ::mprotect(page, 4096, PROT_READ | PROT_EXEC));
  void* const code =
      ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  note(kMap, code == MAP_FAILED ? -1 : 0);
  const int64_t apart = ::syscall(__NR_clone, CLONE_NEWUTS | SIGCHLD, 0, 0, 0, 0);
  if (apart == 0) ::_exit(0);
  if (apart > 0) ::waitpid(static_cast<pid_t>(apart), nullptr, 0);
  note(kNamespace, apart > 0 ? 0 : ::unshare(CLONE_NEWUTS));
  note(kNewer, ::syscall(__NR_faccessat2, AT_FDCWD, "/", F_OK, 0), ENOSYS);
  rlimit limit{};
  const bool stopped = ::syscall(__NR_tgkill, 1, 1, 0) == 0;
  note(kOthers, stopped ? 0 : ::prlimit(1, RLIMIT_NOFILE, nullptr, &limit));
  return out;
}

// What a filter must leave.
bool may_do_as_before() {
  rlimit limit{};
  return ::syscall(__NR_tgkill, ::getpid(), ::syscall(__NR_gettid), 0) == 0 &&
         ::getrlimit(RLIMIT_NOFILE, &limit) == 0 &&
         ::prlimit(::getpid(), RLIMIT_NOFILE, nullptr, &limit) == 0;
}

// What a process answers in whose thread `work` has run, and -1 when it does not live.
int in_a_process(const std::function<uint32_t()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(static_cast<int>(work()));
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

uint32_t refused_to(ThreadKind kind) {
  return confine_thread(kind).ok() && may_do_as_before() ? refused() : 0;
}

TEST(ThreadFilter, EachKindMayDoWhatItNeedsAndTheThreadGoesOn) {
  constexpr uint32_t kAlways = kExecute | kTrace | kNamespace | kNewer | kOthers;
  EXPECT_EQ(in_a_process([] { return refused_to(ThreadKind::kAny); }), int{kAlways});
  EXPECT_EQ(in_a_process([] { return refused_to(ThreadKind::kControl); }),
            int{kAlways | kSocket});
  EXPECT_EQ(in_a_process([] { return refused_to(ThreadKind::kDevice); }),
            int{kAlways | kProtect | kMap});
}

TEST(ThreadFilter, WithoutAFilterNoneOfItIsRefused) {
  EXPECT_EQ(in_a_process(refused) & (kExecute | kSocket | kProtect | kMap | kNewer), 0);
  if (::geteuid() == 0) {
    EXPECT_EQ(in_a_process(refused) & kOthers, 0) << "root may";
  }
}

TEST(ThreadFilter, ItHoldsForOneThreadAndThoseThatItBegins) {
  EXPECT_EQ(in_a_process([] {
              uint32_t own = 0;
              uint32_t begun = 0;
              std::thread([&] {
                own = refused_to(ThreadKind::kControl);
                std::thread([&] { begun = refused(); }).join();
              }).join();
              return own == begun && (own & kSocket) != 0 && (refused() & kSocket) == 0 ? 1u : 0u;
            }),
            1);
}

// A thread of a process that has a filter already loses more, and gets nothing back.
TEST(ThreadFilter, ASecondFilterOnlyTakesAway) {
  EXPECT_EQ(in_a_process([] {
              (void)confine_thread(ThreadKind::kDevice);
              return refused_to(ThreadKind::kAny) & (kProtect | kExecute);
            }),
            int{kProtect | kExecute});
}

}  // namespace
}  // namespace vm
