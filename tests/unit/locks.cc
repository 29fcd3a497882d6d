#include "tests/unit/locks.h"

#ifdef STC_SANITIZED_HEAP

namespace tests {

uint64_t locks() { return 0; }

}  // namespace tests

#else

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>

namespace {

using Lock = int (*)(pthread_mutex_t*);

thread_local uint64_t counted = 0;
std::atomic<Lock> system_lock{nullptr};

}  // namespace

namespace tests {

uint64_t locks() { return counted; }

}  // namespace tests

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  ++counted;
  Lock lock = system_lock.load(std::memory_order_relaxed);
  if (lock == nullptr) {
    lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
    system_lock.store(lock, std::memory_order_relaxed);
  }
  return lock(mutex);
}

#endif
