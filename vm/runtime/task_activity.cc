#include "vm/runtime/task_activity.h"

#include <iterator>

namespace vm {
namespace {

constexpr uint32_t kBufferBits = 12;

uint32_t packed(const BufferState& buffer) {
  return static_cast<uint32_t>(buffer.kind) | uint32_t{buffer.writer} << 4 |
         uint32_t{buffer.waiting} << 6 | uint32_t{buffer.reader} << 8 |
         uint32_t{buffer.fresh} << 10 | uint32_t{buffer.locked} << 11;
}

// What this program does not know becomes the first one.
template <class E>
E enumerator(uint32_t number, E last) {
  return number <= static_cast<uint32_t>(last) ? static_cast<E>(number) : E{};
}

BufferState unpacked_buffer(uint32_t bits) {
  BufferState out;
  out.kind = enumerator(bits & 15, ir::IoBuffer::kFirstUnseen);
  out.writer = bits >> 4 & 3;
  out.waiting = bits >> 6 & 3;
  out.reader = bits >> 8 & 3;
  out.fresh = (bits >> 10 & 1) != 0;
  out.locked = (bits >> 11 & 1) != 0;
  return out;
}

constexpr const char* kStates[] = {"waiting",   "due",        "running",
                                   "suspended", "ended late", "stopped"};
static_assert(std::size(kStates) == kTaskStateCount);

}  // namespace

const char* state_text(TaskState state) {
  const auto number = static_cast<uint32_t>(state);
  return number < kTaskStateCount ? kStates[number] : "unknown";
}

uint32_t packed(const TaskActivity& activity) {
  return packed(activity.inputs) | packed(activity.outputs) << kBufferBits |
         static_cast<uint32_t>(activity.state) << 2 * kBufferBits |
         uint32_t{activity.late} << (2 * kBufferBits + 3);
}

TaskActivity unpacked(uint32_t bits) {
  TaskActivity out;
  out.inputs = unpacked_buffer(bits);
  out.outputs = unpacked_buffer(bits >> kBufferBits);
  out.state = enumerator(bits >> 2 * kBufferBits & 7, TaskState::kStopped);
  out.late = (bits >> (2 * kBufferBits + 3) & 1) != 0;
  return out;
}

}  // namespace vm
