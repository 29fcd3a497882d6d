// What a connection has uploaded or is reading page by page is kept for it alone, and given back
// when it ends, however it ends.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "base/sha256.h"
#include "online_change/package/package.h"
#include "tests/sim/heap_use.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

using base::Refusal;
using vm::Command;

class Session : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(plc_.boot("PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM").ok());
  }
  base::Status upload(uint64_t session, uint64_t offset, size_t size) {
    plc_.service().asked_by("tester", session);
    vm::Request part{.command = Command::kUpload, .offset = offset};
    part.data.assign(size, 1);
    return plc_.ask(std::move(part));
  }
  sim::SimStorage disk_;
  Plc plc_{disk_};
};

TEST_F(Session, AnUploadEndsWithItsConnection) {
  const uint64_t before = sim::heap_use();
  constexpr size_t kPart = vm::kChunkBytes;
  constexpr uint64_t kAll = 64u << 20;
  for (uint64_t at = 0; at < kAll; at += kPart) ASSERT_TRUE(upload(1, at, kPart).ok());
  EXPECT_GE(sim::heap_use(), before + kAll);
  plc_.service().ended(2);
  EXPECT_TRUE(upload(1, kAll, 1).ok()) << "another one ended";
  plc_.service().ended(1);
  EXPECT_LE(sim::heap_use(), before + (1u << 20));
  const base::Status rest = upload(3, kAll + 1, 1);
  ASSERT_FALSE(rest.ok());
  EXPECT_EQ(rest.error().refusal, Refusal::kProtocol);
}

TEST_F(Session, AnUploadIsBounded) {
  constexpr uint64_t kMost = 1000;
  EXPECT_EQ(plc_.most_upload, base::kMaxImageBytes);
  plc_.most_upload = kMost;
  ASSERT_TRUE(plc_.boot().ok());
  EXPECT_TRUE(upload(1, 0, kMost).ok());
  const base::Status more = upload(1, kMost, 1);
  ASSERT_FALSE(more.ok());
  EXPECT_EQ(more.error().refusal, Refusal::kTooLarge);
  EXPECT_TRUE(upload(1, 0, 1).ok()) << "another one begins";
}

// The tool says what it has sent; other bytes are not even looked at.
TEST_F(Session, C4_APackageThatArrivedDamagedIsNotStaged) {
  const ir::VerifiedImage& running = plc_.controller().verified();
  const ir::VerifiedImage next =
      build("PROGRAM P VAR n : INT; END_VAR n := n + 2; END_PROGRAM", &running.image());
  auto package = online_change::make_package(running.encoded(), next.encoded());
  ASSERT_TRUE(package.ok());
  const base::Bytes bytes = online_change::encode(*package);
  for (const bool damaged : {true, false}) {
    vm::Request upload{.command = Command::kUpload};
    upload.data = bytes;
    if (damaged) upload.data.push_back(0);
    ASSERT_TRUE(plc_.ask(std::move(upload)).ok());
    vm::Request stage{.command = Command::kStage};
    stage.digest = base::sha256(bytes);
    const base::Status staged = plc_.ask(std::move(stage));
    ASSERT_EQ(staged.ok(), !damaged);
    if (damaged) {
      EXPECT_EQ(staged.error().refusal, Refusal::kBadHash);
      EXPECT_NE(staged.error().text.find("arrived damaged"), std::string::npos);
    }
  }
}

TEST_F(Session, OneUploadAtATime) {
  EXPECT_TRUE(upload(1, 0, 100).ok());
  const base::Error others = upload(2, 100, 100).error();  // case79: told whose
  EXPECT_EQ(others.refusal, Refusal::kChangePending);
  EXPECT_NE(others.text.find("tester is bringing another change"), std::string::npos) << others.text;
  EXPECT_TRUE(upload(2, 0, 100).ok());
  EXPECT_FALSE(upload(1, 100, 100).ok()) << "the newer one has ended it";
  EXPECT_FALSE(upload(2, 300, 100).ok()) << "a part is missing";
  EXPECT_TRUE(upload(2, 100, 100).ok());
}

// Two that read the journal page by page: each gets all of it.
TEST_F(Session, PagesOfTheJournalAreOfOneReading) {
  const auto bytes = [&](uint64_t session, uint64_t offset) {
    plc_.service().asked_by("tester", session);
    bool keep_open = true;
    auto page = vm::decode_answer(plc_.service().answer(
        vm::encode({.command = Command::kJournal, .offset = offset}), keep_open));
    return page.ok() ? page->size() : 0;
  };
  EXPECT_FALSE(plc_.undo().ok());  // there is a second entry
  const size_t first = bytes(1, 0);
  const size_t rest = bytes(1, 1);
  ASSERT_GT(rest, 0u);
  EXPECT_EQ(bytes(2, 0), first);
  EXPECT_EQ(bytes(2, 1'000'000), 0u) << "it has read all of it";
  EXPECT_EQ(bytes(1, 1), rest);
}

}  // namespace
}  // namespace plc
