#include "vm/runtime/live_copy.h"

#include <algorithm>
#include <cstring>

#include "vm/runtime/summaries.h"

namespace vm {
namespace {

constexpr uint32_t kLine = ir::kLineBytes;

uint64_t first_line(const ir::DataRange& range) { return range.data / kLine; }
uint64_t end_line(const ir::DataRange& range) {
  return (uint64_t{range.data} + range.size + kLine - 1) / kLine;
}

// Sorted ones that touch the same line, or neighbours, become one.
void merge(std::vector<ir::DataRange>& ranges) {
  std::vector<ir::DataRange> out;
  for (const ir::DataRange& next : ranges) {
    if (out.empty() || first_line(next) > end_line(out.back())) {
      out.push_back(next);
      continue;
    }
    ir::DataRange& last = out.back();
    last.size = std::max(last.size, next.data + next.size - last.data);
  }
  ranges = std::move(out);
}

}  // namespace

uint64_t line_bytes(std::vector<ir::DataRange>& ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const auto& a, const auto& b) { return a.data < b.data; });
  uint64_t lines = 0;
  uint64_t counted = 0;  // lines before this one
  for (const ir::DataRange& range : ranges) {
    const uint64_t first = std::max(first_line(range), counted);
    const uint64_t end = end_line(range);
    if (end > first) lines += end - first;
    counted = std::max(counted, end);
  }
  return lines * kLine;
}

uint64_t BoundaryShare::bytes(const Controller& controller, int64_t free_ns, uint64_t left,
                              bool whole) {
  const bool hurry = waited_ >= kPatience || controller.faulted();
  uint64_t room = free_ns <= 0 ? 0 : static_cast<uint64_t>(free_ns) * kCopyBytesPerNs;
  if (waited_ != 0 && controller.cycles() != cycle_) room = std::max(room, kLeastBytes);
  room = hurry ? kMaxBoundaryBytes : std::min<uint64_t>(room, kMaxBoundaryBytes);
  if (room < std::min(left, kLeastBytes) || (whole && room < left)) {
    if (waited_++ == 0) cycle_ = controller.cycles();
    return 0;
  }
  waited_ = 0;
  cycle_ = controller.cycles();
  return std::min(room, left);
}

base::Result<LiveCopy> LiveCopy::prepare(const Controller& controller,
                                         std::vector<ir::DataRange> ranges) {
  base::Result<Memory> memory = Memory::reserve();
  if (!memory.ok()) return memory.error();
  LiveCopy out(std::move(*memory));
  out.generation_ = controller.generation().number();
  out.ranges_ = std::move(ranges);
  out.left_ = line_bytes(out.ranges_);
  out.whole_ = out.left_ <= kMaxBoundaryBytes;
  merge(out.ranges_);
  // The pages of the copy are there before the boundary.
  for (const ir::DataRange& range : out.ranges_) {
    std::memset(out.memory_.data() + range.data, 0, range.size);
  }
  return out;
}

Copied LiveCopy::take(Controller& controller, int64_t free_ns) {
  if (controller.generation().number() != generation_) return Copied::kOtherProgram;
  const uint64_t room = share_.bytes(controller, free_ns, whole_ ? left_ : UINT64_MAX, whole_);
  if (room == 0 && !ranges_.empty()) return Copied::kLater;
  last_cycle_ = controller.cycles();
  if (!begun_) first_cycle_ = last_cycle_;
  begun_ = true;
  const uint64_t done = copy(controller.memory().data(), whole_ ? UINT64_MAX : room);
  controller.worked(static_cast<int64_t>(whole_ ? left_ : done) / kCopyBytesPerNs);
  return range_ == ranges_.size() ? Copied::kAll : Copied::kPart;
}

// Copies at most `room` bytes. Each range is charged one line more than its size, for the line
// that an unaligned range touches. A portion ends at a line, so that no elementary value is of two
// boundaries.
uint64_t LiveCopy::copy(const uint8_t* from, uint64_t room) {
  uint64_t done = 0;
  while (range_ < ranges_.size() && done + 2 * kLine <= room) {
    const ir::DataRange& range = ranges_[range_];
    const uint32_t left = range.size - offset_;
    auto size = static_cast<uint32_t>(std::min<uint64_t>(left, room - done - kLine));
    if (size < left) size -= (range.data + offset_ + size) % kLine;
    std::memcpy(memory_.data() + range.data + offset_, from + range.data + offset_, size);
    done += size + kLine;
    offset_ += size;
    if (offset_ != range.size) break;
    offset_ = 0;
    ++range_;
  }
  return done;
}

TaskStatus status_of(const TaskSample& sample) {
  TaskStatus status = sample.status;
  status.run = summary_of(sample.run);
  status.delay = summary_of(sample.delay);
  return status;
}

TaskTimes times_of(const TaskSample& sample) {
  return {sample.status.name, classes_of(sample.run), classes_of(sample.delay)};
}

TaskCopy::TaskCopy(const Controller& controller, std::string_view name)
    : generation_(controller.generation().number()) {
  const std::vector<ir::ImageTask>& tasks = controller.image().tasks;
  for (size_t i = 0; i < tasks.size(); ++i) {
    if (!name.empty() && !ir::same_name(tasks[i].name, name)) continue;
    if (samples_.empty()) first_ = i;
    samples_.emplace_back().status.name = tasks[i].name;
    if (!name.empty()) return;
  }
}

Copied TaskCopy::take(Controller& controller, int64_t free_ns) {
  if (controller.generation().number() != generation_) return Copied::kOtherProgram;
  const uint64_t left = (samples_.size() - taken_) * sizeof(TaskSample);
  const uint64_t room = share_.bytes(controller, free_ns, left, false);
  if (room == 0) return left == 0 ? Copied::kAll : Copied::kLater;
  static_assert(sizeof(TaskSample) <= kLeastBytes);
  const uint64_t count = room / sizeof(TaskSample);
  for (uint64_t i = 0; i < count; ++i, ++taken_) {
    controller.copy_task(first_ + taken_, samples_[taken_]);
  }
  controller.worked(static_cast<int64_t>(count * sizeof(TaskSample)) / kCopyBytesPerNs);
  return taken_ == samples_.size() ? Copied::kAll : Copied::kPart;
}

}  // namespace vm
