// What is durable with a switch and with an undo, and records that are whole but do not fit.
#include "ir/bytecode/no_program.h"
#include "tests/unit/store/carried.h"

namespace plc {
namespace {

// The newest values are those of the trial, in its layout, when another program takes the place of
// both.
TEST_F(Carried, case57_ALostTrialThenAnotherProgramOnTheCommandLine) {
  begin(program("v : DINT; gone : INT := 4;"));
  plc_->set("v", "1234");
  plc_->set("gone", "5");
  ASSERT_TRUE(plc_->change(program("v : LINT; added : INT;")).ok());
  plc_->set("v", "1235");
  ASSERT_TRUE(plc_->save().ok());
  cut();
  const base::Status booted = plc_->boot(program("v : INT; gone : DINT; other : INT;"));
  ASSERT_TRUE(booted.ok()) << base::to_string(booted.error());
  EXPECT_EQ(plc_->get("v"), "1235");
  EXPECT_EQ(plc_->get("gone"), "5");
  cut();  // before a save
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "1235");
  EXPECT_EQ(plc_->get("gone"), "5");
}

// What only the new version retains is durable with the switch: an accept that is cut off before
// anything else is saved finds it.
TEST_F(Carried, X5_WhatBecomesRetainedIsDurableWithTheSwitch) {
  begin("VAR_GLOBAL v : INT := 1; END_VAR PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM");
  plc_->set("v", "40");
  ASSERT_TRUE(plc_->change(program("v : INT := 2;")).ok());
  ASSERT_TRUE(plc_->store().accept().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "40");
}

TEST_F(Carried, X5_WhatWasWrittenOnTrialIsDurableWithTheUndo) {
  begin(program("v : INT := 1;"));
  ASSERT_TRUE(plc_->change(program("v : DINT := 1;")).ok());
  plc_->set("v", "50");
  ASSERT_TRUE(plc_->undo().ok());
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_FALSE(plc_->found().trial_lost);
  EXPECT_EQ(plc_->get("v"), "50");
}

TEST_F(Carried, X5_ValuesOfAProgramThatIsNotStoredAreNotSaved) {
  begin(program("v : INT := 1;"));
  plc_->set("v", "9");
  ASSERT_TRUE(plc_->save().ok());
  base::Digest other = plc_->status().running;
  other[0] ^= 1;
  EXPECT_EQ(plc_->store().save_retained(other, 9, base::Bytes(2, 0)).error().refusal,
            base::Refusal::kStorageFailed);
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_EQ(plc_->get("v"), "9");
}

// A record may be whole and still not be what the program makes of it.
TEST_F(Carried, ValuesOfAnotherLengthAreAnAlarm) {
  begin(program("v : INT := 1;"));
  const base::Digest running = plc_->status().running;
  for (const size_t bytes : {1, 3, 100}) {
    ASSERT_TRUE(plc_->store().save_retained(running, 9, base::Bytes(bytes, 5)).ok());
    cut();
    ASSERT_TRUE(plc_->boot().ok());
    EXPECT_FALSE(plc_->found().alarms.empty()) << bytes;
    EXPECT_EQ(plc_->get("v"), "1") << bytes;
  }
}

TEST_F(Carried, AProgramUnderTheNameOfAnotherDoesNotBoot) {
  const ir::VerifiedImage image = build(program("v : INT := 1;"));
  {
    online_change::Store store(disk_, {4096, 64, 64, 8});
    base::Digest other = image.digest();
    other[0] ^= 1;
    ASSERT_TRUE(store.install({other, image.encoded()}, 64).ok());
  }
  cut();
  ASSERT_TRUE(plc_->boot().ok());
  EXPECT_TRUE(ir::is_no_program(plc_->controller().image()));
  EXPECT_NE(plc_->found().fault.find("not what it is called"), std::string::npos);
}

}  // namespace
}  // namespace plc
