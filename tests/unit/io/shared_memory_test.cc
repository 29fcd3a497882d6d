// Shared memory with another process: whole images both ways, and what the other side can do wrong.
#include "vm/io/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>

#include "tests/unit/io/rig.h"
#include "vm/io/shared_memory_driver.h"

namespace vm {
namespace {

constexpr size_t kData = 65536;

uint64_t now_ns() {
  return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                               std::chrono::nanoseconds(1));
}

struct Sides {
  Sides() : name("/stc_unit_" + std::to_string(::getpid())) {
    ir::Device device{"d",
                      "shared-memory",
                      {{"name", name}, {"timeout_ms", "50"}},
                      {io_test::to_program(4, 2, 0), io_test::to_device(8, 2, 0)},
                      {}};
    device.map.push_back({ir::PointTable::kBit, 3, 1, true, {ir::DirectArea::kOutput, 40, 1}});
    driver = std::move(*make_shared_memory_driver(device));
    points = points_of(device);
    outputs.resize(points.output_bytes);
    inputs.resize(points.input_bytes);
  }
  ~Sides() { ::shm_unlink(name.c_str()); }

  base::Status exchange() { return driver->exchange({points, outputs, inputs, 0}); }
  // The other side's view.
  void open() {
    const int file = ::shm_open(name.c_str(), O_RDWR, 0);
    ASSERT_GE(file, 0);
    const size_t size = sizeof(SharedHeader) + 2 * shared_block_size(kData);
    void* at = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::close(file);
    ASSERT_NE(at, MAP_FAILED);
    const auto* header = static_cast<SharedHeader*>(at);
    ASSERT_EQ(header->magic, kSharedMagic);
    auto* bytes = static_cast<uint8_t*>(at);
    theirs_in = reinterpret_cast<SharedBlock*>(bytes + header->header_bytes);
    theirs_out = reinterpret_cast<SharedBlock*>(bytes + header->header_bytes +
                                                shared_block_size(header->input_bytes));
  }

  std::string name;
  std::unique_ptr<IoDriver> driver;
  DevicePoints points;
  base::Bytes outputs;
  base::Bytes inputs;
  SharedBlock* theirs_in = nullptr;
  SharedBlock* theirs_out = nullptr;
};

TEST(SharedMemory, ImagesGoBothWaysWhole) {
  Sides sides;
  sides.outputs = {7, 8, 1};
  EXPECT_FALSE(sides.exchange().ok());  // nobody has written inputs yet
  sides.open();
  base::Bytes seen(16);
  uint64_t written = 0;
  ASSERT_TRUE(shared_read(sides.theirs_out, seen.data(), seen.size(), written));
  EXPECT_NE(written, 0u);
  EXPECT_EQ(seen[8], 7);
  EXPECT_EQ(seen[9], 8);
  EXPECT_EQ(seen[0], 8);  // bit 3
  const base::Bytes image{0, 0, 0, 0, 21, 22};
  shared_write(sides.theirs_in, image.data(), image.size(), now_ns());
  ASSERT_TRUE(sides.exchange().ok());
  EXPECT_EQ(sides.inputs, (base::Bytes{21, 22}));
  std::this_thread::sleep_for(std::chrono::milliseconds(80));
  const base::Status old = sides.exchange();
  ASSERT_FALSE(old.ok());
  EXPECT_NE(old.error().text.find("nobody writes the inputs"), std::string::npos);
}

TEST(SharedMemory, AWriterThatDiedInTheMiddleIsAnErrorUntilTheNextOne) {
  Sides sides;
  (void)sides.exchange();
  sides.open();
  sides.theirs_in->sequence.store(7);
  const base::Status half = sides.exchange();
  ASSERT_FALSE(half.ok());
  EXPECT_NE(half.error().text.find("half written"), std::string::npos);
  const base::Bytes image(8, 9);
  shared_write(sides.theirs_in, image.data(), image.size(), now_ns());
  ASSERT_TRUE(sides.exchange().ok());
  EXPECT_EQ(sides.inputs, (base::Bytes{9, 9}));
  shared_write(sides.theirs_in, image.data(), image.size(), UINT64_MAX);  // from the future
  EXPECT_TRUE(sides.exchange().ok());
}

TEST(SharedMemory, B8_NoTornImageUnderLoad) {
  Sides sides;
  (void)sides.exchange();
  sides.open();
  std::atomic<bool> ending{false};
  std::thread other([&] {
    for (uint8_t value = 0; !ending; ++value) {
      const base::Bytes image(6, value);
      shared_write(sides.theirs_in, image.data(), image.size(), now_ns());
    }
  });
  int taken = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (!sides.exchange().ok()) continue;
    ++taken;
    ASSERT_EQ(sides.inputs[0], sides.inputs[1]);
  }
  ending = true;
  other.join();
  EXPECT_GT(taken, 0);
}

TEST(SharedMemory, NamesThatAreNoneAreRefused) {
  for (const char* name : {"press", "/", "/a/b", ""}) {
    const ir::Device device{"d", "shared-memory", {{"name", name}}, {}, {}};
    EXPECT_EQ(make_shared_memory_driver(device).error().refusal, base::Refusal::kDeviceFailed);
  }
}

}  // namespace
}  // namespace vm
