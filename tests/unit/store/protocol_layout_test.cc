// The layout of the control channel's messages belongs to a version of the protocol: with another
// one, clients and controllers of different releases misread each other instead of saying so.
#include <gtest/gtest.h>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/fate_message.h"
#include "tools/stvm/unit_message.h"
#include "vm/runtime/protocol.h"

namespace stvm {
namespace {

base::Digest digest(uint8_t first) {
  base::Digest out;
  for (uint8_t& byte : out) byte = first++;
  return out;
}

vm::AreaRoom room(uint64_t first) { return {first, first + 1, first + 2}; }

vm::TimeSummary summary(int64_t first) {
  return {first, first + 1, first + 2, first + 3, first + 4};
}

vm::StatusReport status() {
  vm::StatusReport out;
  out.name = "plant";
  out.running = digest(1);
  out.edition = 2;
  out.change = "trial";
  out.edits = 60;
  out.last_edit_boots = true;
  out.changed_by = "operator";
  out.aborted = "by nobody";
  out.previous = digest(3);
  out.boots_next = digest(4);
  out.trial_lost = digest(5);
  out.alarms = {"alarm"};
  out.cycles = 6;
  out.uptime_ns = 7;
  out.base_period_ns = 8;
  out.faulted = true;
  out.forces = 9;
  out.boundary_forces = 10;
  out.memory = {11, 12, 13, room(14), room(17), room(20)};
  out.pous = 23;
  out.native_pous = 24;
  out.native_bytes = 25;
  out.pous_to_make = 26;
  out.interpreted = {"Main: why"};
  out.tasks = {{"Fast", 27, 28, 29, 30, 31, 32, summary(33), summary(38), true, false, true, 49,
                {vm::TaskState::kSuspended, true, {ir::IoBuffer::kThree, 1, 2, 0, true, false},
                 {ir::IoBuffer::kSwapped, 1, vm::BufferState::kNone, 0, false, true}}}};
  out.traps = {{43, "Slow", {"Pou", "file.st", 44, "text"}}};
  out.devices = {{"rack", "modbus", "online", 45, 46, 47, "none", 48, "writer", 61}};
  return out;
}

FatePage fates() {
  FatePage out;
  out.counts = {1, 2, 3, 4, 5};
  out.predicted_pause_ns = 6;
  out.boundary_bytes = 7;
  out.next = 8;
  FateLine line;
  line.row.fate = online_change::Fate::kConverted;
  line.row.path = "Main.x";
  line.row.old_type = "INT";
  line.row.new_type = "DINT";
  line.row.may_lose = true;
  line.row.reason = "retyped";
  line.row.count = 9;
  line.row.old_path = "Main.w";
  line.live = {"10", "11", "saturates"};
  line.old_address = 51;
  line.new_address = 52;
  out.lines = {line};
  out.loss_count = 12;
  out.losses = {{{"Main.y", "13", "14", "inexact"}}};
  out.edits = {{online_change::PouChange::kInterface, "Pump", 15, "input"}};
  out.system = {{"device", "rack", "new"}};
  return out;
}

UnitPage units() {
  UnitRow row;
  row.name = "Main";
  row.instances = 1;
  row.slot = 1;
  row.unit = digest(2);
  row.other = OtherSlot::kUndone;
  row.other_unit = digest(3);
  row.other_version = digest(4);
  row.cycle = 5;
  row.time_ns = 6;
  row.who = "operator";
  row.event = "undone";
  return {7, {row}};
}

EditPage edits() {
  TrialEdit edit;
  edit.name = "E1";
  edit.undone = true;
  edit.from = digest(1);
  edit.to = digest(2);
  edit.cycle = 3;
  edit.time_ns = 4;
  edit.who = "operator";
  edit.pous = {{{online_change::PouChange::kBody, "Main", 5, "what"}}};
  edit.pou_count = 6;
  edit.types = {{{online_change::TypeChange::kRemoved, "Box"}}};
  edit.type_count = 7;
  edit.variables = {{fates().lines.front().row}};
  edit.variable_count = 8;
  return {9, {edit}};
}

void add(base::Bytes& all, const base::Bytes& message, size_t from = 0) {
  all.insert(all.end(), message.begin() + static_cast<ptrdiff_t>(from), message.end());
}

// Up to the last command that every controller of this version knows. One that came since is
// answered as an unknown one by those that are older, and needs no version of its own.
base::Bytes requests() {
  base::Bytes all;
  for (uint8_t i = 0; i <= static_cast<uint8_t>(vm::Command::kEvents); ++i) {
    add(all,
        vm::encode(vm::Request{.command = static_cast<vm::Command>(i),
                               .expected = digest(1),
                               .edition = 2,
                               .names = {"a", "b"},
                               .values = {"c", "d"},
                               .offset = 3,
                               .data = {4, 5},
                               .digest = digest(6),
                               .flags = 7}),
        1);
  }
  return all;
}

// Without the version itself.
std::string layout() {
  base::Bytes all = requests();
  add(all, vm::encode_answer(base::Bytes{1}), 1);
  add(all, vm::encode_answer(base::Error{base::Refusal::kBusy, "text"}), 1);
  add(all, vm::encode(status()));
  add(all, vm::encode(vm::TaskTimes{"Fast", {{1, 2}}, {{3, 4}}}));
  add(all, vm::encode(vm::Values{1, 2, 3, {{"path", "type", "value"}}}));
  add(all, vm::encode(vm::ForceRows{{{"path", "type", "value", "reason"}}}));
  add(all, vm::encode(vm::ImagePart{digest(1), 2, {3}}));
  add(all, encode(fates()));
  add(all, encode(units()));
  add(all, encode(edits()));
  add(all, encode(online_change::SwitchReport{1, 2, 3, 4, {5, 6, 7, 8, 9}, 10}));
  return base::short_hex(base::sha256(all));
}

struct Version {
  uint8_t number;
  const char* layout;
};
// Those since version 4. One is added, none is edited: controllers that speak it are out there.
constexpr Version kVersions[] = {
    {4, "8ac16b7c3e79"},
    {5, "7f04c328f272"},
    {6, "63e0412d28b5"},
    {7, "538391035e10"},
    {8, "d6cd7073b212"},
    {9, "bd7d362cff72"},
    {10, "3177112f3b76"},
    {11, "0b5d1d5c3b52"},
    {12, "7fc100f9f791"},
};

TEST(ProtocolLayout, BelongsToTheVersion) {
  const Version& last = kVersions[std::size(kVersions) - 1];
  EXPECT_EQ(last.number, vm::kProtocolVersion);
  EXPECT_EQ(last.layout, layout())
      << "messages are laid out otherwise than in version " << int{last.number}
      << ": raise kProtocolVersion and add a line here";
  for (size_t i = 1; i < std::size(kVersions); ++i) {
    EXPECT_EQ(kVersions[i].number, kVersions[i - 1].number + 1);
    EXPECT_STRNE(kVersions[i].layout, kVersions[i - 1].layout);
  }
}

// The answer is one that the client understands.
TEST(ProtocolLayout, AClientOfAnotherVersionIsToldSo) {
  sim::SimStorage disk;
  plc::Plc plc(disk);
  ASSERT_TRUE(plc.boot("PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM").ok());
  base::Bytes request = vm::encode(vm::Request{.command = vm::Command::kStatus});
  request[0] = vm::kProtocolVersion - 1;
  bool keep_open = true;
  base::Bytes answer = plc.service().answer(request, keep_open);
  EXPECT_FALSE(keep_open);
  ASSERT_FALSE(answer.empty());
  EXPECT_EQ(answer[0], vm::kProtocolVersion - 1);
  answer[0] = vm::kProtocolVersion;
  const auto told = vm::decode_answer(answer);
  ASSERT_FALSE(told.ok());
  EXPECT_NE(told.error().text.find("start the controller again"), std::string::npos);
}

}  // namespace
}  // namespace stvm
