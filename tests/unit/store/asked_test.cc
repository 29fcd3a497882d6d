// Whatever is asked of a controller, no scan waits for it: at a boundary bytes are copied, of a
// bounded number, and nothing is allocated, so nothing is formatted; names are found and texts made
// beside the running program. What is counted is the work at boundaries, in virtual time.
#include <gtest/gtest.h>

#include "tests/unit/allocations.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "vm/runtime/live_copy.h"

namespace plc {
namespace {

using Outcome = vm::Boundary::Outcome;
using base::Refusal;
using vm::Command;

constexpr int64_t kMostNs = static_cast<int64_t>(vm::kMaxBoundaryBytes) / vm::kCopyBytesPerNs;

// 64 tasks at 100 us, one of which traps; all kinds of large variables.
std::string source() {
  std::string out =
      "VAR_GLOBAL huge : ARRAY[0..9999999] OF DINT; big : ARRAY[0..199999] OF BOOL; "
      "wide : ARRAY[0..99999] OF DINT; texts : ARRAY[0..19] OF STRING[30000]; a, b : DINT; "
      "zero : DINT; END_VAR "
      "FUNCTION_BLOCK Inner VAR x : INT := 4; s : STRING[9] := 'in'; END_VAR END_FUNCTION_BLOCK "
      "FUNCTION_BLOCK Outer VAR_OUTPUT n : INT := 3; END_VAR VAR list : ARRAY[0..2] OF Inner; "
      "END_VAR END_FUNCTION_BLOCK "
      "PROGRAM P VAR o : ARRAY[1..2] OF Outer; r : REF_TO INT; END_VAR a := a + 1; b := b + 1; "
      "r := REF(o[1].n); END_PROGRAM "
      "PROGRAM Trap VAR n : DINT; END_VAR IF n < 40 THEN n := n + 1; n := n / zero; END_IF "
      "END_PROGRAM PROGRAM Idle END_PROGRAM CONFIGURATION c RESOURCE r ON cpu ";
  const std::string long_name = "_with_a_name_longer_than_a_short_string";
  for (int i = 0; i < 62; ++i) {
    out += "TASK T" + std::to_string(i) + long_name + " (INTERVAL := T#100us, PRIORITY := 3); ";
  }
  out += "TASK Main (INTERVAL := T#100us, PRIORITY := 1); {attribute 'on_trap' := 'go_on'} "
         "TASK Bad (INTERVAL := T#100us, PRIORITY := 2); PROGRAM P WITH Main : P; "
         "PROGRAM Tr WITH Bad : Trap; ";
  for (int i = 0; i < 62; ++i) {
    const std::string name = "T" + std::to_string(i);
    out += "PROGRAM I" + name + " WITH " + name + long_name + " : Idle; ";
  }
  return out + "END_RESOURCE END_CONFIGURATION";
}

// A controller that runs, with what its boundaries do for a request.
class Asked : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(plc_.boot(source()).ok());
    plc_.run(50);
    ASSERT_EQ(plc_.controller().traps().size(), vm::kKeptTraps);
    plc_.at_boundary = [this] {
      ++jobs_;
      before_ns_ = plc_.clock().now_ns();
      before_ = tests::allocations();
      return Outcome::kDone;
    };
    plc_.behind_job = [this] {
      allocated_ += tests::allocations() - before_;
      most_ns_ = std::max(most_ns_, plc_.clock().now_ns() - before_ns_);
    };
  }

  base::Result<base::Bytes> ask(const vm::Request& request) {
    jobs_ = 0;
    most_ns_ = 0;
    allocated_ = 0;
    bool keep_open = true;
    auto answer = vm::decode_answer(plc_.service().answer(vm::encode(request), keep_open));
    return answer;
  }

  // What holds of every request that only reads, and of `set`.
  void expect_bounded(const std::string& what) {
    EXPECT_EQ(allocated_, 0u) << what << " allocates at a boundary";
    EXPECT_LE(most_ns_, kMostNs) << what;
    plc_.run(3);
    EXPECT_EQ(plc_.controller().missed_releases(), 0u) << what;
    for (const vm::TaskStatus& task : plc_.controller().tasks()) {
      ASSERT_EQ(task.delay.max, 0) << what << " delays " << task.name;
    }
  }

  vm::Request get(std::vector<std::string> names) {
    vm::Request request{.command = Command::kGet};
    request.names = std::move(names);
    return request;
  }

  vm::Request set(int count, int stride) {
    const vm::StatusReport now = plc_.status();
    vm::Request request{.command = Command::kSet, .expected = now.running, .edition = now.edition};
    for (int i = 0; i < count; ++i) {
      request.names.push_back("wide[" + std::to_string(i * stride) + "]");
      request.values.push_back("7");
    }
    return request;
  }

  sim::SimStorage disk_;
  Plc plc_{disk_};
  int jobs_ = 0;
  int64_t before_ns_ = 0;
  int64_t most_ns_ = 0;
  uint64_t before_ = 0;     // allocations of this thread when a boundary began
  uint64_t allocated_ = 0;  // at boundaries
};

TEST_F(Asked, StatusAndTimesCopyAFewTasksAtABoundary) {
  auto body = ask({.command = Command::kStatus});
  ASSERT_TRUE(body.ok());
  expect_bounded("status");
  EXPECT_GE(jobs_, 5) << "64 tasks";
  auto status = vm::decode_status(*body);
  ASSERT_TRUE(status.ok());
  ASSERT_EQ(status->tasks.size(), 64u);
  EXPECT_EQ(status->tasks[62].name, "Main");
  EXPECT_EQ(status->tasks[62].period_ns, 100'000);
  EXPECT_GE(status->tasks[62].scans, 50u);
  EXPECT_EQ(status->traps.size(), vm::kKeptTraps);
  body = ask({.command = Command::kTimes, .names = {"main"}});
  ASSERT_TRUE(body.ok());
  expect_bounded("times");
  auto times = vm::decode_task_times(*body);
  ASSERT_TRUE(times.ok());
  EXPECT_EQ(times->name, "Main");
  EXPECT_FALSE(times->delay.empty());
  for (const char* nobody : {"", "Nobody"}) {
    body = ask({.command = Command::kTimes, .names = {nobody}});
    ASSERT_FALSE(body.ok());
    EXPECT_EQ(body.error().refusal, Refusal::kNoSuchTask);
  }
}

TEST_F(Asked, ValuesAreCopiedInPortions) {
  std::vector<std::string> scattered;
  for (int i = 0; i < 4096; ++i) scattered.push_back("wide[" + std::to_string(i * 24) + "]");
  std::vector<std::string> texts;
  for (int i = 0; i < 20; ++i) texts.push_back("texts[" + std::to_string(i) + "]");
  for (const auto& names : {scattered, texts}) {
    auto body = ask(get(names));
    ASSERT_TRUE(body.ok()) << base::to_string(body.error());
    expect_bounded(names[0]);
    EXPECT_GE(jobs_, 2) << names[0];
    auto values = vm::decode_values(*body);
    ASSERT_TRUE(values.ok());
    EXPECT_LT(values->cycle, values->last_cycle) << "each is copied in a cycle with time for it";
    for (const vm::ValueRow& row : values->rows) {
      ASSERT_EQ(row.value, plc_.get(row.path)) << row.path;
    }
  }
  // Its text would be too long: found out beside the running program.
  auto body = ask(get({"big"}));
  ASSERT_FALSE(body.ok());
  EXPECT_EQ(body.error().refusal, Refusal::kTooMany);
  expect_bounded("big");
}

// However the portions fall, a value is of one boundary.
TEST_F(Asked, NoElementaryValueIsOfTwoBoundaries) {
  vm::Controller& controller = plc_.controller();
  const auto wide = ir::find_symbol(controller.image(), "wide");
  ASSERT_TRUE(wide.ok());
  const ir::DataRange range{wide->data, 400'000};
  uint8_t* const data = controller.memory().data() + range.data;
  for (int64_t free_ns = 10'000; free_ns < 10'032; ++free_ns) {
    auto copy = vm::LiveCopy::prepare(controller, {range});
    ASSERT_TRUE(copy.ok());
    int portions = 0;
    for (uint8_t byte = 0; copy->take(controller, free_ns) == vm::Copied::kPart; ++portions) {
      std::memset(data, byte = static_cast<uint8_t>(~byte), range.size);
      plc_.run(1);
    }
    EXPECT_GT(portions, 10);
    for (uint32_t i = 0; i < range.size; i += 4) {
      uint32_t value = 0;
      std::memcpy(&value, copy->memory().data() + range.data + i, sizeof value);
      ASSERT_TRUE(value == 0 || value == UINT32_MAX) << "wide[" << i / 4 << "] = " << value;
    }
  }
}

TEST_F(Asked, AReadBeyondTheLimitIsRefusedBeforeAnyBoundary) {
  static_assert(vm::kMaxReadBytes == 4u << 20);
  using Names = std::vector<std::string>;
  for (const auto& names : {Names{"huge"}, Names(4000, "big")}) {
    auto body = ask(get(names));
    ASSERT_FALSE(body.ok());
    EXPECT_EQ(body.error().refusal, Refusal::kTooMany);
    EXPECT_NE(body.error().text.find("4194304 bytes"), std::string::npos) << body.error().text;
    EXPECT_EQ(jobs_, 0);
  }
}

TEST_F(Asked, ASampleThatFitsIsOfOneBoundary) {
  // Whoever looks at another boundary sees other values.
  const auto count_job = plc_.at_boundary;
  plc_.at_boundary = [&] {
    plc_.run(1);
    return count_job();
  };
  std::vector<std::string> names = {"a"};
  for (int i = 0; i < 2000; ++i) names.push_back("wide[" + std::to_string(i * 24) + "]");
  names.push_back("b");
  auto body = ask(get(names));
  ASSERT_TRUE(body.ok());
  EXPECT_EQ(jobs_, 1);
  auto values = vm::decode_values(*body);
  ASSERT_TRUE(values.ok());
  EXPECT_EQ(values->cycle, values->last_cycle);
  EXPECT_EQ(values->rows.front().value, values->rows.back().value);
  EXPECT_NE(values->rows.front().value, "0");
}

TEST_F(Asked, InstancesAreCopiedWithWhatIsInsideThem) {
  for (const std::string name : {"P", "P.o", "P.o[2]", "P.o[1].list[2]", "P.r", "a"}) {
    auto body = ask(get({name}));
    ASSERT_TRUE(body.ok()) << name;
    expect_bounded(name);
    auto values = vm::decode_values(*body);
    ASSERT_TRUE(values.ok());
    if (name != "a" && name != "P.r") {
      EXPECT_NE(values->rows[0].value.find("x := 4, s := 'in'"), std::string::npos);
    }
    if (name == "a") continue;
    EXPECT_EQ(values->rows[0].value, plc_.get(name));
  }
}

TEST_F(Asked, SetWritesAtOneBoundaryOrIsRefused) {
  // Neighbours are written line by line.
  for (const vm::Request& request : {set(4096, 1), set(2048, 16)}) {
    auto body = ask(request);
    ASSERT_TRUE(body.ok()) << base::to_string(body.error());
    expect_bounded("set");
    EXPECT_EQ(plc_.get(request.names.back()), "7");
  }
  EXPECT_LE(jobs_, 2);
  plc_.set("wide[50000]", "1");
  for (const int count : {2049, 4096}) {
    auto body = ask(set(count, 24));
    ASSERT_FALSE(body.ok()) << count;
    EXPECT_EQ(body.error().refusal, Refusal::kTooMany);
    EXPECT_NE(body.error().text.find("131072 bytes"), std::string::npos) << body.error().text;
    EXPECT_EQ(jobs_, 0);
  }
  EXPECT_EQ(plc_.get("wide[98280]"), "0") << "all or none";
}

// As many names as a request may have: far apart, and in one line of memory.
TEST_F(Asked, ForcesComeAndGoAtOneBoundary) {
  for (const int stride : {24, 1}) {
    vm::Request request = set(4096, stride);
    request.command = Command::kForce;
    auto body = ask(request);
    ASSERT_TRUE(body.ok()) << base::to_string(body.error());
    EXPECT_EQ(jobs_, 1);
    expect_bounded("force");
    EXPECT_EQ(plc_.controller().forces().size(), 4096u);
    ASSERT_TRUE(ask({.command = Command::kForces}).ok());
    EXPECT_EQ(jobs_, 0);
    expect_bounded("forces");
    request.command = Command::kUnforce;
    request.values.clear();
    body = ask(request);
    ASSERT_TRUE(body.ok()) << base::to_string(body.error());
    EXPECT_EQ(jobs_, 1);
    expect_bounded("unforce");
    EXPECT_TRUE(plc_.controller().forces().empty());
  }
}

TEST_F(Asked, PagesOfAnythingElseNeedNoBoundaryOrABoundedCopy) {
  for (const Command command : {Command::kForces, Command::kImage, Command::kJournal,
                                Command::kEvents}) {
    ASSERT_TRUE(ask({.command = command}).ok());
    EXPECT_EQ(jobs_, 0) << vm::command_name(command);
  }
  vm::Request list{.command = Command::kList};
  list.names = {"P.*"};
  ASSERT_TRUE(ask(list).ok());
  EXPECT_EQ(jobs_, 0);
}

// A page looks at so many variables at most, whether they match or not; the next one goes on there.
TEST_F(Asked, PagesOfAListAreBounded) {
  vm::Request list{.command = Command::kList};
  list.names = {"huge[?9999]"};
  std::vector<std::string> found;
  for (int pages = 0; pages < 3; ++pages) {
    auto body = ask(list);
    ASSERT_TRUE(body.ok());
    auto page = vm::decode_values(*body);
    ASSERT_TRUE(page.ok());
    EXPECT_EQ(page->next, list.offset + 100'000);
    for (const vm::ValueRow& row : page->rows) found.push_back(row.path);
    list.offset = page->next;
  }
  EXPECT_EQ(found.size(), 9u);
  EXPECT_EQ(found.front(), "huge[19999]");
  list.offset = 9'999'990;
  list.names = {"*"};
  auto body = ask(list);
  ASSERT_TRUE(body.ok());
  EXPECT_EQ(vm::decode_values(*body)->rows.front().path, "huge[9999990]");
  list.offset = UINT64_MAX;
  body = ask(list);
  ASSERT_TRUE(body.ok());
  EXPECT_TRUE(vm::decode_values(*body)->rows.empty());
  EXPECT_EQ(vm::decode_values(*body)->next, 0u);
}

TEST(AskedOfAChange, ItsReportCopiesDataInPortions) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot("PROGRAM P VAR n : DINT; pad : ARRAY[0..99999] OF DINT; END_VAR n := n + 1; "
                       "END_PROGRAM")
                  .ok());
  plc.run(5);
  const ir::VerifiedImage next =
      build("PROGRAM P VAR n : INT; pad : ARRAY[0..99999] OF DINT; END_VAR n := n + 1; END_PROGRAM",
            &plc.controller().image());
  auto package = online_change::make_package(plc.controller().verified().encoded(), next.encoded());
  ASSERT_TRUE(package.ok());
  vm::Request upload{.command = Command::kUpload};
  upload.data = online_change::encode(*package);
  vm::Request stage{.command = Command::kStage};
  stage.digest = base::sha256(upload.data);
  ASSERT_TRUE(plc.ask(std::move(upload)).ok());
  ASSERT_TRUE(plc.ask(std::move(stage)).ok());
  int64_t before = 0;
  int64_t most = 0;
  uint64_t allocated_before = 0;
  uint64_t allocated = 0;
  int jobs = 0;
  plc.at_boundary = [&] {
    ++jobs;
    before = plc.clock().now_ns();
    allocated_before = tests::allocations();
    return Outcome::kDone;
  };
  plc.behind_job = [&] {
    allocated += tests::allocations() - allocated_before;
    most = std::max(most, plc.clock().now_ns() - before);
  };
  bool keep_open = true;
  auto body = vm::decode_answer(
      plc.service().answer(vm::encode(vm::Request{.command = Command::kFates}), keep_open));
  ASSERT_TRUE(body.ok()) << base::to_string(body.error());
  EXPECT_GE(jobs, 3);
  EXPECT_GT(most, 0);
  EXPECT_LE(most, kMostNs);
  EXPECT_EQ(allocated, 0u);
}

// --- the share of a boundary ---------------------------------------------------------

class Share : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(plc_.boot("PROGRAM P VAR n, z : DINT; END_VAR n := n + 1; "
                                                "IF z = 1 THEN n := n / (z - 1); END_IF "
                                                "END_PROGRAM").ok()); }
  uint64_t bytes(int64_t free_ns, uint64_t left, bool whole) {
    return share_.bytes(plc_.controller(), free_ns, left, whole);
  }
  sim::SimStorage disk_;
  Plc plc_{disk_};
  vm::BoundaryShare share_;
};

TEST_F(Share, IsWhatTheIdleTimeAllows) {
  EXPECT_EQ(bytes(10'000, UINT64_MAX, false), 20'000u);
  EXPECT_EQ(bytes(10'000, 500, false), 500u);
  EXPECT_EQ(bytes(250, 500, false), 500u);
  EXPECT_EQ(bytes(1'000'000, UINT64_MAX, false), vm::kMaxBoundaryBytes);
  EXPECT_EQ(bytes(100, UINT64_MAX, false), 0u) << "this cycle had its share";
}

TEST_F(Share, WithoutIdleTimeIsALittleInEachCycle) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(bytes(-5, UINT64_MAX, false), 0u);
    EXPECT_EQ(bytes(-5, UINT64_MAX, false), 0u);
    plc_.run(1);
    EXPECT_EQ(bytes(-5, UINT64_MAX, false), vm::kLeastBytes);
  }
}

TEST_F(Share, AWholeSampleWaitsForTimeButNotForEver) {
  EXPECT_EQ(bytes(0, vm::kLeastBytes, true), 0u);
  plc_.run(1);
  EXPECT_EQ(bytes(0, vm::kLeastBytes, true), vm::kLeastBytes) << "a little has always time";
  for (int i = 0; i < vm::kPatience; ++i) {
    ASSERT_EQ(bytes(1000, 100'000, true), 0u);
    plc_.run(1);
  }
  EXPECT_EQ(bytes(1000, 100'000, true), 100'000u);
  EXPECT_EQ(bytes(1000, 100'000, true), 0u) << "and waits again";
  EXPECT_EQ(bytes(50'000, 100'000, true), 100'000u);
}

TEST_F(Share, NobodyWaitsBehindAFault) {
  plc_.set("P.z", "1");
  plc_.run(1);
  ASSERT_TRUE(plc_.controller().faulted());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bytes(-5, 100'000, true), 100'000u);
}

TEST_F(Share, WhatWasPreparedForAnotherVersionTouchesNothing) {
  vm::Controller& controller = plc_.controller();
  const vm::NamedValue row{"P.n", "77"};
  auto set = controller.prepare_set({&row, 1});
  ASSERT_TRUE(set.ok());
  auto copy = vm::LiveCopy::prepare(controller, {{64, 8}});
  ASSERT_TRUE(copy.ok());
  vm::TaskCopy tasks(controller, "");
  ASSERT_TRUE(plc_.change("PROGRAM P VAR n, z, more : DINT; END_VAR n := n + 2; END_PROGRAM").ok());
  EXPECT_EQ(copy->take(controller, 1'000'000), vm::Copied::kOtherProgram);
  EXPECT_EQ(tasks.take(controller, 1'000'000), vm::Copied::kOtherProgram);
  EXPECT_FALSE(controller.write(*set));
  EXPECT_NE(plc_.get("P.n"), "77");
}

TEST(LineBytes, CountsEachLineOnce) {
  std::vector<ir::DataRange> ranges = {{130, 4}, {0, 1}, {60, 8}, {128, 8}, {1000, 200}};
  EXPECT_EQ(vm::line_bytes(ranges), (2 + 1 + 4) * 64u);
  ranges.clear();
  EXPECT_EQ(vm::line_bytes(ranges), 0u);
}

}  // namespace
}  // namespace plc
