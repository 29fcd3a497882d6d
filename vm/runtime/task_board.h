// What each task is doing, for any thread to read while the control thread goes on (B11). The
// control thread stores one number for each task; nobody waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "base/limits.h"
#include "vm/runtime/task_activity.h"

namespace vm {

class TaskBoard {
 public:
  // Control thread. `generation`: of the version whose task of that number it is.
  void show(size_t task, uint32_t generation, const TaskActivity& activity) {
    const uint64_t word = uint64_t{generation} << 32 | packed(activity);
    rows_[task].store(word, std::memory_order_relaxed);
  }
  // Any thread. nullopt: another version runs, or there is no such task.
  std::optional<TaskActivity> look(size_t task, uint32_t generation) const {
    if (task >= rows_.size()) return std::nullopt;
    const uint64_t word = rows_[task].load(std::memory_order_relaxed);
    if (word >> 32 != generation) return std::nullopt;
    return unpacked(static_cast<uint32_t>(word));
  }

 private:
  std::array<std::atomic<uint64_t>, base::kMaxTasks> rows_{};
};

}  // namespace vm
