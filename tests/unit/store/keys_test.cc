// F-03: a controller with keys takes nothing unsigned, forged, expired, replayed or meant for
// another one, by any way in, and runs on untouched.
#include <gtest/gtest.h>

#include "online_change/package/signed_file.h"
#include "online_change/store/trust_record.h"
#include "tools/common/utc_time.h"

#ifdef STC_HAS_KEYS
#include <filesystem>

#include "adapters/keys/keys.h"
#include "base/sha256.h"
#include "online_change/package/package.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/key_trust.h"
#endif

namespace plc {
namespace {

using base::Refusal;
using online_change::SignedKind;
using online_change::Statement;

TEST(SignedFile, F03_ComesBackByteForByte) {
  Statement statement{SignedKind::kFleet, {}, "plan/1", 7, 100, 200, "line2", 3, {}};
  const base::Bytes content = {1, 2, 3};
  statement.content = base::sha256(content);
  online_change::Signature signature{};
  signature.fill(9);
  base::Bytes bytes = online_change::encode(statement, signature, content);
  const base::Bytes whole = bytes;
  const auto opened = online_change::open_signed(bytes);
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ(bytes, content);
  EXPECT_EQ(online_change::encode(opened->statement, opened->signature, bytes), whole);
  EXPECT_EQ(opened->message, online_change::message_of(statement));
}

TEST(SignedFile, F03_TruncatedAtEachByteIsRefused) {
  Statement statement{SignedKind::kPackage, {}, "p", 1, 2, 3, "", 4, {}};
  const base::Bytes content = {1, 2, 3, 4};
  statement.content = base::sha256(content);
  const base::Bytes whole = online_change::encode(statement, {}, content);
  for (size_t size = 0; size < whole.size(); ++size) {
    base::Bytes part(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size));
    const auto opened = online_change::open_signed(part);
    ASSERT_FALSE(opened.ok()) << size;
    EXPECT_TRUE(opened.error().refusal == Refusal::kBadFormat ||
                opened.error().refusal == Refusal::kBadHash);
    EXPECT_EQ(part.size(), size) << "it is as it was";
  }
}

TEST(SignedFile, F03_NamesArePrintableAndShort) {
  EXPECT_TRUE(online_change::is_signed_name("line-2/PLC_1:a.b"));
  EXPECT_TRUE(online_change::is_signed_name(std::string(64, 'x')));
  for (const std::string& bad : {std::string(), std::string(65, 'x'), std::string("a b"),
                                 std::string("\x1b[2J"), std::string("a\n")}) {
    EXPECT_FALSE(online_change::is_signed_name(bad));
  }
}

TEST(TrustRecord, F03_AFullListRemembersWhatItDrops) {
  online_change::TrustRecord record;
  for (size_t i = 0; i <= online_change::kMostPlans; ++i) {
    record.mark({"p" + std::to_string(i), 1, static_cast<int64_t>(1000 + i), {}});
  }
  EXPECT_EQ(record.plans.size(), online_change::kMostPlans);
  EXPECT_EQ(record.find("p0"), nullptr);
  EXPECT_EQ(record.dropped_s, 1000);
  const auto again = online_change::decode_trust(online_change::encode(record));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(online_change::encode(*again), online_change::encode(record));
}

TEST(UtcTime, F03_ReadsWhatItWrites) {
  EXPECT_EQ(tools::parse_utc("1970-01-02"), 86400);
  EXPECT_EQ(tools::parse_utc("2026-03-01T08:00:01Z"), 1772352001);
  EXPECT_EQ(tools::utc_text(1772352001), "2026-03-01T08:00:01Z");
  for (const char* bad : {"2026-02-30", "2026-3-1", "2026-03-01T24:00:00Z", "1969-12-31",
                          "2026-03-01T08:00:00", "", "2026-03-01 "}) {
    EXPECT_FALSE(tools::parse_utc(bad).has_value()) << bad;
  }
}

#ifdef STC_HAS_KEYS

constexpr int64_t kNow = 1'780'000'000;  // s
constexpr int64_t kSecond = 1'000'000'000;

std::string program(int step) {
  return "PROGRAM P VAR n : INT; END_VAR n := n + " + std::to_string(step) + "; END_PROGRAM";
}

class Keys : public ::testing::Test {
 protected:
  void SetUp() override {
    base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
    ASSERT_TRUE(folder.ok());
    folder_.emplace(std::move(*folder));
    for (keys::NewKey* key : {&office_, &old_, &chief_, &stranger_}) {
      base::Result<keys::NewKey> made = keys::make_key();
      ASSERT_TRUE(made.ok());
      *key = *made;
    }
    trust(true);
    plc_.make_trust = [this](online_change::Store& store) {
      auto made = stvm::KeyTrust::open(file(), store, keys::verify);
      EXPECT_TRUE(made.ok());
      return std::move(*made);
    };
    plc_.wall_ns = kNow * kSecond;
    ASSERT_TRUE(plc_.boot(program(1)).ok());
    plc_.run(2);
  }

  std::string file() const { return folder_->file("trust.toml"); }
  static std::string lines(const char* name, const keys::NewKey& key) {
    return std::string("[keys.") + name + "]\npublic = \"" + base::to_hex(key.public_key) + "\"\n";
  }
  void trust(bool with_office, const std::string& policy = {}) {
    std::string text = "name = \"line2\"\n" + policy + lines("old", old_) + "until = \"" +
                       tools::utc_text(kNow + 1000) + "\"\n" + lines("chief", chief_) +
                       "revokes = true\n";
    if (with_office) text += lines("office", office_);
    ASSERT_TRUE(tools::write_file(file(), base::as_bytes(text)).ok());
  }

  base::Bytes package(int step) {
    const ir::VerifiedImage next = build(program(step), &plc_.controller().image());
    auto made = online_change::make_package(plc_.controller().verified().encoded(), next.encoded());
    EXPECT_TRUE(made.ok());
    return online_change::encode(*made);
  }
  Statement statement() {
    Statement out;
    out.plan = "p";
    out.sequence = ++sequence_;
    out.made_s = kNow;
    out.expires_s = kNow + 500;
    return out;
  }
  base::Bytes signed_by(const keys::NewKey& key, const base::Bytes& content, Statement said) {
    said.key = online_change::key_id(key.public_key);
    said.size = content.size();
    said.content = base::sha256(content);
    const auto signature = keys::sign(key.pem, online_change::message_of(said));
    EXPECT_TRUE(signature.ok());
    return online_change::encode(said, *signature, content);
  }
  base::Bytes signed_by(const keys::NewKey& key, const base::Bytes& content) {
    return signed_by(key, content, statement());
  }
  base::Status stage(const base::Bytes& bytes, uint32_t flags = 0) {
    vm::Request upload{.command = vm::Command::kUpload};
    upload.data = bytes;
    base::Status done = plc_.ask(std::move(upload));
    if (!done.ok()) return done;
    vm::Request stage{.command = vm::Command::kStage, .flags = flags};
    stage.digest = base::sha256(bytes);
    return plc_.ask(std::move(stage));
  }
  base::Status make_switch() {
    vm::Request request{.command = vm::Command::kSwitch};
    request.flags = vm::kAllowOverrun;
    return plc_.ask(std::move(request));
  }
  base::Status bring(const base::Bytes& bytes) {
    base::Status staged = stage(bytes);
    return staged.ok() ? make_switch() : staged;
  }
  // It was refused so, and the controller runs on as if nothing had come.
  void refuses(Refusal refusal, const base::Bytes& bytes, const char* what) {
    const base::Digest running = plc_.controller().verified().digest();
    const std::string n = plc_.get("P.n");
    for (const uint32_t flags : {0u, uint32_t{vm::kRehearsal}}) {
      const base::Status brought = stage(bytes, flags);
      ASSERT_FALSE(brought.ok()) << what;
      EXPECT_EQ(brought.error().refusal, refusal)
          << what << ": " << base::to_string(brought.error());
    }
    EXPECT_FALSE(make_switch().ok()) << what;
    EXPECT_EQ(plc_.controller().verified().digest(), running) << what;
    EXPECT_EQ(plc_.get("P.n"), n) << what;
    EXPECT_FALSE(plc_.controller().faulted()) << what;
    const online_change::JournalEntry last = plc_.store().history().back();
    EXPECT_EQ(last.event, online_change::Event::kRefused) << what;
  }
  void cut() {
    disk_ = disk_.after_cut(sim::SimStorage::Choice(disk_.dirty().size(), 0));
    ASSERT_TRUE(plc_.boot().ok());
    plc_.run(2);
  }
  std::string last_text() { return plc_.store().history().back().text; }

  std::optional<tools::TemporaryFolder> folder_;
  keys::NewKey office_;
  keys::NewKey old_;
  keys::NewKey chief_;
  keys::NewKey stranger_;
  uint64_t sequence_ = 0;
  sim::SimStorage disk_;
  Plc plc_{disk_};
};

TEST_F(Keys, F03_WhatIsSignedIsTakenAndTheJournalSaysByWhom) {
  ASSERT_TRUE(bring(signed_by(office_, package(10))).ok());
  EXPECT_NE(last_text().find("signed by office"), std::string::npos) << last_text();
  const int before = std::stoi(plc_.get("P.n"));
  plc_.run(1);
  EXPECT_EQ(std::stoi(plc_.get("P.n")), before + 10);
  EXPECT_TRUE(plc_.undo().ok());
  EXPECT_TRUE(plc_.ask(vm::Command::kRedo).ok()) << "what was taken may come again here";
  EXPECT_TRUE(make_switch().ok());
  EXPECT_TRUE(plc_.accept().ok());
}

TEST_F(Keys, F03_UnsignedIsRefused) { refuses(Refusal::kUnsigned, package(10), "unsigned"); }

TEST_F(Keys, F03_EachFlippedBitIsRefused) {
  const base::Bytes good = signed_by(office_, package(10));
  const size_t statement = good.size() - package(10).size();
  for (size_t at = 0; at < good.size(); at += at < statement ? 1 : 97) {
    base::Bytes bad = good;
    bad[at] ^= 4;
    ASSERT_FALSE(bring(bad).ok()) << at;
  }
  for (size_t size = 0; size < good.size(); size += size < statement ? 1 : 97) {
    ASSERT_FALSE(
        bring(base::Bytes(good.begin(), good.begin() + static_cast<ptrdiff_t>(size))).ok());
  }
  EXPECT_TRUE(bring(good).ok()) << "and the good one is taken still";
}

TEST_F(Keys, F03_AnotherContentOrStatementIsNotWhatWasSigned) {
  const base::Bytes content = package(10);
  const base::Bytes good = signed_by(office_, content);
  base::Bytes other = package(20);
  base::Bytes exchanged(good.begin(), good.end() - static_cast<ptrdiff_t>(content.size()));
  exchanged.insert(exchanged.end(), other.begin(), other.end());
  refuses(Refusal::kBadHash, exchanged, "another content");
  base::Bytes copy = good;
  auto opened = online_change::open_signed(copy);
  ASSERT_TRUE(opened.ok());
  opened->statement.expires_s += 1;
  refuses(Refusal::kBadSignature,
          online_change::encode(opened->statement, opened->signature, content), "another time");
}

TEST_F(Keys, F03_ForeignKeysAndForgedNamesAreRefused) {
  refuses(Refusal::kUnknownKey, signed_by(stranger_, package(10)), "a stranger");
  base::Bytes bytes = signed_by(stranger_, package(10));
  auto opened = online_change::open_signed(bytes);
  ASSERT_TRUE(opened.ok());
  opened->statement.key = online_change::key_id(office_.public_key);
  refuses(Refusal::kBadSignature,
          online_change::encode(opened->statement, opened->signature, bytes), "a forged name");
}

TEST_F(Keys, F03_AnotherTargetOrUseIsRefused) {
  Statement said = statement();
  said.target = "line3";
  refuses(Refusal::kOtherTarget, signed_by(office_, package(10), said), "another controller");
  said = statement();
  said.kind = SignedKind::kImage;
  refuses(Refusal::kOtherTarget, signed_by(office_, package(10), said), "another use");
  refuses(Refusal::kOtherTarget, signed_by(chief_, package(10)), "a key that only revokes");
  said = statement();
  said.target = "line2";
  EXPECT_TRUE(bring(signed_by(office_, package(10), said)).ok());
}

TEST_F(Keys, F03_ExpiredIsRefusedAlsoAtTheSwitchAndWithTheClockSetBack) {
  Statement said = statement();
  said.expires_s = kNow;
  refuses(Refusal::kSignatureExpired, signed_by(office_, package(10), said), "expired");
  ASSERT_TRUE(stage(signed_by(office_, package(10))).ok());
  plc_.wall_ns += 501 * kSecond;
  const base::Status late = make_switch();
  ASSERT_FALSE(late.ok());
  EXPECT_EQ(late.error().refusal, Refusal::kSignatureExpired);
  said = statement();
  said.expires_s = kNow + 600;
  ASSERT_TRUE(bring(signed_by(office_, package(10), said)).ok());
  ASSERT_TRUE(plc_.undo().ok());
  plc_.wall_ns -= 501 * kSecond;
  refuses(Refusal::kSignatureExpired, signed_by(office_, package(20)), "the clock was set back");
}

TEST_F(Keys, F03_AReplayIsRefusedAlsoAfterAPowerCut) {
  const base::Bytes first = signed_by(office_, package(10));
  const base::Bytes second = signed_by(office_, package(20));
  ASSERT_TRUE(stage(first, vm::kRehearsal).ok()) << "a dry run takes nothing";
  ASSERT_TRUE(bring(second).ok());
  ASSERT_TRUE(plc_.undo().ok());
  refuses(Refusal::kReplayed, second, "the same again");
  refuses(Refusal::kReplayed, first, "an older one of the plan");
  cut();
  refuses(Refusal::kReplayed, second, "after a cut");
  Statement other = statement();
  other.plan = "q";
  other.sequence = 1;
  EXPECT_TRUE(bring(signed_by(office_, package(10), other)).ok()) << "another plan";
}

TEST_F(Keys, F03_KeysRollOverWhileTheProgramRuns) {
  ASSERT_TRUE(bring(signed_by(old_, package(10))).ok());
  plc_.wall_ns += 1000 * kSecond;
  Statement said = statement();
  said.expires_s = kNow + 5000;
  refuses(Refusal::kKeyEnded, signed_by(old_, package(20), said), "its time is over");
  EXPECT_TRUE(bring(signed_by(office_, package(20), said)).ok());
  trust(false);
  said.sequence = ++sequence_;
  refuses(Refusal::kUnknownKey, signed_by(office_, package(30), said), "taken out of the file");
  ASSERT_TRUE(plc_.undo().ok());
  const base::Status again = plc_.ask(vm::Command::kRedo);
  ASSERT_FALSE(again.ok()) << "nor does redo bring it again";
  EXPECT_EQ(again.error().refusal, Refusal::kUnknownKey);
  ASSERT_TRUE(tools::write_file(file(), base::as_bytes("rubbish")).ok());
  refuses(Refusal::kBadKeys, signed_by(office_, package(30), said), "a file that cannot be read");
}

TEST_F(Keys, F03_ARevokedKeyStaysRevoked) {
  const base::Bytes list =
      online_change::encode_revoked({online_change::key_id(office_.public_key)});
  Statement said = statement();
  said.kind = SignedKind::kRevoked;
  const base::Bytes staged = signed_by(office_, package(10));
  EXPECT_FALSE(stage(signed_by(office_, list, said)).ok()) << "not every key may revoke";
  ASSERT_TRUE(stage(staged).ok());
  const base::Bytes signed_list = signed_by(chief_, list, said);
  ASSERT_TRUE(stage(signed_list).ok());
  EXPECT_EQ(plc_.store().history().back().event, online_change::Event::kRevoked);
  EXPECT_EQ(last_text(), "office by chief");
  const base::Status late = make_switch();
  ASSERT_FALSE(late.ok()) << "what was staged before";
  EXPECT_EQ(late.error().refusal, Refusal::kKeyEnded);
  refuses(Refusal::kKeyEnded, signed_by(office_, package(20)), "revoked");
  said.sequence = ++sequence_;
  ASSERT_TRUE(stage(signed_by(chief_, online_change::encode_revoked({}), said)).ok());
  refuses(Refusal::kKeyEnded, signed_by(office_, package(20)), "a newer list without it");
  cut();
  refuses(Refusal::kKeyEnded, signed_by(office_, package(20)), "after a cut");
  EXPECT_FALSE(stage(signed_list).ok()) << "an old list";
  EXPECT_TRUE(bring(signed_by(old_, package(20))).ok());
}

TEST_F(Keys, F03_TheLocalSocketGoesByThePolicy) {
  trust(true, "unsigned = \"local\"\n");
  auto& service = dynamic_cast<stvm::ControllerService&>(plc_.service());
  service.asked_by("tester", 1, true);
  refuses(Refusal::kUnsigned, package(10), "from another machine");
  service.asked_by("tester", 1, false);
  ASSERT_TRUE(bring(package(10)).ok());
  ASSERT_TRUE(plc_.undo().ok());
  trust(true);
  const base::Status again = plc_.ask(vm::Command::kRedo);
  ASSERT_FALSE(again.ok()) << "unsigned, and the policy is another one";
  EXPECT_EQ(again.error().refusal, Refusal::kUnsigned);
}

TEST_F(Keys, F03_ADamagedRecordLetsNothingIn) {
  ASSERT_TRUE(bring(signed_by(office_, package(10))).ok());
  ASSERT_TRUE(disk_.write(online_change::kTrustFile, 520, base::Bytes(8, 0xee)).ok());
  ASSERT_TRUE(disk_.sync(online_change::kTrustFile).ok());
  refuses(Refusal::kStorageFailed, signed_by(office_, package(20)), "a damaged record");
}

TEST_F(Keys, F03_TheFirstProgramIsSignedToo) {
  sim::SimStorage disk;
  Plc empty{disk};
  empty.make_trust = plc_.make_trust;
  empty.wall_ns = plc_.wall_ns;
  ASSERT_TRUE(empty.boot(std::optional<ir::VerifiedImage>(), true).ok());
  const base::Status brought = empty.stage(build(program(1)));
  ASSERT_FALSE(brought.ok());
  EXPECT_EQ(brought.error().refusal, Refusal::kUnsigned);
}

TEST_F(Keys, F03_WithoutKeysASignedOneIsTakenAsAnyOther) {
  plc_.make_trust = {};
  sim::SimStorage disk;
  Plc other{disk};
  ASSERT_TRUE(other.boot(program(1)).ok());
  const base::Bytes bytes = signed_by(stranger_, package(10));
  vm::Request upload{.command = vm::Command::kUpload};
  upload.data = bytes;
  ASSERT_TRUE(other.ask(std::move(upload)).ok());
  vm::Request stage{.command = vm::Command::kStage};
  stage.digest = base::sha256(bytes);
  EXPECT_TRUE(other.ask(std::move(stage)).ok());
}

#endif

}  // namespace
}  // namespace plc
