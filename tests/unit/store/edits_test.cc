// Several edits on trial at once, as a serving controller does it (D3, X7, case 77): by name, there
// and back, with what is stored and what it does by itself.
#include <gtest/gtest.h>

#include "online_change/package/package.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/unit_message.h"

namespace stvm {
namespace {

using base::Refusal;
using plc::Plc;

// Each one is made on the one before: `a` narrows, `gone` goes, `c` comes.
std::string edited_source(int number, const std::string& more = {}) {
  const char* const variables[] = {"a : DINT; gone : INT := 3;", "a : INT; gone : INT := 3;",
                                   "a : INT;", "a : INT; c : INT := 8;"};
  return std::string("VAR_GLOBAL RETAIN r : DINT; ") + variables[number] +
         " END_VAR PROGRAM Main VAR n : DINT; z : INT; END_VAR n := n + " +
         std::to_string(number + 1) + "; " + more + " END_PROGRAM";
}

struct EditedPlc {
  EditedPlc() : plc(disk) {
    EXPECT_TRUE(plc.boot(edited_source(0)).ok());
    plc.run(2);
    plc.set("a", "70000");
    plc.set("gone", "44");
    plc.set("r", "5");
    EXPECT_TRUE(plc.save().ok());
    digests.push_back(plc.status().running);
  }
  void change(int number, const std::string& more = {}) {
    const base::Status done = plc.change(edited_source(number, more));
    ASSERT_TRUE(done.ok()) << base::to_string(done.error());
    plc.run(2);
    digests.push_back(plc.status().running);
  }
  void three_edits() {
    for (int number : {1, 2, 3}) change(number);
  }
  base::Status undo(const std::string& name) {
    return plc.ask({.command = vm::Command::kUndo, .names = {name}});
  }
  base::Status accept(const std::string& name) {
    return plc.ask({.command = vm::Command::kAccept, .names = {name}});
  }
  base::Status redo(const std::string& name = {}) {
    vm::Request stage{.command = vm::Command::kRedo};
    if (!name.empty()) stage.names = {name};
    base::Status staged = plc.ask(std::move(stage));
    if (!staged.ok()) return staged;
    vm::Request go{.command = vm::Command::kSwitch};
    go.flags = vm::kAllowLoss | vm::kAllowOverrun;
    return plc.ask(std::move(go));
  }
  // Their names; those in brackets are undone.
  std::string edits() {
    std::string out;
    vm::Request request{.command = vm::Command::kEdits};
    do {
      const base::Result<base::Bytes> body = plc.answer_to(request);
      base::check(body.ok(), "edits are told");
      const EditPage page = *decode_edit_page(*body);
      for (const TrialEdit& edit : page.edits) {
        out += (out.empty() ? "" : " ") + (edit.undone ? "(" + edit.name + ")" : edit.name);
      }
      request.offset = page.next;
    } while (request.offset != 0);
    return out;
  }
  std::string boots() {
    sim::SimStorage left = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
    Plc later(left);
    if (!later.boot().ok()) return "nothing";
    return "a " + later.get("a") + ", gone " + later.get("gone") + ", r " + later.get("r");
  }
  sim::SimStorage disk;
  Plc plc;
  std::vector<base::Digest> digests;  // of each version
};

TEST(Edits, D3_case77_UndoByName) {
  EditedPlc rig;
  rig.three_edits();
  EXPECT_EQ(rig.edits(), "E1 E2 E3");
  EXPECT_EQ(rig.plc.status().edits, 3u);
  EXPECT_EQ(rig.plc.get("a"), "32767");
  // Whoever undoes a name goes from the newest on; which ones that are, the command says before.
  const base::Error other = rig.undo("E1").error();
  EXPECT_EQ(other.refusal, Refusal::kNothingToUndo);
  EXPECT_NE(other.text.find("which is E3"), std::string::npos) << other.text;
  EXPECT_EQ(rig.plc.status().edits, 3u);
  ASSERT_TRUE(rig.undo("E3").ok());
  EXPECT_EQ(rig.plc.status().running, rig.digests[2]);
  ASSERT_TRUE(rig.undo("E2").ok());
  EXPECT_EQ(rig.plc.get("gone"), "44");
  ASSERT_TRUE(rig.undo("E1").ok());
  EXPECT_EQ(rig.plc.status().running, rig.digests[0]);
  EXPECT_EQ(rig.plc.get("a"), "70000");
  EXPECT_EQ(rig.edits(), "(E1) (E2) (E3)");
  EXPECT_EQ(rig.undo("E1").error().refusal, Refusal::kNothingToUndo);
}

TEST(Edits, D3_case77_RedoBringsThemAgainInTheirOrder) {
  EditedPlc rig;
  rig.three_edits();
  ASSERT_TRUE(rig.plc.undo().ok());
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_EQ(rig.edits(), "E1 (E2) (E3)");
  EXPECT_EQ(rig.redo("E3").error().refusal, Refusal::kNothingToUndo);
  ASSERT_TRUE(rig.redo("E2").ok());
  ASSERT_TRUE(rig.redo().ok());
  EXPECT_EQ(rig.edits(), "E1 E2 E3");
  EXPECT_EQ(rig.plc.status().running, rig.digests[3]);
  EXPECT_EQ(rig.plc.get("c"), "8");
  EXPECT_EQ(rig.redo().error().refusal, Refusal::kNothingToUndo);
  // What came again goes again.
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_EQ(rig.plc.get("a"), "70000");
  EXPECT_EQ(rig.plc.get("gone"), "44");
}

TEST(Edits, D3_BehindAnotherChangeNothingComesAgain) {
  EditedPlc rig;
  rig.three_edits();
  ASSERT_TRUE(rig.plc.undo().ok());
  rig.change(3, "n := n + 100;");
  EXPECT_EQ(rig.edits(), "E1 E2 E4");
  EXPECT_EQ(rig.redo().error().refusal, Refusal::kNothingToUndo);
}

// D3, X5: what boots, and with which values, is what was accepted, whatever rests on trial on top.
TEST(Edits, D3_AcceptUpToAName) {
  EditedPlc rig;
  rig.three_edits();
  EXPECT_EQ(rig.boots(), "a 70000, gone 44, r 5");
  rig.plc.set("r", "6");
  ASSERT_TRUE(rig.plc.save().ok());
  EXPECT_EQ(rig.boots(), "a 70000, gone 44, r 6");
  EXPECT_EQ(rig.accept("E7").error().refusal, Refusal::kNothingToUndo);
  ASSERT_TRUE(rig.accept("E1").ok());
  EXPECT_EQ(rig.edits(), "E2 E3");
  EXPECT_EQ(rig.plc.status().boots_next, rig.digests[1]);
  EXPECT_EQ(rig.plc.status().running, rig.digests[3]);
  // The second one drops `gone`, and a lost trial gives it back; `a` is narrow for good.
  EXPECT_EQ(rig.boots(), "a 32767, gone 44, r 6");
  ASSERT_TRUE(rig.plc.undo().ok());
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_EQ(rig.plc.status().running, rig.digests[1]);
  EXPECT_EQ(rig.plc.get("gone"), "44");
  EXPECT_EQ(rig.plc.undo().error().refusal, Refusal::kNothingToUndo);
  ASSERT_TRUE(rig.redo("E2").ok());
  ASSERT_TRUE(rig.plc.accept().ok());
  EXPECT_EQ(rig.plc.status().boots_next, rig.digests[2]);
  EXPECT_EQ(rig.plc.store().before()->digest, rig.digests[1]);  // X8
}

TEST(Edits, D3_X7_ATrapTakesBackTheNewestEditOnly) {
  EditedPlc rig;
  rig.change(1);
  ASSERT_TRUE(rig.plc.change(edited_source(2, "z := 1 / z;")).ok());
  rig.plc.run(3);
  EXPECT_TRUE(rig.plc.controller().faulted());
  rig.plc.service().keep_up();
  EXPECT_FALSE(rig.plc.controller().faulted());
  EXPECT_EQ(rig.edits(), "E1 (E2)");
  EXPECT_EQ(rig.plc.status().running, rig.digests[1]);
  rig.plc.run(3);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.edits(), "E1 (E2)");
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_EQ(rig.plc.get("a"), "70000");
}

// An edit that is staged meanwhile has no base any more, and its bringer is told.
TEST(Edits, D3_X7_WhatIsPreparedOnTopOfATrapIsGivenUp) {
  EditedPlc rig;
  ASSERT_TRUE(rig.plc.change(edited_source(1, "IF n > 40 THEN z := 1 / z; END_IF")).ok());
  ASSERT_TRUE(rig.plc.stage(plc::build(edited_source(2), &rig.plc.controller().image())).ok());
  EXPECT_EQ(rig.plc.status().change, "prepared");
  EXPECT_EQ(rig.plc.status().edits, 1u);
  rig.plc.run(50);
  EXPECT_TRUE(rig.plc.controller().faulted());
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.edits(), "(E1)");
  EXPECT_EQ(rig.plc.status().running, rig.digests[0]);
  const base::Error told = rig.plc.ask({.command = vm::Command::kSwitch}).error();
  EXPECT_EQ(told.refusal, Refusal::kDeadline);
  EXPECT_NE(told.text.find("the edit below it was undone"), std::string::npos) << told.text;
}

// Whatever call to the disk fails: what is refused has not happened, and undo needs no disk.
TEST(Edits, D3_case56_AnEditThatCannotBeStoredLeavesTheOthers) {
  for (const char* name : {"open", "write", "sync"}) {
    for (int number = 1, reached = 1; reached != 0; ++number) {
      EditedPlc rig;
      rig.change(1);
      rig.change(2);
      int calls = 0;
      reached = 0;
      rig.disk.fails = [&](std::string_view call) {
        if (call != name || ++calls != number) return sim::Failure::kNone;
        reached = 1;
        return sim::Failure::kError;
      };
      const base::Status changed = rig.plc.change(edited_source(3));
      rig.disk.fails = nullptr;
      EXPECT_EQ(rig.plc.status().edits, changed.ok() ? 3u : 2u) << name << number;
      EXPECT_EQ(rig.plc.status().boots_next, rig.digests[0]);
      EXPECT_EQ(rig.boots(), "a 70000, gone 44, r 5") << name << number;
      while (rig.plc.status().edits != 0) ASSERT_TRUE(rig.plc.undo().ok()) << name << number;
      EXPECT_EQ(rig.plc.get("a"), "70000");
      EXPECT_EQ(rig.plc.get("gone"), "44");
      ASSERT_TRUE(rig.plc.save().ok());
      EXPECT_EQ(rig.boots(), "a 70000, gone 44, r 5") << name << number;
    }
  }
}

TEST(Edits, D3_PermanentAcceptsThoseBelowToo) {
  EditedPlc rig;
  rig.change(1);
  ASSERT_TRUE(rig.plc.change(edited_source(2), vm::kAllowLoss | vm::kPermanent).ok());
  EXPECT_EQ(rig.edits(), "");
  EXPECT_EQ(rig.plc.status().boots_next, rig.plc.status().running);
  EXPECT_EQ(rig.plc.store().before()->digest, rig.digests[0]);
}

TEST(Edits, D3_TheJournalNamesThem) {
  EditedPlc rig;
  rig.three_edits();
  ASSERT_TRUE(rig.plc.undo().ok());
  ASSERT_TRUE(rig.accept("E2").ok());
  std::string text;
  for (const auto& entry : rig.plc.store().history()) {
    text += std::string(online_change::event_name(entry.event)) + " " + entry.text + ";";
  }
  EXPECT_NE(text.find("switched edit E3;"), std::string::npos) << text;
  EXPECT_NE(text.find("undone edit E3;"), std::string::npos) << text;
  EXPECT_NE(text.find("accepted edit E1 to E2;"), std::string::npos) << text;
}

}  // namespace
}  // namespace stvm
