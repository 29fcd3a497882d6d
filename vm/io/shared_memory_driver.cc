#include "vm/io/shared_memory_driver.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>

#include "vm/io/bit_copy.h"
#include "vm/io/shared_memory.h"
#include "vm/io/shared_object.h"

namespace vm {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr uint32_t kImageBytes = 65536;  // each way: all that a map can name
constexpr int kReadAttempts = 100;
constexpr size_t kSequence = 8;  // bytes; the time and the data follow it
constexpr size_t kTime = 8;
constexpr uint64_t kInputsAt = sizeof(SharedHeader);
constexpr uint64_t kOutputsAt = kInputsAt + sizeof(SharedBlock) + kImageBytes;
constexpr size_t kSize = kOutputsAt + sizeof(SharedBlock) + kImageBytes;
constexpr SharedHeader kHeader{kSharedMagic, sizeof(SharedHeader), kImageBytes, kImageBytes};

uint64_t now_ns() {
  return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                               std::chrono::nanoseconds(1));
}

// Keeps the writes of two calls in order for a process that has the object mapped.
void in_order() { std::atomic_thread_fence(std::memory_order_seq_cst); }

template <class T>
std::span<uint8_t> bytes_of(T& value) {
  return {reinterpret_cast<uint8_t*>(&value), sizeof value};
}

class SharedMemoryDriver : public IoDriver {
 public:
  SharedMemoryDriver(const std::string& name, mode_t mode, int64_t timeout_ns)
      : object_(name, kSize, mode), timeout_ns_(static_cast<uint64_t>(timeout_ns)) {}
  void disconnect() override { object_.close(); }

  // Whatever the other side did to the object, the next exchange begins with a good one.
  base::Status exchange(const Exchange& exchange) override {
    const bool reads = !exchange.points.inputs.empty() && !exchange.inputs.empty();
    base::Status done = object_.is_open() ? intact() : open();
    if (done.ok() && !exchange.outputs.empty()) done = write(exchange);
    if (done.ok() && reads) done = take_inputs();
    if (!done.ok()) object_.close();
    return done.ok() && reads ? read(exchange) : done;
  }

 private:
  // The object may be there already, from a controller before this one: what the others have opened
  // stays.
  base::Status open() {
    base::Status done = object_.open();
    if (done.ok()) done = object_.read(kOutputsAt, bytes_of(sequence_));
    sequence_ &= ~uint64_t{1};
    read_ns_ = 0;
    SharedHeader header = kHeader;
    const size_t magic = sizeof header.magic;
    if (done.ok()) done = object_.write(magic, bytes_of(header).subspan(magic));
    in_order();
    if (done.ok()) done = object_.write(0, bytes_of(header.magic));
    return done;
  }

  base::Status intact() {
    if (base::Status good = object_.check(); !good.ok()) return good;
    SharedHeader header{};
    if (base::Status got = object_.read(0, bytes_of(header)); !got.ok()) return got;
    if (std::memcmp(&header, &kHeader, sizeof header) == 0) return base::Ok{};
    return object_.failed("its header was overwritten");
  }

  static uint32_t first_bit(const PointRange& range) {
    return range.first * (range.table == ir::PointTable::kBit ? 1 : 8);
  }

  std::span<uint8_t> outputs() { return std::span(outputs_).subspan(kTime); }

  base::Status write(const Exchange& exchange) {
    for (const PointRange& range : exchange.points.outputs) {
      copy_bits(exchange.outputs, range.byte * 8, outputs(), first_bit(range), range.bits());
    }
    const uint64_t now = now_ns();
    std::memcpy(outputs_.data(), &now, sizeof now);
    base::Status done = show(sequence_ | 1);
    if (done.ok()) done = object_.write(kOutputsAt + kSequence, outputs_);
    if (done.ok()) done = show((sequence_ | 1) + 1);
    return done;
  }

  // A call may copy a number in parts, so its low byte goes alone: it says whether the number is
  // odd, and while it is, nobody uses the others.
  base::Status show(uint64_t sequence) {
    in_order();
    const bool carries = (sequence ^ sequence_) >> 8 != 0;
    sequence_ = sequence;
    const std::span<uint8_t> bytes = bytes_of(sequence_);
    base::Status done = base::Ok{};
    if (carries) done = object_.write(kOutputsAt + 1, bytes.subspan(1));
    in_order();
    if (done.ok()) done = object_.write(kOutputsAt, bytes.first(1));
    in_order();
    return done;
  }

  // The newest whole image, if one can be had: a writer that was interrupted is no loss until the
  // last whole image is too old.
  base::Status take_inputs() {
    whole_ = false;
    for (int i = 0; i < kReadAttempts && !whole_; ++i) {
      uint64_t before = 0;
      uint64_t after = 1;
      base::Status done = object_.read(kInputsAt, bytes_of(before));
      in_order();
      if (done.ok() && (before & 1) != 0) continue;
      if (done.ok()) done = object_.read(kInputsAt + kSequence, reading_);
      in_order();
      if (done.ok()) done = object_.read(kInputsAt, bytes_of(after));
      if (!done.ok()) return done;
      whole_ = before == after;
    }
    if (!whole_) return base::Ok{};
    std::swap(reading_, inputs_);
    std::memcpy(&read_ns_, inputs_.data(), sizeof read_ns_);
    return base::Ok{};
  }

  base::Status read(const Exchange& exchange) {
    const uint64_t now = now_ns();
    if (read_ns_ > now) return object_.failed("the inputs' time is none of CLOCK_MONOTONIC");
    if (read_ns_ == 0 || now - read_ns_ > timeout_ns_) {
      // A process that died in the middle of writing leaves it half done for good.
      return object_.failed(whole_ ? "nobody writes the inputs" : "the inputs are half written");
    }
    for (const PointRange& range : exchange.points.inputs) {
      copy_bits(std::span(inputs_).subspan(kTime), first_bit(range), exchange.inputs,
                range.byte * 8, range.bits());
    }
    return base::Ok{};
  }

  SharedObject object_;
  const uint64_t timeout_ns_;
  uint64_t sequence_ = 0;  // of the outputs' block, as shown last
  uint64_t read_ns_ = 0;   // when the inputs were written; 0: there are none
  bool whole_ = false;     // they are the newest
  // Each begins with its time.
  base::Bytes reading_ = base::Bytes(kTime + kImageBytes);
  base::Bytes inputs_ = base::Bytes(kTime + kImageBytes);
  base::Bytes outputs_ = base::Bytes(kTime + kImageBytes);
};

mode_t mode_of(const std::string& access) {
  if (access == "everyone") return 0666;
  return access == "group" ? 0660 : 0600;
}

}  // namespace

base::Result<std::unique_ptr<IoDriver>> make_shared_memory_driver(const ir::Device& device) {
  const std::string name = ir::setting(device, "name");
  const bool good = name.size() > 1 && name.size() < 255 && name[0] == '/' &&
                    name.find('/', 1) == std::string::npos;
  if (!good) {
    return base::Error{base::Refusal::kDeviceFailed,
                       "`" + name + "` is no name of shared memory: /press"};
  }
  return std::unique_ptr<IoDriver>(
      std::make_unique<SharedMemoryDriver>(name, mode_of(ir::setting(device, "access")),
                                           ir::number_setting(device, "timeout_ms") * 1'000'000));
}

}  // namespace vm
