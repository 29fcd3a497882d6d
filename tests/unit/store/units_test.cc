// The table of units (D8) and the edits on trial (D3), as a serving controller tells of them.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/units.h"

namespace stvm {
namespace {

using plc::Plc;

std::string pumps(const std::string& step, const std::string& declare = {}) {
  return "FUNCTION_BLOCK Pump VAR n : DINT; END_VAR n := n + " + step +
         "; END_FUNCTION_BLOCK\n"
         "FUNCTION_BLOCK Valve VAR n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK\n"
         "PROGRAM Main VAR a : ARRAY[1..3] OF Pump; v : Valve; " +
         declare + " END_VAR a[1](); v(); END_PROGRAM";
}

UnitPage page_of(Plc& plc, uint64_t offset = 0) {
  vm::Request request{.command = vm::Command::kUnits};
  request.offset = offset;
  base::Result<base::Bytes> body = plc.answer_to(std::move(request));
  base::check(body.ok(), "units are told");
  return *decode_unit_page(*body);
}

UnitRow unit(Plc& plc, const std::string& name) {
  for (const UnitRow& row : page_of(plc).rows) {
    if (row.name == name) return row;
  }
  ADD_FAILURE() << "no unit " << name;
  return {};
}

std::vector<TrialEdit> edits_of(Plc& plc) {
  base::Result<base::Bytes> body = plc.answer_to({.command = vm::Command::kEdits});
  base::check(body.ok(), "edits are told");
  return decode_edit_page(*body)->edits;
}

base::Digest identity(Plc& plc, const std::string& name) {
  for (const ir::LinkedPou& pou : plc.controller().image().pous) {
    if (pou.name == name) return pou.identity;
  }
  return {};
}

struct PumpPlc {
  PumpPlc() : plc(disk) {
    EXPECT_TRUE(plc.boot(pumps("1")).ok());
    plc.run(5);
  }
  sim::SimStorage disk;
  Plc plc;
};

TEST(Units, D8_AtTheStartAllIsInSlotA) {
  PumpPlc rig;
  const UnitRow pump = unit(rig.plc, "Pump");
  EXPECT_EQ(pump.slot, 0);
  EXPECT_EQ(pump.other, OtherSlot::kEmpty);
  EXPECT_EQ(pump.instances, 3u);
  EXPECT_EQ(pump.unit, identity(rig.plc, "Pump"));
  EXPECT_EQ(pump.event, "started");
}

TEST(Units, D8_AChangeOfOneUnitExchangesItsSlotsAndNoOther) {
  PumpPlc rig;
  const base::Digest before = identity(rig.plc, "Pump");
  ASSERT_TRUE(rig.plc.change(pumps("2")).ok());
  rig.plc.run(3);
  const UnitRow pump = unit(rig.plc, "Pump");
  EXPECT_EQ(pump.slot, 1);
  EXPECT_EQ(pump.other, OtherSlot::kBefore);
  EXPECT_EQ(base::short_hex(pump.other_unit), base::short_hex(before));
  EXPECT_EQ(pump.event, "switched");
  EXPECT_EQ(pump.who, "tester");
  EXPECT_EQ(pump.cycle, 6u);
  EXPECT_EQ(pump.time_ns, 2);
  const UnitRow valve = unit(rig.plc, "Valve");
  EXPECT_EQ(valve.slot, 0);
  EXPECT_EQ(valve.other, OtherSlot::kEmpty);
  EXPECT_EQ(valve.event, "started");
}

TEST(Units, D8_UndoGoesBackAndWhatWasUndoneLiesInTheOtherSlot) {
  PumpPlc rig;
  ASSERT_TRUE(rig.plc.change(pumps("2")).ok());
  const base::Digest undone = identity(rig.plc, "Pump");
  rig.plc.run(3);
  ASSERT_TRUE(rig.plc.undo().ok());
  const UnitRow pump = unit(rig.plc, "Pump");
  EXPECT_EQ(pump.slot, 0);
  EXPECT_EQ(pump.other, OtherSlot::kUndone);
  EXPECT_EQ(base::short_hex(pump.other_unit), base::short_hex(undone));
  EXPECT_EQ(pump.event, "undone");
  EXPECT_EQ(pump.unit, identity(rig.plc, "Pump"));
}

TEST(Units, D8_AcceptExchangesNothing) {
  PumpPlc rig;
  ASSERT_TRUE(rig.plc.change(pumps("2")).ok());
  ASSERT_TRUE(rig.plc.accept().ok());
  const UnitRow pump = unit(rig.plc, "Pump");
  EXPECT_EQ(pump.slot, 1);
  EXPECT_EQ(pump.other, OtherSlot::kBefore);
  EXPECT_EQ(pump.event, "switched");
}

TEST(Units, D8_ARestartPlacesAllCodeAnew) {
  PumpPlc rig;
  ASSERT_TRUE(rig.plc.change(pumps("2")).ok());
  ASSERT_TRUE(rig.plc.accept().ok());
  const base::Digest accepted = identity(rig.plc, "Pump");
  ASSERT_TRUE(rig.plc.boot().ok());
  const UnitRow pump = unit(rig.plc, "Pump");
  EXPECT_EQ(pump.slot, 0);
  EXPECT_EQ(pump.other, OtherSlot::kEmpty);
  EXPECT_EQ(pump.unit, accepted);
  EXPECT_EQ(pump.event, "started");
}

TEST(Units, D8_WhatIsStagedIsToldAndWhatWasGivenUpToo) {
  PumpPlc rig;
  ASSERT_TRUE(rig.plc.stage(plc::build(pumps("2"), &rig.plc.controller().image())).ok());
  EXPECT_EQ(unit(rig.plc, "Pump").other, OtherSlot::kStaged);
  EXPECT_EQ(unit(rig.plc, "Pump").slot, 0);
  ASSERT_TRUE(rig.plc.ask(vm::Command::kCancel).ok());
  EXPECT_EQ(unit(rig.plc, "Pump").other, OtherSlot::kLeft);
  // What ran before lies there no more, so it is not told as that.
  ASSERT_TRUE(rig.plc.change(pumps("2")).ok());
  ASSERT_TRUE(rig.plc.accept().ok());
  ASSERT_TRUE(rig.plc.stage(plc::build(pumps("3"), &rig.plc.controller().image())).ok());
  ASSERT_TRUE(rig.plc.ask(vm::Command::kCancel).ok());
  EXPECT_EQ(unit(rig.plc, "Pump").other, OtherSlot::kLeft);
}

// Nothing of it needs a boundary, so no scan waits, however many units there are.
TEST(Units, D8_APageIsBoundedAndNoScanWaitsForIt) {
  std::string many;
  for (int i = 0; i < 6000; ++i) {
    many += "FUNCTION F" + std::to_string(i) + " : INT F" + std::to_string(i) +
            " := 1; END_FUNCTION\n";
  }
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(many + pumps("1")).ok());
  int boundaries = 0;
  uint64_t next = 0;
  size_t rows = 0;
  int pages = 0;
  do {
    vm::Request request{.command = vm::Command::kUnits};
    request.offset = next;
    bool keep_open = true;
    plc.at_boundary = [&] { return ++boundaries, vm::Boundary::Outcome::kDone; };
    const auto body = vm::decode_answer(plc.service().answer(vm::encode(request), keep_open));
    ASSERT_TRUE(body.ok());
    EXPECT_LE(body->size(), vm::kMaxMessageBytes);
    const UnitPage page = *decode_unit_page(*body);
    EXPECT_TRUE(page.next == 0 || page.next > next);
    next = page.next;
    rows += page.rows.size();
    ++pages;
  } while (next != 0);
  EXPECT_EQ(rows, 6003u);
  EXPECT_GT(pages, 1);
  EXPECT_EQ(boundaries, 0);
}

TEST(Units, D8_ARowFitsEightyColumns) {
  UnitRow row;
  row.name = "a_function_block_whose_name_is_longer_than_anybody_would_like_to_type";
  row.instances = 1'000'000;
  row.other = OtherSlot::kBefore;
  row.cycle = 123'456'789;
  row.who = "somebody.with.a.long.name";
  const std::string text = units_text({row});
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at);
    EXPECT_LE(end - at, 80u) << text;
    at = end + 1;
  }
  EXPECT_NE(text.find("00000000 before"), std::string::npos) << text;
  EXPECT_NE(text.find("01-01 00:00"), std::string::npos) << text;
  EXPECT_NE(text.find("a_function.."), std::string::npos) << text;
}

// The longest names that there are: an edit stays one message, and says how many there were.
TEST(Edits, D3_AnEditWithLongNamesIsOneMessage) {
  PumpPlc rig;
  constexpr size_t kVariables = 300;
  std::string variables;
  for (size_t i = 0; i < kVariables; ++i) {
    const std::string number = std::to_string(i);
    const size_t left = base::kMaxIdentifier - 1 - number.size();
    variables += "v" + number + std::string(left, 'x') + " : INT; ";
  }
  ASSERT_TRUE(rig.plc.change(pumps("2", variables.c_str())).ok());
  const std::vector<TrialEdit> edits = edits_of(rig.plc);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].variable_count, kVariables);
  EXPECT_GT(edits[0].variables.size(), 50u);
  EXPECT_LT(encode(EditPage{0, edits}).size(), vm::kMaxMessageBytes / 4);
}

TEST(Edits, D3_AnEditIsListedWithWhatItTouchesUntilItIsUndoneOrAccepted) {
  PumpPlc rig;
  EXPECT_TRUE(edits_of(rig.plc).empty());
  const std::string with_box =
      "TYPE Box : STRUCT i : INT; END_STRUCT END_TYPE\n" + pumps("2", "box : Box;");
  ASSERT_TRUE(rig.plc.change(with_box).ok());
  const std::vector<TrialEdit> edits = edits_of(rig.plc);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].name, "E1");
  EXPECT_EQ(edits[0].who, "tester");
  EXPECT_EQ(edits[0].to, rig.plc.controller().verified().digest());
  EXPECT_EQ(edits[0].pou_count, 1u);
  EXPECT_EQ(edits[0].pous[0].pou, "Pump");
  ASSERT_EQ(edits[0].types.size(), 1u);
  EXPECT_EQ(edits[0].types[0].type, "Box");
  ASSERT_EQ(edits[0].variables.size(), 1u);
  EXPECT_EQ(edits[0].variables[0].path, "Main.box");
  EXPECT_FALSE(edits[0].undone);
  ASSERT_TRUE(rig.plc.undo().ok());
  ASSERT_EQ(edits_of(rig.plc).size(), 1u);
  EXPECT_TRUE(edits_of(rig.plc)[0].undone);
  ASSERT_TRUE(rig.plc.change(pumps("3")).ok());
  ASSERT_EQ(edits_of(rig.plc).size(), 1u);
  EXPECT_EQ(edits_of(rig.plc)[0].name, "E2");  // a name is used once
  ASSERT_TRUE(rig.plc.accept().ok());
  EXPECT_TRUE(edits_of(rig.plc).empty());
}

}  // namespace
}  // namespace stvm
