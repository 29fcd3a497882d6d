// Records: all or nothing, whatever fails.
#include "vm/runtime/file_storage.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace vm {
namespace {

class FileStorageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string path = ::testing::TempDir() + "storage-XXXXXX";
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    directory_ = path;
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }
  size_t files() const {
    auto begin = std::filesystem::directory_iterator(directory_);
    return static_cast<size_t>(std::distance(begin, std::filesystem::directory_iterator{}));
  }
  std::string directory_;
};

// Files of at most `bytes` from here on: writing beyond fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limited = before_;
    limited.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(FileStorageTest, ReadsBackWhatWasWritten) {
  FileStorage storage(directory_);
  EXPECT_FALSE(storage.exists("boot"));
  EXPECT_EQ(storage.read("boot").error().refusal, base::Refusal::kFileNotFound);
  ASSERT_TRUE(storage.write("boot", base::Bytes(100'000, 7)).ok());
  ASSERT_TRUE(storage.write("boot", base::Bytes{1, 2, 3}).ok());
  EXPECT_EQ(*storage.read("boot"), (base::Bytes{1, 2, 3}));
  EXPECT_TRUE(storage.exists("boot"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileStorageTest, FullDiskLeavesTheOldRecord) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.write("boot", base::Bytes{1, 2, 3}).ok());
  {
    FileSizeLimit limit(1000);
    base::Status status = storage.write("boot", base::Bytes(5000, 9));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().refusal, base::Refusal::kFileUnwritable);
  }
  EXPECT_EQ(*storage.read("boot"), (base::Bytes{1, 2, 3}));
  EXPECT_EQ(files(), 1u) << "a half-written file is left";
}

TEST_F(FileStorageTest, MissingDirectoryIsAnError) {
  FileStorage storage(directory_ + "/nowhere");
  EXPECT_EQ(storage.write("boot", base::Bytes{1}).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(storage.read("boot").error().refusal, base::Refusal::kFileNotFound);
}

TEST_F(FileStorageTest, NoRecordOutsideTheDirectory) {
  FileStorage storage(directory_);
  for (const char* name : {"", "../boot", "a/b", "A", "boot.tmp", "/etc/passwd"}) {
    EXPECT_FALSE(storage.write(name, base::Bytes{1}).ok()) << name;
    EXPECT_FALSE(storage.read(name).ok()) << name;
    EXPECT_FALSE(storage.exists(name)) << name;
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(FileStorageTest, WhatIsNoFileOrTooLongIsNotRead) {
  FileStorage storage(directory_, 10);
  std::filesystem::create_directory(directory_ + "/boot");
  EXPECT_EQ(storage.read("boot").error().refusal, base::Refusal::kFileUnreadable);
  EXPECT_FALSE(storage.write("boot", base::Bytes{1}).ok());
  ASSERT_TRUE(storage.write("big", base::Bytes(11, 0)).ok());
  EXPECT_EQ(storage.read("big").error().refusal, base::Refusal::kFileUnreadable);
}

}  // namespace
}  // namespace vm
