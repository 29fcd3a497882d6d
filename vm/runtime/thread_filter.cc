#include "vm/runtime/thread_filter.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <vector>

namespace vm {
namespace {

#if defined(__x86_64__)
constexpr uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
constexpr uint32_t kArchitecture = 0;
#endif

struct Permit {
  uint32_t call;
  bool control;
  bool device;
};
constexpr Permit kPermits[] = {
#define PERMIT(call, control, device) {__NR_##call, control, device},
#include "vm/runtime/system_calls.def"
#undef PERMIT
};
// From Linux 5.1 on a call has the same number on every processor. Libraries know what to do
// without those: they use older calls, but only when the kernel says that it has no such call.
constexpr uint32_t kLastOld = 423;

constexpr uint32_t kNamespaces = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC |
                                 CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET;

bool permits(const Permit& permit, ThreadKind kind) {
  if (kind == ThreadKind::kControl) return permit.control;
  return kind == ThreadKind::kAny || permit.device;
}

constexpr uint32_t refuse_with(uint32_t error) { return SECCOMP_RET_ERRNO | error; }

// A program of the kernel's filter machine: it looks at one word of the call at a time.
class Filter {
 public:
  Filter() { code_.reserve(2 * std::size(kPermits) + 32); }

  void load(size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<uint32_t>(offset)); }
  void load_argument(int number) {  // its low half, on these little-endian processors
    load(offsetof(seccomp_data, args) + 8 * static_cast<size_t>(number));
  }
  void answer(uint32_t with) { add(BPF_RET | BPF_K, with); }
  // `count` instructions are skipped when the word is `value`, or unless it is, has a bit of it,
  // or is larger.
  void if_equal_skip(uint32_t value, uint8_t count) {
    add(BPF_JMP | BPF_JEQ | BPF_K, value, count, 0);
  }
  void unless_equal_skip(uint32_t value, uint8_t count) {
    add(BPF_JMP | BPF_JEQ | BPF_K, value, 0, count);
  }
  void unless_bit_skip(uint32_t bits, uint8_t count) {
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 0, count);
  }
  void unless_larger_skip(uint32_t value, uint8_t count) {
    add(BPF_JMP | BPF_JGT | BPF_K, value, 0, count);
  }

  sock_fprog program() {
    return {static_cast<unsigned short>(code_.size()), code_.data()};
  }

 private:
  void add(uint16_t operation, uint32_t value, uint8_t if_true = 0, uint8_t if_false = 0) {
    code_.push_back({operation, if_true, if_false, value});
  }
  std::vector<sock_filter> code_;
};

// Executable memory that does not come from a file: libraries can still be loaded to look up names.
void refuse_new_code(Filter& filter) {
  filter.unless_equal_skip(__NR_mprotect, 4);
  filter.load_argument(2);
  filter.unless_bit_skip(PROT_EXEC, 1);
  filter.answer(refuse_with(EPERM));
  filter.load(offsetof(seccomp_data, nr));
  filter.unless_equal_skip(__NR_mmap, 6);
  filter.load_argument(2);
  filter.unless_bit_skip(PROT_EXEC, 3);
  filter.load_argument(3);
  filter.unless_bit_skip(MAP_ANONYMOUS, 1);
  filter.answer(refuse_with(EPERM));
  filter.load(offsetof(seccomp_data, nr));
}

// Threads, but no namespaces. The flags of the newer call cannot be looked at, so libraries are
// made to use the older one.
void refuse_namespaces(Filter& filter) {
  filter.unless_equal_skip(__NR_clone3, 1);
  filter.answer(refuse_with(ENOSYS));
  filter.unless_equal_skip(__NR_clone, 4);
  filter.load_argument(0);
  filter.unless_bit_skip(kNamespaces, 1);
  filter.answer(refuse_with(EPERM));
  filter.load(offsetof(seccomp_data, nr));
}

// Calls whose first argument is a process: the own one, which may also be called 0 where
// `zero_is_own`.
void refuse_others(Filter& filter, uint32_t call, bool zero_is_own) {
  filter.unless_equal_skip(call, zero_is_own ? 5 : 4);
  filter.load_argument(0);
  if (zero_is_own) filter.if_equal_skip(0, 2);
  filter.if_equal_skip(static_cast<uint32_t>(::getpid()), 1);
  filter.answer(refuse_with(EPERM));
  filter.load(offsetof(seccomp_data, nr));
}

Filter filter_of(ThreadKind kind) {
  Filter filter;
  filter.load(offsetof(seccomp_data, arch));
  filter.if_equal_skip(kArchitecture, 1);
  filter.answer(refuse_with(EPERM));
  filter.load(offsetof(seccomp_data, nr));
  refuse_namespaces(filter);
  refuse_others(filter, __NR_tgkill, false);
  refuse_others(filter, __NR_prlimit64, true);
  if (kind == ThreadKind::kDevice) refuse_new_code(filter);
  for (const Permit& permit : kPermits) {
    if (!permits(permit, kind)) continue;
    filter.unless_equal_skip(permit.call, 1);
    filter.answer(SECCOMP_RET_ALLOW);
  }
  filter.unless_larger_skip(kLastOld, 1);
  filter.answer(refuse_with(ENOSYS));
  filter.answer(refuse_with(EPERM));
  return filter;
}

}  // namespace

base::Status confine_thread(ThreadKind kind) {
  Filter filter = filter_of(kind);
  const sock_fprog program = filter.program();
  const bool done = kArchitecture != 0 && ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  if (done) return base::Ok{};
  return base::Error{base::Refusal::kNotPermitted,
                     std::string("system calls cannot be filtered: ") + std::strerror(errno) +
                         "; leave out --seccomp"};
}

}  // namespace vm
