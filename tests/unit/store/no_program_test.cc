// case56, R-09: a controller in whose folder no program is intact begins in FAULT, answers, and
// takes one by an ordinary change or at its next start; nothing that can be read is lost by that.
#include "ir/bytecode/no_program.h"

#include "tests/unit/store/carried.h"

namespace plc {
namespace {

const std::string kSame = program("v : INT := 1;");
const std::string kOther = program("v : DINT := 1; w : INT := 2;");

class NoProgram : public Carried {
 protected:
  // `kSame` has run, v is 9 and saved; then the files that begin so are damaged.
  void lose(const std::string& files) {
    begin(kSame);
    image_ = plc_->controller().verified().digest();
    plc_->set("v", "9");
    ASSERT_TRUE(plc_->save().ok());
    cut();
    for (size_t file = 0; file < disk_.names().size(); ++file) {
      if (!disk_.names()[file].starts_with(files)) continue;
      disk_.content(file)[600] ^= 1;
      disk_.content(file)[20] ^= 1;
      disk_.settle(file);
    }
  }
  void expect_to_run() {
    const int scans = std::stoi(plc_->get("P.n"));
    plc_->run(3);
    EXPECT_EQ(plc_->get("P.n"), std::to_string(scans + 3));
  }
  bool holds_nothing() const { return ir::is_no_program(plc_->controller().image()); }
  std::string alarms() {
    std::string out;
    for (const std::string& text : plc_->status().alarms) out += text + "\n";
    return out;
  }
  bool says(const std::string& what) { return alarms().find(what) != std::string::npos; }

  base::Digest image_{};
};

TEST_F(NoProgram, case56_TheControllerBeginsInFaultAndAnswers) {
  lose("slot");
  const std::vector<std::string> names = disk_.names();
  std::vector<base::Bytes> before;
  for (size_t i = 0; i < names.size(); ++i) before.push_back(disk_.content(i));
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_TRUE(holds_nothing());
  EXPECT_TRUE(plc_->status().faulted);
  EXPECT_TRUE(says("is damaged or unreadable, and no other program is intact")) << alarms();
  EXPECT_TRUE(says("`stvm change SOURCES|IMAGE`")) << alarms();
  EXPECT_TRUE(says("retained values of " + base::short_hex(image_))) << alarms();
  vm::Request restart{.command = vm::Command::kRestart};
  EXPECT_EQ(plc_->ask(restart).error().refusal, base::Refusal::kNothingBoots);
  EXPECT_EQ(plc_->ask({.command = vm::Command::kGet, .names = {"v"}}).error().refusal,
            base::Refusal::kNoSuchVariable);
  plc_->run(3);
  ASSERT_TRUE(plc_->store().renew().ok());
  for (size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "journal" || names[i].starts_with("control")) continue;
    EXPECT_EQ(disk_.content(i), before[i]) << names[i] << " was written";
  }
}

TEST_F(NoProgram, case56_TheProgramComesByAChangeWithItsRetainedValues) {
  lose("slot");
  ASSERT_TRUE(plc_->boot().ok());
  ASSERT_TRUE(plc_->change(kSame).ok());
  EXPECT_EQ(plc_->status().running, image_) << "the same image as the first time";
  EXPECT_EQ(plc_->get("v"), "9");
  EXPECT_FALSE(plc_->status().faulted);
  EXPECT_EQ(alarms(), "");
  expect_to_run();
  EXPECT_EQ(plc_->status().edits, 0u) << "nothing could be undone to";
  EXPECT_EQ(plc_->undo().error().refusal, base::Refusal::kNothingToUndo);
  ASSERT_TRUE(plc_->change(kOther).ok()) << "then it is a controller like any other";
  EXPECT_EQ(plc_->get("v"), "9");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->status().running, image_);
  EXPECT_EQ(plc_->get("v"), "9");
}

TEST_F(NoProgram, case56_OfAnotherProgramTheyBeginAnewAndThatIsSaid) {
  lose("slot");
  ASSERT_TRUE(plc_->boot().ok());
  ASSERT_TRUE(plc_->change(kOther).ok());
  EXPECT_EQ(plc_->get("v"), "1");
  EXPECT_TRUE(says("retained values begin anew")) << alarms();
}

TEST_F(NoProgram, case56_OneThatIsNamedAtTheStartHasThemToo) {
  lose("slot");
  ASSERT_TRUE(plc_->boot(kSame).ok());
  EXPECT_EQ(plc_->get("v"), "9");
  EXPECT_TRUE(says("the retained values are taken over")) << alarms();
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "9");
}

TEST_F(NoProgram, case56_AnotherOneThatIsNamedAtTheStartBeginsAnew) {
  lose("slot");
  ASSERT_TRUE(plc_->boot(kOther).ok());
  EXPECT_EQ(plc_->get("v"), "1");
  EXPECT_TRUE(says("cold start: ")) << alarms();
  EXPECT_TRUE(says("those of " + base::short_hex(image_) + " are stored, but")) << alarms();
}

// The program that they are of can be read: they follow by path and type.
TEST_F(NoProgram, case56_WithoutAControlRecordTheyFollowByPathIntoWhatIsNamed) {
  lose("control");
  ASSERT_TRUE(plc_->boot(kOther).ok());
  EXPECT_EQ(plc_->get("v"), "9");
  EXPECT_EQ(plc_->get("w"), "2");
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "9");
}

// The power fails at every call of the first change: no program still, or that one with its values.
TEST_F(NoProgram, X5_case54_ThePowerFailsWhileTheFirstProgramComes) {
  lose("slot");
  ASSERT_TRUE(plc_->boot().ok());
  std::mt19937 random(1);
  int tried = 0;
  int had_it = 0;
  const auto look = [&](sim::SimStorage left) {
    ++tried;
    Plc plc(left);
    ASSERT_TRUE(plc.boot().ok());
    if (ir::is_no_program(plc.controller().image())) {
      ASSERT_TRUE(plc.change(kSame).ok());
    } else {
      ++had_it;
    }
    EXPECT_EQ(plc.get("v"), "9");
  };
  disk_.before_call = [&] {
    sim::SimStorage::Choice choice(disk_.dirty().size(), 0);
    look(disk_.after_cut(choice));
    look(disk_.after_kill());
    for (uint8_t& one : choice) one = random() % 2;
    look(disk_.after_cut(choice));
  };
  ASSERT_TRUE(plc_->change(kSame).ok());
  look(disk_.after_kill());
  EXPECT_GT(tried, 20);
  EXPECT_GT(had_it, 3);
}

TEST_F(NoProgram, case56_OneThatCannotBeStoredIsRefused) {
  lose("slot");
  ASSERT_TRUE(plc_->boot().ok());
  disk_.fails = [](std::string_view) { return sim::Failure::kError; };
  EXPECT_EQ(plc_->change(kSame).error().refusal, base::Refusal::kStorageFailed);
  EXPECT_TRUE(holds_nothing());
  EXPECT_TRUE(plc_->status().faulted);
  disk_.fails = nullptr;
  ASSERT_TRUE(plc_->change(kSame).ok());
  EXPECT_EQ(plc_->get("v"), "9");
}

// A folder in which a program ran is no new one, whatever is left of it.
TEST_F(NoProgram, case56_OfDamagedValuesAndEmptyRecordsAControllerIsMadeToo) {
  lose("retain");
  for (size_t file = 0; file < disk_.names().size(); ++file) {
    if (disk_.names()[file].starts_with("retain")) continue;
    std::fill(disk_.content(file).begin(), disk_.content(file).end(), 0);
    disk_.settle(file);
  }
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_TRUE(holds_nothing());
  EXPECT_TRUE(plc_->status().faulted);
  EXPECT_TRUE(says("both control records are empty, and a program ran there, and no other")) << alarms();
}

// A mistake in the name of a folder must not become a controller.
TEST_F(NoProgram, R09_ANewFolderWaitsForItsFirstProgramOnlyWhereThatIsAskedFor) {
  cut();
  const base::Status mistaken = plc_->boot();
  ASSERT_FALSE(mistaken.ok());
  EXPECT_EQ(mistaken.error().refusal, base::Refusal::kFileNotFound);
  ASSERT_TRUE(plc_->boot(std::nullopt, true).ok());
  EXPECT_TRUE(holds_nothing());
  EXPECT_TRUE(says("no program was ever stored there; `stvm change")) << alarms();
  ASSERT_TRUE(plc_->change(kSame).ok());
  expect_to_run();
}

}  // namespace
}  // namespace plc
