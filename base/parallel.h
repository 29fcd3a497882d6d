// Work on several threads, for phases that do the same to every element of a table. What it makes
// goes into the place of its element, so that results and errors are the same, and in the same
// order, whatever the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>

namespace base {

inline constexpr uint32_t kMaxJobs = 256;

// Processors that this process may use; at least 1.
uint32_t usable_cores();

namespace parallel {
using Call = void (*)(const void* work, size_t index);
void run(size_t count, uint32_t jobs, size_t batch, Call call, const void* work);
}  // namespace parallel

// work(i) once for every i below `count`, in any order, on at most `jobs` threads of which the
// caller's is one; returns when all are done. Threads take `batch` neighbours at a time: fewer
// elements than two batches are the caller's alone. Where no thread can be had, the caller does
// everything. `work` must be callable from several threads at once.
template <class Work>
void for_each_index(size_t count, uint32_t jobs, size_t batch, const Work& work) {
  const parallel::Call call = [](const void* any, size_t index) {
    (*static_cast<const Work*>(any))(index);
  };
  parallel::run(count, jobs, batch, call, &work);
}

}  // namespace base
