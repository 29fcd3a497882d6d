// The layout of the control channel's messages belongs to a version of the protocol, and clients
// and controllers of neighbouring releases understand each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/unit/store/old_messages.h"
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

// As a controller that speaks `version` says it.
vm::StatusReport status(uint8_t version) {
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
  out.tasks = {{"Fast",
                27,
                28,
                29,
                30,
                31,
                32,
                summary(33),
                summary(38),
                true,
                false,
                true,
                49,
                {vm::TaskState::kSuspended,
                 true,
                 {ir::IoBuffer::kThree, 1, 2, 0, true, false},
                 {ir::IoBuffer::kSwapped, 1, vm::BufferState::kNone, 0, false, true}}}};
  out.traps = {{43, "Slow", {"Pou", "file.st", 44, "text"}}};
  out.devices = {{"rack", "modbus", "online", 45, 46, 47, "none", 48, "writer", 61}};
  if (version < 14) return out;
  out.watched_by = "plan 1";
  out.watch_left_ns = 62;
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
  edit.pous = {{online_change::PouChange::kBody, "Main", 5, "what"}};
  edit.pou_count = 6;
  edit.types = {{online_change::TypeChange::kRemoved, "Box"}};
  edit.type_count = 7;
  edit.variables = {fates().lines.front().row};
  edit.variable_count = 8;
  return {9, {edit}};
}

// One of each kind. `layout` is written by hand: 1, 4, 8 a number of so many bytes, d a digest, t a
// text or bytes, [t] texts, {} rows. `again`: decoded and encoded.
struct Message {
  const char* name;
  const char* layout;
  base::Bytes bytes;
  std::function<base::Bytes(base::ByteSpan)> again;
};

template <class T>
std::function<base::Bytes(base::ByteSpan)> through(base::Result<T> (*decode)(base::ByteSpan)) {
  return [decode](base::ByteSpan bytes) {
    const base::Result<T> message = decode(bytes);
    return message.ok() ? encode(*message) : base::Bytes{};
  };
}

std::vector<Message> messages(uint8_t version = vm::kProtocolVersion) {
  return {
      {"status",
       "td8t81ttddd[t]8881888888888888888888[t]{t848888888888888811184}{8ttt4t}{ttt888t8t8}t8",
       vm::encode(status(version)), through(vm::decode_status)},
      {"times", "t{88}{88}", vm::encode(vm::TaskTimes{"Fast", {{1, 2}}, {{3, 4}}}),
       through(vm::decode_task_times)},
      {"values", "888{ttt}", vm::encode(vm::Values{1, 2, 3, {{"path", "type", "value"}}}),
       through(vm::decode_values)},
      {"forces", "{tttt}", vm::encode(vm::ForceRows{{{"path", "type", "value", "reason"}}}),
       through(vm::decode_forces)},
      {"image", "d8t", vm::encode(vm::ImagePart{digest(1), 2, {3}}),
       through(vm::decode_image_part)},
      {"staged", "8", vm::encode(vm::StagedAnswer{1}), through(vm::decode_staged_answer)},
      {"abort", "1t", vm::encode(vm::AbortAnswer{true, "text"}), through(vm::decode_abort_answer)},
      {"fates", "88888888{1ttt1t8tttt44}8{tttt}{1t8t}{ttt}", encode(fates()),
       through(decode_fate_page)},
      {"units", "8{t81d1dd88tt}", encode(units()), through(decode_unit_page)},
      {"edits", "8{t1dd88t{1t8t}8{1t}8{1tttt8}8}", encode(edits()), through(decode_edit_page)},
      {"switch", "8888888888", encode(online_change::SwitchReport{1, 2, 3, 4, {5, 6, 7, 8, 9}, 10}),
       through(decode_switch_report)},
  };
}

const char* after_rows(const char* layout) {
  for (int depth = 1; depth != 0; ++layout) depth += *layout == '{' ? 1 : *layout == '}' ? -1 : 0;
  return layout;
}

// The fields of `in` and, as a newer sender would, `extra` after those of the message and of each
// row.
void grow(const char* layout, base::ByteReader& in, const base::Bytes& extra,
          base::ByteWriter& out) {
  for (; *layout != '\0' && *layout != '}'; ++layout) {
    if (*layout == 'd') {
      out.raw(in.raw(32));
    } else if (*layout == 't') {
      out.blob(in.blob());
    } else if (*layout == '[') {
      uint32_t count = in.u32();
      for (out.u32(count); count != 0; --count) out.blob(in.blob());
      layout += 2;
    } else if (*layout == '{') {
      uint32_t count = in.u32();
      for (out.u32(count); count != 0; --count) {
        base::ByteReader row(in.blob());
        base::ByteWriter grown;
        grow(layout + 1, row, extra, grown);
        out.blob(grown.bytes());
      }
      layout = after_rows(layout + 1) - 1;
    } else {
      out.raw(in.raw(static_cast<size_t>(*layout - '0')));
    }
  }
  EXPECT_TRUE(in.done()) << layout;
  out.raw(extra);
}

base::Bytes grown(const Message& message, const base::Bytes& extra) {
  base::ByteReader in(message.bytes);
  base::ByteWriter out;
  grow(message.layout, in, extra, out);
  return out.take();
}

std::string hex(base::ByteSpan bytes) {
  std::string out;
  for (const uint8_t byte : bytes) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

base::Bytes from_hex(std::string_view text) {
  base::Bytes out;
  for (size_t i = 0; i + 1 < text.size(); i += 2) {
    out.push_back(static_cast<uint8_t>(std::stoul(std::string(text.substr(i, 2)), nullptr, 16)));
  }
  return out;
}

vm::Request request(uint8_t command) {
  return {.command = static_cast<vm::Command>(command),
          .expected = digest(1),
          .edition = 2,
          .names = {"a", "b"},
          .values = {"c", "d"},
          .offset = 3,
          .data = {4, 5},
          .digest = digest(6),
          .flags = 7};
}

std::string layout() {
  base::Bytes all = vm::encode_answer(base::Error{base::Refusal::kBusy, "text"});
  for (const Message& message : messages()) {
    all.insert(all.end(), message.bytes.begin(), message.bytes.end());
  }
  all.erase(all.begin());  // the version itself
  return base::short_hex(base::sha256(all));
}

struct Version {
  uint8_t number;
  const char* layout;
};
// Those since version 4. One is added, none is edited: controllers that speak it are out there. Up
// to version 12 requests are part of it.
constexpr Version kVersions[] = {
    {4, "8ac16b7c3e79"},  {5, "7f04c328f272"},  {6, "63e0412d28b5"},  {7, "538391035e10"},
    {8, "d6cd7073b212"},  {9, "bd7d362cff72"},  {10, "3177112f3b76"}, {11, "0b5d1d5c3b52"},
    {12, "7fc100f9f791"}, {13, "4790d697d4d6"}, {14, "ab75c2d0a31c"},
};

TEST(ProtocolLayout, BelongsToTheVersion) {
  const Version& last = kVersions[std::size(kVersions) - 1];
  EXPECT_EQ(last.number, vm::kProtocolVersion);
  EXPECT_EQ(last.layout, layout())
      << "messages are laid out otherwise than in version " << int{last.number}
      << ": raise kProtocolVersion, add a line here, and the messages as they are to "
         "old_messages.h";
  for (size_t i = 1; i < std::size(kVersions); ++i) {
    EXPECT_EQ(kVersions[i].number, kVersions[i - 1].number + 1);
    EXPECT_STRNE(kVersions[i].layout, kVersions[i - 1].layout);
  }
}

// Each message of each version that is still spoken.
TEST(ProtocolLayout, AnswersOfOlderControllersAreUnderstood) {
  for (const OldMessage& old : kOldAnswers) {
    ASSERT_GE(old.version, vm::kOldestAnswer);
    const auto all = messages(old.version);
    const auto now = std::find_if(all.begin(), all.end(), [&](const Message& message) {
      return std::string_view(message.name) == old.name;
    });
    ASSERT_NE(now, all.end()) << old.name;
    EXPECT_EQ(hex(now->again(from_hex(old.hex))), hex(now->bytes))
        << old.name << " of version " << int{old.version};
  }
  for (const Message& message : messages()) {
    std::string newest;
    for (const OldMessage& old : kOldAnswers) {
      if (std::string_view(message.name) == old.name) newest = old.hex;
    }
    EXPECT_EQ(hex(message.bytes), newest) << message.name << " has grown: add a row as it is now";
  }
}

TEST(ProtocolLayout, AnswersOfNewerControllersAreUnderstood) {
  for (const Message& message : messages()) {
    ASSERT_EQ(hex(message.again(message.bytes)), hex(message.bytes)) << message.name;
    EXPECT_EQ(hex(message.again(grown(message, {1, 2, 3}))), hex(message.bytes)) << message.name;
    // What is missing of the fields that every version has is damage.
    const base::ByteSpan less(message.bytes.data(), message.bytes.size() - 1);
    EXPECT_TRUE(message.again(less).empty()) << message.name;
  }
  base::Bytes answer = vm::encode_answer(base::Bytes{1});
  answer[0] = vm::kProtocolVersion + 1;
  EXPECT_TRUE(vm::decode_answer(answer).ok());
  answer[0] = vm::kOldestAnswer - 1;
  EXPECT_FALSE(vm::decode_answer(answer).ok());
}

// A refusal that only a newer controller knows is shown with its code.
TEST(ProtocolLayout, ARefusalOfANewerControllerIsShown) {
  base::Bytes answer = vm::encode_answer(base::Error{base::Refusal::kBusy, "text"});
  answer[0] = vm::kProtocolVersion + 1;
  const std::string code = base::refusal_code(base::Refusal::kBusy);
  std::copy_n("R0999", code.size(), answer.begin() + 6);
  const auto told = vm::decode_answer(answer);
  ASSERT_FALSE(told.ok());
  EXPECT_EQ(told.error().text, "R0999: text");
}

// Recordings hold them too. Each command has one; a command that is added has a row here.
TEST(ProtocolLayout, RequestsStayAsTheyAre) {
  ASSERT_EQ(std::size(kOldRequests), size_t{vm::kCommandCount});
  for (uint8_t i = 0; i < vm::kCommandCount; ++i) {
    const base::Bytes old = from_hex(kOldRequests[i]);
    const auto decoded = vm::decode_request(old);
    ASSERT_TRUE(decoded.ok()) << int{i};
    base::Bytes now = vm::encode(request(i));
    EXPECT_EQ(hex(vm::encode(*decoded)), hex(now)) << int{i};
    EXPECT_EQ(now[0], vm::kProtocolVersion);
    now[0] = old[0];
    EXPECT_EQ(hex(now), hex(old)) << int{i};
  }
}

// What a newer client asks for is done as it is meant, or refused.
TEST(ProtocolLayout, RequestsOfNewerClients) {
  for (uint8_t i = 0; i < vm::kCommandCount; ++i) {
    base::Bytes bytes = vm::encode(request(i));
    bytes.push_back(0);
    EXPECT_FALSE(vm::decode_request(bytes).ok()) << "damaged: " << int{i};
    bytes[0] = vm::kProtocolVersion + 1;
    EXPECT_TRUE(vm::decode_request(bytes).ok()) << int{i};
    bytes.back() = 1;
    const auto told = vm::decode_request(bytes);
    ASSERT_FALSE(told.ok()) << int{i};
    EXPECT_NE(told.error().text.find("newer controller"), std::string::npos);
  }
  for (const vm::Command command : {vm::Command::kStage, vm::Command::kSwitch}) {
    vm::Request unknown{.command = command};
    for (unsigned bit = 0; bit < 32; ++bit) {
      unknown.flags = 1u << bit;
      const uint32_t known =
          command == vm::Command::kStage ? vm::kAllStageFlags : vm::kAllSwitchFlags;
      EXPECT_EQ(vm::decode_request(vm::encode(unknown)).ok(), (known & unknown.flags) != 0) << bit;
    }
  }
  base::Bytes command = vm::encode(request(0));
  command[1] = vm::kCommandCount;
  EXPECT_FALSE(vm::decode_request(command).ok());
}

// The answer is one that the client understands.
TEST(ProtocolLayout, AClientOfAnotherVersionIsToldSo) {
  sim::SimStorage disk;
  plc::Plc plc(disk);
  ASSERT_TRUE(plc.boot("PROGRAM P VAR n : INT; END_VAR n := n + 1; END_PROGRAM").ok());
  base::Bytes asked = vm::encode(vm::Request{.command = vm::Command::kStatus});
  asked[0] = vm::kOldestRequest - 1;
  bool keep_open = true;
  base::Bytes answer = plc.service().answer(asked, keep_open);
  EXPECT_FALSE(keep_open);
  ASSERT_FALSE(answer.empty());
  EXPECT_EQ(answer[0], vm::kOldestRequest - 1);
  answer[0] = vm::kProtocolVersion;
  const auto told = vm::decode_answer(answer);
  ASSERT_FALSE(told.ok());
  EXPECT_NE(told.error().text.find("start the controller again"), std::string::npos);
}

}  // namespace
}  // namespace stvm
