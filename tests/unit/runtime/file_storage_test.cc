// Files of a directory as durable storage: allocated when they are opened, never longer or elsewhere.
#include "vm/runtime/file_storage.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

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

// Files of at most `bytes` from here on: growing beyond fails as on a full disk.
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
  EXPECT_EQ(storage.size("slot_a").error().refusal, base::Refusal::kFileNotFound);
  EXPECT_EQ(storage.read("slot_a", 0, 1).error().refusal, base::Refusal::kFileNotFound);
  ASSERT_TRUE(storage.open("slot_a", 4096).ok());
  EXPECT_EQ(*storage.size("slot_a"), 4096u);
  EXPECT_EQ(*storage.read("slot_a", 0, 10), base::Bytes(10, 0));
  ASSERT_TRUE(storage.write("slot_a", 4090, base::Bytes(6, 7)).ok());
  ASSERT_TRUE(storage.sync("slot_a").ok());
  EXPECT_EQ(*storage.read("slot_a", 4088, 100), (base::Bytes{0, 0, 7, 7, 7, 7, 7, 7}));
  EXPECT_EQ(*storage.read("slot_a", 5000, 1), base::Bytes());
  FileStorage other(directory_);  // without open(): to look at
  EXPECT_EQ(*other.read("slot_a", 4090, 2), base::Bytes(2, 7));
  EXPECT_FALSE(other.write("slot_a", 0, base::Bytes{1}).ok());
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileStorageTest, GrowsAndKeepsWhatItHolds) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 100).ok());
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{1, 2, 3}).ok());
  ASSERT_TRUE(storage.open("a", 100'000).ok());
  EXPECT_EQ(*storage.read("a", 0, 4), (base::Bytes{1, 2, 3, 0}));
  ASSERT_TRUE(storage.open("a", 5).ok());
  EXPECT_EQ(*storage.size("a"), 100'000u);
}

TEST_F(FileStorageTest, NothingIsWrittenBehindTheEnd) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 100).ok());
  EXPECT_FALSE(storage.write("a", 95, base::Bytes(6, 1)).ok());
  EXPECT_FALSE(storage.write("a", ~uint64_t{0}, base::Bytes(6, 1)).ok());
  EXPECT_FALSE(storage.write("b", 0, base::Bytes(6, 1)).ok());
  EXPECT_EQ(std::filesystem::file_size(directory_ + "/a"), 100u);
}

TEST_F(FileStorageTest, AFullDiskIsFoundWhenTheFileIsOpened) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 500).ok());
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{9}).ok());
  FileSizeLimit limit(1000);
  EXPECT_EQ(storage.open("b", 5000).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(storage.open("a", 5000).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(*storage.read("a", 0, 1), base::Bytes{9}) << "what is there stays";
  EXPECT_TRUE(storage.write("a", 499, base::Bytes{9}).ok());
  EXPECT_EQ(files(), 1u) << "a file without content is left";
}

TEST_F(FileStorageTest, MissingDirectoryIsAnError) {
  FileStorage storage(directory_ + "/nowhere");
  EXPECT_EQ(storage.open("boot", 1).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(storage.read("boot", 0, 1).error().refusal, base::Refusal::kFileNotFound);
}

TEST_F(FileStorageTest, NoFileOutsideTheDirectory) {
  FileStorage storage(directory_);
  for (const char* name : {"", "../boot", "a/b", "A", "boot.tmp", "/etc/passwd"}) {
    EXPECT_FALSE(storage.open(name, 1).ok()) << name;
    EXPECT_FALSE(storage.read(name, 0, 1).ok()) << name;
    EXPECT_FALSE(storage.size(name).ok()) << name;
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(FileStorageTest, WhatIsNoFileIsNeitherReadNorWritten) {
  FileStorage storage(directory_);
  std::filesystem::create_directory(directory_ + "/folder");
  ASSERT_EQ(::mkfifo((directory_ + "/pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/etc/passwd", directory_ + "/link");
  for (const char* name : {"folder", "pipe", "link"}) {
    EXPECT_FALSE(storage.open(name, 10).ok()) << name;
    EXPECT_EQ(storage.read(name, 0, 1).error().refusal, base::Refusal::kFileUnreadable) << name;
  }
}

}  // namespace
}  // namespace vm
