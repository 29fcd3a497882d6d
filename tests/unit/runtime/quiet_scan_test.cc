// Invariant 2: during a scan there is no heap allocation, no lock and no system call. Allocations
// and locks are counted where they would happen; system calls end a child process.
#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

#include "tests/unit/allocations.h"
#include "tests/unit/runtime/plant.h"

namespace {

thread_local bool watched = false;
thread_local uint64_t locks = 0;

}  // namespace

// Stands in front of the C library's.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  if (watched) ++locks;
  return real(mutex);
}

namespace runtime_test {
namespace {

// Strings, charts, timers, objects, traps that are caught, two priorities, events, all buffers.
constexpr const char* kBusy = R"(
INTERFACE IShape METHOD area : LREAL END_METHOD END_INTERFACE
FUNCTION_BLOCK Square IMPLEMENTS IShape VAR side : LREAL := 2.0; END_VAR
  METHOD PUBLIC area : LREAL area := side * side; END_METHOD
END_FUNCTION_BLOCK
VAR_GLOBAL go : BOOL; END_VAR
PROGRAM Work
  VAR t : TON; c : CTU; s : STRING[40]; sq : Square; shape : IShape; i, n : DINT; a : ARRAY[0..9] OF LREAL;
    inp AT %IW0 : WORD; outp AT %QD0 : REAL; bits AT %QX8.0 : ARRAY[0..15] OF BOOL; zero : DINT; END_VAR
  t(IN := NOT t.Q, PT := T#30ms); c(CU := t.Q, PV := 5);
  s := CONCAT(LEFT(s, 20), DINT_TO_STRING(n)); shape := sq;
  FOR i := 0 TO 9 DO a[i] := a[i] + shape.area() + SIN(DINT_TO_LREAL(i)); END_FOR
  __TRY n := n / zero; __CATCH n := n + 1; __ENDTRY
  outp := LREAL_TO_REAL(a[3]); bits[n MOD 16] := t.Q; go := NOT go;
END_PROGRAM
PROGRAM Pulse VAR q AT %QB13 : BYTE; END_VAR q := q + 1; END_PROGRAM
PROGRAM Pulse2 VAR a AT %IB0 : BYTE; q AT %QB14 : BYTE; END_VAR q := a + 1; END_PROGRAM
PROGRAM Slow VAR i, n : DINT; q AT %QB12 : BYTE; END_VAR
  FOR i := 1 TO 15000 DO n := n + i; END_FOR q := DINT_TO_BYTE(n);
END_PROGRAM
PROGRAM Chart VAR n : INT; END_VAR
  INITIAL_STEP a: act(N); END_STEP STEP b: END_STEP
  TRANSITION FROM a TO b := n > 3; END_TRANSITION TRANSITION FROM b TO a := n > 6; END_TRANSITION
  ACTION act: n := (n + 1) MOD 9; END_ACTION
END_PROGRAM
PROGRAM Traps VAR zero, n : DINT; END_VAR n := n + 1; IF n MOD 7 = 0 THEN n := n / zero; END_IF END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'io' := 'synchronous'} {attribute 'input_buffer' := 'three'} {attribute 'output_buffer' := 'three'}
  TASK Late (INTERVAL := T#40ms, PRIORITY := 5);
  {attribute 'input_buffer' := 'swapped_with_flag'} {attribute 'exchange' := 'own'} TASK Edge (SINGLE := go, PRIORITY := 3);
  {attribute 'output_buffer' := 'first_unseen'} TASK Tick (INTERVAL := T#10ms, PRIORITY := 4);
  {attribute 'overrun' := 'stretch'} {attribute 'on_trap' := 'go_on'} TASK Bad (INTERVAL := T#20ms, PRIORITY := 2);
  {attribute 'freewheeling'} TASK Free (PRIORITY := 9);
  PROGRAM W WITH Fast : Work; PROGRAM S WITH Late : Slow; PROGRAM K WITH Edge : Chart; PROGRAM T WITH Bad : Traps;
  PROGRAM U WITH Tick : Pulse; PROGRAM V WITH Edge : Pulse2;
END_RESOURCE END_CONFIGURATION
)";

vm::ControllerOptions small_slices() {
  vm::ControllerOptions options;
  options.fuel_slice = 100;
  return options;
}

// A trap is a value of the scan, but its text is made outside (Scheduler::trap_in); until then a
// trap may allocate.
TEST(QuietScan, NoAllocationAndNoLock) {
  Plant plant(kBusy, small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(50);
  locks = 0;
  uint64_t allocated = 0;
  uint64_t quiet = 0;
  for (int i = 0; i < 500; ++i) {
    const uint64_t traps = plant->trap_count();
    const uint64_t before = tests::allocations();
    watched = true;
    plant.cycles(1);
    watched = false;
    if (plant->trap_count() != traps) continue;
    allocated += tests::allocations() - before;
    ++quiet;
  }
  EXPECT_EQ(allocated, 0u);
  EXPECT_EQ(locks, 0u);
  EXPECT_GT(quiet, 300u);
  EXPECT_GT(plant->trap_count(), 20u);
  // The counters do count.
  const uint64_t before = tests::allocations();
  watched = true;
  ::operator delete(::operator new(8));
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);
  watched = false;
  pthread_mutex_unlock(&mutex);
  EXPECT_EQ(tests::allocations(), before + 1);
  EXPECT_EQ(locks, 1u);
}

// With UBSan a look at an object's type may make some beside the scan: it asks by a pipe whether
// the memory can be read. Its table of known types is there only then.
extern "C" __attribute__((weak)) uintptr_t __ubsan_vptr_type_cache[];
std::vector<uint32_t> may_call() {
  std::vector<uint32_t> calls = {__NR_exit_group};
  if (__ubsan_vptr_type_cache != nullptr) {
    calls.insert(calls.end(), {__NR_pipe2, __NR_write, __NR_close});
  }
#ifdef STC_SANITIZED_HEAP  // which takes memory for the traps of these scans
  calls.insert(calls.end(), {__NR_mmap, __NR_munmap, __NR_madvise});
#endif
  return calls;
}

// From now on the process ends at every other system call.
bool forbid_system_calls() {
  std::vector<sock_filter> rules = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
  };
  for (const uint32_t call : may_call()) {
    rules.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
    rules.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  rules.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
  sock_fprog program{static_cast<unsigned short>(rules.size()), rules.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

constexpr int kQuiet = 0;
constexpr int kNoSeccomp = 77;

// The exit code of a child that runs `work` without system calls, or -1 when one ended it.
template <class Work>
int without_system_calls(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    if (!forbid_system_calls()) _exit(kNoSeccomp);
    work();
    syscall(__NR_exit_group, kQuiet);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(QuietScan, NoSystemCall) {
  Plant plant(kBusy, small_slices(), 1000);
  ASSERT_TRUE(plant.ok());
  plant.cycles(200);
  const int code = without_system_calls([&] { plant.cycles(1000); });
  if (code == kNoSeccomp) GTEST_SKIP() << "this machine has no seccomp";
  EXPECT_EQ(code, kQuiet);
  // The filter does find one.
  EXPECT_EQ(without_system_calls([] { [[maybe_unused]] const pid_t id = getppid(); }), -1);
}

}  // namespace
}  // namespace runtime_test
