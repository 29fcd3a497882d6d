// X5, cases 54 and 57 with whole controllers: the power fails, or the process is killed, at every
// call to storage; what boots then is one of the programs that may, with retained values that were
// durable.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <random>

#include "tests/unit/sanitized.h"
#include "tests/unit/store/lives.h"
#include "tests/unit/store/sim_storage.h"
#include "vm/runtime/file_storage.h"

namespace plc {
namespace {

TEST(Service, X5_case54_PowerFailsAtEveryCallToStorage) {
  const std::vector<Step> steps = life();
  sim::SimStorage disk;
  size_t at = 0;
  uint64_t tried = 0;
  uint64_t failed = 0;
  std::mt19937 random(1);
  auto look = [&](sim::SimStorage left) {
    ++tried;
    const std::string wrong = found(left, steps[at]);
    if (!wrong.empty() && ++failed < 5) ADD_FAILURE() << "in step " << at << ": " << wrong;
  };
  disk.before_call = [&] {
    sim::SimStorage::Choice choice(disk.dirty().size(), 0);
    look(disk.after_cut(choice));
    if (disk.dirty().empty()) return;
    look(disk.after_kill());
    for (int i = 0; i < 2; ++i) {
      for (uint8_t& one : choice) one = random() % 2;
      look(disk.after_cut(choice,
                          {random() % choice.size(), static_cast<uint32_t>(random() % 512)}));
    }
  };
  std::unique_ptr<Plc> plc;
  for (; at < steps.size(); ++at) ASSERT_TRUE(steps[at].run(plc, disk)) << "step " << at;
  std::printf("%llu tried, %llu failed\n", static_cast<unsigned long long>(tried),
              static_cast<unsigned long long>(failed));
  EXPECT_GT(tried, 450u);
}

// --- real files, a real process -----------------------------------------------------

// Ends the process at call `at`; a write may be done half before.
class Deadly : public vm::Storage {
 public:
  Deadly(const std::string& directory, uint64_t at) : files_(directory), at_(at) {}
  base::Status open(std::string_view name, uint64_t size) override {
    end_if_now();
    return files_.open(name, size);
  }
  base::Result<uint64_t> size(std::string_view name) override { return files_.size(name); }
  base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) override {
    end_if_now();
    return files_.read(name, offset, size);
  }
  base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) override {
    end_if_now();
    if (calls_ + 1 == at_) (void)files_.write(name, offset, bytes.first(bytes.size() / 2)).ok();
    end_if_now();
    return files_.write(name, offset, bytes);
  }
  base::Status sync(std::string_view name) override {
    end_if_now();
    return files_.sync(name);
  }
  base::Status replace(std::string_view name, uint64_t size,
                       std::span<const Piece> pieces) override {
    end_if_now();
    return files_.replace(name, size, pieces);
  }
  base::Status check(std::string_view name) override { return files_.check(name); }

 private:
  void end_if_now() {
    if (++calls_ == at_) ::_exit(9);
  }
  vm::FileStorage files_;
  uint64_t at_;
  uint64_t calls_ = 0;
};

class Killed : public ::testing::Test {
 protected:
  void SetUp() override {
    // In memory where that is possible: nothing here depends on the disk.
    const bool memory = ::access("/dev/shm", W_OK) == 0;
    std::string path = (memory ? "/dev/shm/" : ::testing::TempDir()) + "killed-XXXXXX";
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    directory_ = path;
    void* shared =
        ::mmap(nullptr, sizeof *at_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    at_ = static_cast<volatile size_t*>(shared);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  // 9: killed at that call; 0: it lived to the end.
  int live_until(uint64_t call, const std::vector<Step>& steps) {
    *at_ = 0;
    const pid_t child = ::fork();
    if (child == 0) {
      Deadly storage(directory_, call);
      std::unique_ptr<Plc> plc;
      for (size_t i = 0; i < steps.size(); ++i) {
        *at_ = i;
        if (!steps[i].run(plc, storage)) ::_exit(1);
      }
      ::_exit(0);
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
    return WEXITSTATUS(status);
  }

  std::string directory_;
  volatile size_t* at_ = nullptr;
};

TEST_F(Killed, X5_case54_AtEveryCallToStorage) {
  const std::vector<Step> steps = life();
  for (int version = 1; version <= 4; ++version) (void)build(source(version));  // not in each child
  uint64_t call = 1;
  for (;; call += kOneOf) {
    const int end = live_until(call, steps);
    if (end == 0) break;
    ASSERT_EQ(end, 9) << "at call " << call << " in step " << *at_;
    vm::FileStorage storage(directory_);
    EXPECT_EQ(found(storage, steps[*at_]), "") << "at call " << call << " in step " << *at_;
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directory(directory_);
  }
  std::printf("%llu calls\n", static_cast<unsigned long long>(call));
  EXPECT_GT(call, 200u);
}

}  // namespace
}  // namespace plc
