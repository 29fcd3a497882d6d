// The table of units (D8) and the edits on trial (D3), as a serving controller tells of them.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "base/tool_limits.h"
#include "ir/bytecode/identities.h"
#include "ir/bytecode/image_versions.h"
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

// Of all pages, each of which has one.
std::vector<TrialEdit> every_edit(Plc& plc) {
  std::vector<TrialEdit> all;
  for (uint64_t next = 0;;) {
    vm::Request request{.command = vm::Command::kEdits};
    request.offset = next;
    const base::Result<base::Bytes> body = plc.answer_to(std::move(request));
    base::check(body.ok(), "edits are told");
    const EditPage page = *decode_edit_page(*body);
    all.insert(all.end(), page.edits.begin(), page.edits.end());
    if (page.next == 0) return all;
    next = page.next;
  }
}

ir::Image build_again(const std::string& source) { return plc::build(source).image(); }

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
  const std::string text =
      units_text({{row, "function block", row.name, {1}, true, "E1", row.who, 0}});
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at);
    EXPECT_LE(end - at, 80u) << text;
    at = end + 1;
  }
  EXPECT_NE(text.find("FB    010000000000*  A     before"), std::string::npos) << text;
  EXPECT_NE(text.find("01-01 00:00"), std::string::npos) << text;
  EXPECT_NE(text.find("a_function_block_w.."), std::string::npos) << text;
}

std::string edited_units(const std::vector<UnitView>& units) {
  std::string out;
  for (const UnitView& unit : units) {
    if (unit.edited) out += unit.row.name + " " + unit.edit + " by " + unit.edited_by + " ";
  }
  return out;
}

// Comments are no part of it, an edit that is undone is none, and one that brings back what was
// accepted is none either.
TEST(Units, E06_AUnitHasTheIdentityOfItsSourcesAndSaysWhoEditedIt) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(pumps("1")).ok());
  std::vector<std::vector<ir::Part>> before;  // each change
  const auto change = [&](const std::string& who, const std::string& source) {
    before.push_back(ir::parts_of(plc.controller().image()));
    plc.service().asked_by(who, 2);
    EXPECT_TRUE(plc.change(source).ok());
    plc.run(1);
  };
  const auto look = [&](const std::vector<std::string>& patterns = {}) {
    std::vector<EditStep> steps;
    for (const TrialEdit& edit : every_edit(plc)) {
      if (!edit.undone) steps.push_back({edit, before[steps.size()]});
    }
    return unit_views(page_of(plc).rows, plc.controller().image(), steps, patterns);
  };
  const std::vector<ir::Part> parts = ir::parts_of(build_again(pumps("1") + " (* more *)"));
  for (const UnitView& unit : look()) {
    EXPECT_EQ(unit.content, ir::find_part(parts, ir::PartKind::kUnit, unit.row.name)->identity);
    EXPECT_EQ(unit.kind, unit.row.name == "Main" ? "program" : "function block");
  }
  EXPECT_EQ(edited_units(look()), "");
  change("ann", pumps("2"));
  EXPECT_EQ(edited_units(look()), "Pump E1 by ann ");
  change("bob", pumps("2", "more : INT;"));
  EXPECT_EQ(edited_units(look()), "Pump E1 by ann Main E2 by bob ");
  EXPECT_EQ(look({"P*", "valve"}).size(), 2u);
  change("eve", pumps("1", "more : INT;"));
  EXPECT_EQ(edited_units(look()), "Main E2 by bob ");
  ASSERT_TRUE(plc.undo().ok());
  EXPECT_EQ(edited_units(look()), "Pump E1 by ann Main E2 by bob ");
  ASSERT_TRUE(plc.accept().ok());
  EXPECT_EQ(edited_units(look()), "") << "nothing is on trial";
}

TEST(Units, E06_AControllerSaysWhatItIsAndCanDo) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(pumps("1")).ok());
  base::Result<base::Bytes> body = plc.answer_to({.command = vm::Command::kFacts});
  ASSERT_TRUE(body.ok());
  ControllerFacts facts;
  const base::Result<vm::Values> values = vm::decode_values(*body);
  ASSERT_TRUE(values.ok());
  for (const vm::ValueRow& row : values->rows) facts[row.path] = row.value;
  EXPECT_EQ(facts["version"], "unknown") << "who serves says which";
  EXPECT_EQ(facts["protocol"], std::to_string(vm::kProtocolVersion));
  EXPECT_EQ(facts["last_image_version"], std::to_string(ir::kLastImageVersion));
  EXPECT_EQ(facts["most_edits_on_trial"], std::to_string(base::kMostEditsOnTrial));
  const std::string text = facts_text(facts, plc.status());
  EXPECT_NE(text.find("protocol " + facts["protocol"]), std::string::npos) << text;
  EXPECT_NE(facts_text({}, plc.status()).find("of an older version"), std::string::npos);
}

// The longest names that there are: an edit stays one message, and says how many there were. What
// has another type has both of them in its row.
TEST(Edits, D3_AnEditWithLongNamesIsOneMessage) {
  constexpr size_t kVariables = 300;
  const auto longest = [](const std::string& name) {
    return name + std::string(base::kMaxIdentifier - name.size(), 'x');
  };
  const auto pumps_with = [&](const std::string& type, const std::string& is) {
    std::string variables;
    for (size_t i = 0; i < kVariables; ++i) {
      variables += longest("v" + std::to_string(i) + "_") + " : " + longest(type) + "; ";
    }
    return "TYPE " + longest(type) + " : STRUCT i : " + is + "; END_STRUCT END_TYPE\n" +
           pumps("1", variables);
  };
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(pumps_with("Before", "INT")).ok());
  ASSERT_TRUE(plc.change(pumps_with("After", "DINT")).ok());
  const std::vector<TrialEdit> edits = edits_of(plc);
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].variable_count, kVariables);
  EXPECT_GT(edits[0].variables.size(), 50u);
  EXPECT_LT(edits[0].variables.size(), 200u) << "as many as fit";
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
