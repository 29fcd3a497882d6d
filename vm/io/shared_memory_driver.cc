#include "vm/io/shared_memory_driver.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "vm/io/bit_copy.h"
#include "vm/io/shared_memory.h"
#include "vm/runtime/descriptor.h"

namespace vm {
namespace {

constexpr uint32_t kBytes = 65536;  // each way: all that a map can name
constexpr int kReadAttempts = 100;

uint64_t now_ns() {
  return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                               std::chrono::nanoseconds(1));
}

constexpr size_t kSize = sizeof(SharedHeader) + 2 * (sizeof(SharedBlock) + kBytes);

class SharedMemoryDriver : public IoDriver {
 public:
  SharedMemoryDriver(std::string name, int64_t timeout_ns)
      : name_(std::move(name)), timeout_ns_(static_cast<uint64_t>(timeout_ns)) {}
  ~SharedMemoryDriver() override { close(); }
  void disconnect() override { close(); }

  base::Status exchange(const Exchange& exchange) override {
    base::Status ready = open();
    if (!ready.ok()) return ready;
    if (!exchange.outputs.empty()) write(exchange);
    return exchange.points.inputs.empty() || exchange.inputs.empty() ? base::Status(base::Ok{})
                                                                     : read(exchange);
  }

 private:
  base::Status failed(const char* what) const {
    return exchange_failed("shared memory " + name_ + ": " + what + ": " + std::strerror(errno));
  }

  // It may be there already, from a controller before this one: what the others have opened stays.
  base::Status open() {
    if (memory_ != nullptr) return base::Ok{};
    const Descriptor file(::shm_open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    if (!file.valid()) return failed("open");
    struct stat facts {};
    if (::fstat(file.get(), &facts) != 0) return failed("look at");
    if (facts.st_size < static_cast<off_t>(kSize) && ::ftruncate(file.get(), kSize) != 0) {
      return failed("make room");
    }
    void* at = ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
    if (at == MAP_FAILED) return failed("map");
    memory_ = static_cast<uint8_t*>(at);
    auto* header = reinterpret_cast<SharedHeader*>(memory_);
    header->header_bytes = sizeof(SharedHeader);
    header->input_bytes = header->output_bytes = kBytes;
    std::atomic_ref<uint32_t>(header->magic).store(kSharedMagic, std::memory_order_release);
    return base::Ok{};
  }

  void close() {
    if (memory_ != nullptr) ::munmap(memory_, kSize);
    memory_ = nullptr;
  }

  SharedBlock* block(bool inputs) const {
    uint8_t* const first = memory_ + sizeof(SharedHeader);
    return reinterpret_cast<SharedBlock*>(inputs ? first : first + shared_block_size(kBytes));
  }

  static uint32_t first_bit(const PointRange& range) {
    return range.first * (range.table == ir::PointTable::kBit ? 1 : 8);
  }

  void write(const Exchange& exchange) {
    for (const PointRange& range : exchange.points.outputs) {
      copy_bits(exchange.outputs, range.byte * 8, outputs_, first_bit(range), range.bits());
    }
    shared_write(block(false), outputs_.data(), outputs_.size(), now_ns());
  }

  base::Status read(const Exchange& exchange) {
    uint64_t written_ns = 0;
    bool whole = false;
    for (int i = 0; i < kReadAttempts && !whole; ++i) {
      whole = shared_read(block(true), inputs_.data(), inputs_.size(), written_ns);
    }
    // A process that died in the middle of writing leaves it half done for good.
    if (!whole) return exchange_failed("shared memory " + name_ + ": the inputs are half written");
    const uint64_t now = now_ns();
    if (written_ns == 0 || now - std::min(now, written_ns) > timeout_ns_) {
      return exchange_failed("shared memory " + name_ + ": nobody writes the inputs");
    }
    for (const PointRange& range : exchange.points.inputs) {
      copy_bits(inputs_, first_bit(range), exchange.inputs, range.byte * 8, range.bits());
    }
    return base::Ok{};
  }

  const std::string name_;
  const uint64_t timeout_ns_;
  uint8_t* memory_ = nullptr;
  base::Bytes inputs_ = base::Bytes(kBytes);
  base::Bytes outputs_ = base::Bytes(kBytes);
};

}  // namespace

base::Result<std::unique_ptr<IoDriver>> make_shared_memory_driver(const ir::Device& device) {
  const std::string name = ir::setting(device, "name");
  const bool good = name.size() > 1 && name.size() < 255 && name[0] == '/' &&
                    name.find('/', 1) == std::string::npos;
  if (!good) {
    return base::Error{base::Refusal::kDeviceFailed,
                       "`" + name + "` is no name of shared memory: /press"};
  }
  return std::unique_ptr<IoDriver>(std::make_unique<SharedMemoryDriver>(
      name, ir::number_setting(device, "timeout_ms") * 1'000'000));
}

}  // namespace vm
