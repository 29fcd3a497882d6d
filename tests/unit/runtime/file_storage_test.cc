// Files of a directory as durable storage: allocated when they are opened, never longer or elsewhere.
#include "vm/runtime/file_storage.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

// What the storage has asked the disk to make durable, by inode; in this program these functions
// take the place of the C library's.
std::vector<ino_t> synced;
bool disk_fails = false;

int count_sync(long number, int fd) {
  struct stat info {};
  if (::fstat(fd, &info) == 0) synced.push_back(info.st_ino);
  if (disk_fails) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(::syscall(number, fd));
}

}  // namespace

extern "C" int fsync(int fd) { return count_sync(SYS_fsync, fd); }
extern "C" int fdatasync(int fd) { return count_sync(SYS_fdatasync, fd); }

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

// --- files that are replaced --------------------------------------------------------

TEST_F(FileStorageTest, ANewFileTakesThePlaceOfTheOldOne) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  ASSERT_TRUE(storage.write("a", 0, base::Bytes(10, 1)).ok());
  const base::Bytes first{7, 8};
  const base::Bytes second{9};
  const Storage::Piece pieces[] = {{1, first}, {5, second}};
  ASSERT_TRUE(storage.replace("a", 8, pieces).ok());
  const base::Bytes expected{0, 7, 8, 0, 0, 9, 0, 0};
  EXPECT_EQ(*storage.read("a", 0, 100), expected);
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{5}).ok());
  ASSERT_TRUE(storage.sync("a").ok());
  FileStorage other(directory_);
  EXPECT_EQ(other.read("a", 0, 100)->front(), 5);
  EXPECT_EQ(files(), 1u);
  ASSERT_TRUE(storage.replace("b", 4, {}).ok()) << "it need not be there before";
  EXPECT_EQ(*storage.size("b"), 4u);
}

TEST_F(FileStorageTest, WhereNoNewFileCanBeMadeTheOldOneStays) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 500).ok());
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{9}).ok());
  FileSizeLimit limit(1000);
  EXPECT_EQ(storage.replace("a", 5000, {}).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(*storage.read("a", 0, 1), base::Bytes{9});
  EXPECT_TRUE(storage.check("a").ok());
  EXPECT_EQ(files(), 1u) << "half a file is left";
}

TEST_F(FileStorageTest, WhatAKilledProcessLeftOfANewFileIsRemoved) {
  std::ofstream(directory_ + "/a_new") << "half";
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  EXPECT_EQ(files(), 1u);
  std::ofstream(directory_ + "/a_new") << "half of another";
  ASSERT_TRUE(storage.replace("a", 3, {}).ok());
  EXPECT_EQ(*storage.read("a", 0, 10), base::Bytes(3, 0));
}

TEST_F(FileStorageTest, case56_AFolderThatCannotBeReachedIsNotOneWithoutFiles) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  std::filesystem::rename(directory_, directory_ + "_moved");
  std::ofstream(directory_) << "a file";
  EXPECT_EQ(storage.check("a").error().refusal, base::Refusal::kFileUnreadable);
  std::filesystem::remove(directory_);
  std::filesystem::rename(directory_ + "_moved", directory_);
  EXPECT_TRUE(storage.check("a").ok());
}

// A folder that is gone, a file that is removed or exchanged: nothing is durable there.
TEST_F(FileStorageTest, WhatNobodyCanFindIsNotDurable) {
  FileStorage storage(directory_);
  for (const char* name : {"a", "b", "c"}) {
    ASSERT_TRUE(storage.open(name, 10).ok());
    ASSERT_TRUE(storage.check(name).ok());
  }
  std::filesystem::remove(directory_ + "/a");
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{1}).ok());
  const base::Status removed = storage.sync("a");
  ASSERT_FALSE(removed.ok());
  EXPECT_NE(removed.error().text.find("the file was removed"), std::string::npos);
  std::filesystem::copy(directory_ + "/b", directory_ + "/d");
  std::filesystem::rename(directory_ + "/d", directory_ + "/b");
  EXPECT_NE(storage.sync("b").error().text.find("another file"), std::string::npos);
  EXPECT_EQ(storage.check("a").error().refusal, base::Refusal::kFileNotFound);
  EXPECT_EQ(storage.check("b").error().refusal, base::Refusal::kFileNotFound);
  EXPECT_FALSE(storage.check("b").ok());
  EXPECT_TRUE(storage.sync("c").ok());
  ASSERT_TRUE(storage.replace("a", 10, {}).ok());
  EXPECT_TRUE(storage.sync("a").ok());
  std::filesystem::remove_all(directory_);
  EXPECT_FALSE(storage.sync("c").ok());
  EXPECT_EQ(storage.replace("c", 10, {}).error().refusal, base::Refusal::kFileUnwritable);
}

TEST_F(FileStorageTest, WhatWasCutOffIsNotDurable) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  std::filesystem::resize_file(directory_ + "/a", 9);
  EXPECT_EQ(storage.check("a").error().refusal, base::Refusal::kFileNotFound);
  ASSERT_TRUE(storage.write("a", 0, base::Bytes{1}).ok());
  EXPECT_NE(storage.sync("a").error().text.find("became shorter"), std::string::npos);
  ASSERT_TRUE(storage.replace("a", 10, {}).ok());
  EXPECT_TRUE(storage.check("a").ok());
}

// --- a folder that is exchanged -----------------------------------------------------

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(FileStorageTest, X5_NothingIsWrittenIntoAFolderThatTookThePlace) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  ASSERT_TRUE(storage.open("b", 10).ok());
  const std::string moved = directory_ + "_moved";
  std::filesystem::rename(directory_, moved);
  std::filesystem::create_directory(directory_);
  for (const char* name : {"/a", "/b", "/b_new"}) std::ofstream(directory_ + name) << "other";
  EXPECT_EQ(storage.check("a").error().refusal, base::Refusal::kFileNotFound);
  EXPECT_NE(storage.check("a").error().text.find("another folder"), std::string::npos);
  EXPECT_EQ(storage.replace("a", 10, {}).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_EQ(storage.open("b", 100).error().refusal, base::Refusal::kFileUnwritable);
  EXPECT_FALSE(storage.open("c", 100).ok());
  (void)storage.write("b", 0, base::Bytes{1}).ok();
  EXPECT_FALSE(storage.sync("b").ok());
  EXPECT_EQ(files(), 3u);
  for (const char* name : {"/a", "/b", "/b_new"}) EXPECT_EQ(content(directory_ + name), "other");
  std::filesystem::remove_all(directory_);
  std::filesystem::rename(moved, directory_);
  EXPECT_TRUE(storage.check("a").ok());
  EXPECT_TRUE(storage.replace("a", 20, {}).ok()) << "the right one is back";
  EXPECT_EQ(files(), 2u);
}

// A copy whose files are links to the same ones is another folder all the same.
TEST_F(FileStorageTest, X5_AFolderWithTheSameFilesIsAnotherOne) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  const std::string moved = directory_ + "_moved";
  std::filesystem::rename(directory_, moved);
  std::filesystem::create_directory(directory_);
  std::filesystem::create_hard_link(moved + "/a", directory_ + "/a");
  EXPECT_FALSE(storage.check("a").ok());
  std::filesystem::remove_all(moved);
}

// Between looking at the path and writing, the folder may go: what is written follows the folder.
TEST_F(FileStorageTest, X5_TheFolderIsTheOneThatWasGiven) {
  const std::string moved = directory_ + "_moved";
  const int folder = ::open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  std::filesystem::rename(directory_, moved);
  std::filesystem::create_directory(directory_);
  std::ofstream(directory_ + "/a") << "other";
  FileStorage storage(directory_, folder);
  ::close(folder);
  EXPECT_EQ(storage.read("a", 0, 5).error().refusal, base::Refusal::kFileNotFound);
  EXPECT_FALSE(storage.open("a", 10).ok());
  std::filesystem::remove_all(moved);
}

// --- what is durable, the disk has been told ----------------------------------------

// The inodes that `job` has synced, in order.
template <class Job>
std::vector<ino_t> syncs_of(Job job) {
  synced.clear();
  job();
  return synced;
}

ino_t inode(const std::string& path) {
  struct stat info {};
  EXPECT_EQ(::stat(path.c_str(), &info), 0) << path;
  return info.st_ino;
}

TEST_F(FileStorageTest, X5_WhatIsSyncedIsAskedOfTheDisk) {
  FileStorage storage(directory_);
  const auto opened = syncs_of([&] { EXPECT_TRUE(storage.open("a", 100).ok()); });
  const ino_t file = inode(directory_ + "/a");
  const ino_t folder = inode(directory_);
  ASSERT_GE(opened.size(), 2u);
  EXPECT_EQ(opened[0], file) << "its room";
  EXPECT_EQ(opened[1], folder) << "its name";
  EXPECT_EQ(syncs_of([&] { EXPECT_TRUE(storage.write("a", 0, base::Bytes{1}).ok()); }),
            std::vector<ino_t>());
  EXPECT_EQ(syncs_of([&] { EXPECT_TRUE(storage.sync("a").ok()); }), std::vector<ino_t>{file});
  disk_fails = true;
  EXPECT_EQ(storage.sync("a").error().refusal, base::Refusal::kFileUnwritable);
  disk_fails = false;
}

// First the new file, then its name.
TEST_F(FileStorageTest, X5_ANewFileIsDurableBeforeItTakesThePlaceOfTheOldOne) {
  FileStorage storage(directory_);
  ASSERT_TRUE(storage.open("a", 10).ok());
  const base::Bytes bytes{7, 8};
  const Storage::Piece piece{1, bytes};
  const auto calls = syncs_of([&] { ASSERT_TRUE(storage.replace("a", 10, {&piece, 1}).ok()); });
  const ino_t file = inode(directory_ + "/a");
  ASSERT_GE(calls.size(), 3u);
  EXPECT_EQ(calls[0], file) << "its room";
  EXPECT_EQ(calls[calls.size() - 2], file) << "its content";
  EXPECT_EQ(calls.back(), inode(directory_)) << "its name";
  disk_fails = true;
  const base::Bytes others{1, 1};
  const Storage::Piece other{1, others};
  EXPECT_FALSE(storage.replace("a", 10, {&other, 1}).ok());
  disk_fails = false;
  EXPECT_EQ(*storage.read("a", 1, 2), bytes) << "the old one stays";
}

}  // namespace
}  // namespace vm
