// Shared memory with another process: whole images both ways, and what the other side can do wrong.
#include "vm/io/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "tests/unit/io/rig.h"
#include "vm/io/shared_memory_driver.h"
#include "vm/runtime/descriptor.h"

namespace vm {
namespace {

constexpr size_t kData = 65536;

uint64_t now_ns() {
  return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                               std::chrono::nanoseconds(1));
}

constexpr size_t kSize = sizeof(SharedHeader) + 2 * (sizeof(SharedBlock) + kData);

struct Sides {
  explicit Sides(const std::string& timeout_ms = "50", const std::string& access = "owner")
      : name("/stc_unit_" + std::to_string(::getpid())) {
    ir::Device device{"d",
                      "shared-memory",
                      {{"access", access}, {"name", name}, {"timeout_ms", timeout_ms}},
                      {io_test::to_program(4, 2, 0), io_test::to_device(8, 2, 0)},
                      {}};
    device.map.push_back({ir::PointTable::kBit, 3, 1, true, {ir::DirectArea::kOutput, 40, 1}});
    driver = std::move(*make_shared_memory_driver(device));
    points = points_of(device);
    outputs.resize(points.output_bytes);
    inputs.resize(points.input_bytes);
  }
  ~Sides() { remove(); }

  base::Status exchange() { return driver->exchange({points, outputs, inputs, 0}); }
  std::string error() {
    const base::Status done = exchange();
    return done.ok() ? "" : done.error().text;
  }
  void remove() const { ::shm_unlink(name.c_str()); }
  Descriptor object(int flags = O_RDWR) const {
    return Descriptor(::shm_open(name.c_str(), flags, 0600));
  }
  // As if the device were new: the other side's next write is taken.
  void recovers() {
    (void)exchange();  // notices what is wrong
    (void)exchange();  // begins anew
    open();
    const base::Bytes image(8, 9);
    shared_write(theirs_in, image.data(), image.size(), now_ns());
    EXPECT_EQ(error(), "");
    EXPECT_EQ(inputs, (base::Bytes{9, 9}));
  }
  // The other side's view.
  void open() {
    const int file = ::shm_open(name.c_str(), O_RDWR, 0);
    ASSERT_GE(file, 0);
    void* at = ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
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
  Sides sides("10000");
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
  const uint64_t long_ago = now_ns() - 11'000'000'000;
  shared_write(sides.theirs_in, image.data(), image.size(), long_ago);
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
}

// Who is interrupted in the middle of writing is no loss: the image before it is still young.
TEST(SharedMemory, AWriterThatIsInterruptedIsNoLossUntilItsLastImageIsOld) {
  Sides sides("60000");
  (void)sides.exchange();
  sides.open();
  const base::Bytes image(8, 9);
  shared_write(sides.theirs_in, image.data(), image.size(), now_ns());
  EXPECT_EQ(sides.error(), "");
  sides.theirs_in->sequence.fetch_add(1);
  sides.inputs = {0, 0};
  EXPECT_EQ(sides.error(), "");
  EXPECT_EQ(sides.inputs, (base::Bytes{9, 9}));
  shared_write(sides.theirs_in, image.data(), image.size(), now_ns() - 61'000'000'000);
  EXPECT_NE(sides.error().find("nobody writes the inputs"), std::string::npos);
}

// A time that is rubbish would make a process that is dead look alive for good.
TEST(SharedMemory, ATimeThatIsYetToComeIsALoss) {
  Sides sides;
  (void)sides.exchange();
  sides.open();
  const base::Bytes image(8, 9);
  shared_write(sides.theirs_in, image.data(), image.size(), UINT64_MAX);
  EXPECT_NE(sides.error().find("none of CLOCK_MONOTONIC"), std::string::npos);
}

// Readers see the sequence whole, also where it carries into its second byte.
TEST(SharedMemory, TheOutputsSequenceIsEvenAndGrowsByTwo) {
  Sides sides;
  (void)sides.exchange();
  sides.open();
  sides.theirs_out->sequence.store(0x1234'fff1);
  sides.driver->disconnect();
  for (uint64_t i = 1; i <= 300; ++i) {
    (void)sides.exchange();
    ASSERT_EQ(sides.theirs_out->sequence.load(), 0x1234'fff0 + 2 * i);
  }
}

TEST(SharedMemory, WhatBecameOfTheObjectIsSaidAndTheNextExchangeBeginsAnew) {
  Sides sides;
  const auto said = [&](const char* text) {
    EXPECT_NE(sides.error().find(text), std::string::npos) << text;
    sides.recovers();
  };
  (void)sides.exchange();
  ASSERT_EQ(::ftruncate(sides.object().get(), 100), 0);
  said("was made smaller");
  sides.remove();
  said("was removed or replaced");
  sides.remove();
  ASSERT_EQ(::ftruncate(sides.object(O_RDWR | O_CREAT).get(), kSize), 0);
  said("was removed or replaced");
  ASSERT_EQ(::pwrite(sides.object().get(), "rubbish", 7, 3), 7);
  said("its header was overwritten");
}

TEST(SharedMemory, WhoElseMayWriteItIsWhatTheMapSays) {
  const mode_t old = ::umask(077);
  for (const auto& [access, mode] :
       {std::pair{"owner", 0600u}, {"group", 0660u}, {"everyone", 0666u}}) {
    Sides sides("50", access);
    (void)sides.exchange();
    struct stat facts {};
    ASSERT_EQ(::fstat(sides.object().get(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 07777, mode) << access;
    ASSERT_EQ(::fchmod(sides.object().get(), 0662), 0);  // while it is exchanged, and before that
    for (int i = 0; i < 2; ++i) {
      const bool refused = sides.error().find("others can write it (mode 0662)") != std::string::npos;
      EXPECT_EQ(refused, mode != 0666) << access;
    }
  }
  ::umask(old);
}

TEST(SharedMemory, AnObjectOfAnotherUserIsNotTaken) {
  Sides sides;
  Descriptor theirs = sides.object(O_RDWR | O_CREAT);
  ASSERT_EQ(::ftruncate(theirs.get(), 5), 0);
  if (::fchown(theirs.get(), 65534, 0) != 0) GTEST_SKIP() << "only root can give one away";
  EXPECT_NE(sides.error().find("belongs to user 65534; remove /dev/shm/"), std::string::npos);
  struct stat facts {};
  ASSERT_EQ(::fstat(theirs.get(), &facts), 0);
  EXPECT_EQ(facts.st_size, 5);  // nor is it touched
  sides.remove();
  sides.recovers();
}

// A process that does that to the object again and again, until it is killed.
class Vandal {
 public:
  Vandal(const Sides& sides, void (*act)(const Sides&))
      : acts_(static_cast<std::atomic<int>*>(::mmap(nullptr, sizeof *acts_, PROT_READ | PROT_WRITE,
                                                    MAP_SHARED | MAP_ANONYMOUS, -1, 0))),
        pid_(::fork()) {
    if (pid_ == 0) ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives a test that fails
    for (; pid_ == 0; ++*acts_) act(sides);
  }
  ~Vandal() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::munmap(acts_, sizeof *acts_);
  }
  int acts() const { return *acts_; }

 private:
  std::atomic<int>* const acts_;
  const pid_t pid_;
};

void scribble(const Sides& sides, off_t at) {
  static uint64_t state = 1;
  state = state * 6364136223846793005u + 1442695040888963407u;
  (void)!::pwrite(sides.object().get(), &state, sizeof state, at);
}

// Whatever another process does, an exchange succeeds or fails; this process goes on.
TEST(SharedMemory, APeerThatDestroysTheObjectAllTheTimeIsALostDevice) {
  void (*const acts[])(const Sides&) = {
      [](const Sides& sides) { (void)!::ftruncate(sides.object().get(), 0); },
      [](const Sides& sides) { (void)!::ftruncate(sides.object().get(), kSize / 2); },
      [](const Sides& sides) { sides.remove(); },
      [](const Sides& sides) {
        sides.remove();
        (void)!::ftruncate(sides.object(O_RDWR | O_CREAT).get(), kSize);
      },
      [](const Sides& sides) { scribble(sides, 0); },
      [](const Sides& sides) { scribble(sides, sizeof(SharedHeader)); },
      [](const Sides& sides) { scribble(sides, sizeof(SharedHeader) + 16 + kData); },
      [](const Sides& sides) { (void)!::fchmod(sides.object().get(), 0666); },
  };
  for (const auto& act : acts) {
    Sides sides;
    {
      const Vandal vandal(sides, act);
      for (int i = 0; i < 3000 || vandal.acts() < 300; ++i) (void)sides.exchange();
    }
    sides.remove();
    sides.recovers();
  }
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
