// B11: what tasks and their buffers do is told at each moment and can be read at any time; scans
// last as long as a virtual clock says.
#include <atomic>
#include <thread>

#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

using vm::Moment;
using vm::TaskState;

const char* name_of(Moment moment) {
  constexpr const char* kNames[] = {"cycle", "received", "sent",    "released", "missed",   "begun",
                                    "suspended", "resumed", "ended", "trapped", "inputs", "outputs"};
  return kNames[static_cast<size_t>(moment)];
}

// A controller whose moments become text, with the states of all tasks at each of them.
class Observed : public vm::Timeline {
 public:
  void start(const std::string& source) {
    auto image = build(source);
    if (!image) return;
    vm::ControllerOptions options;
    options.timeline = this;
    auto started = vm::Controller::start(*image, options, clock, io);
    ASSERT_TRUE(started.ok());
    controller = std::move(*started);
  }
  void note(Moment moment, std::string_view task, int64_t at_ns) override {
    if (controller == nullptr) return;
    const bool exchange = moment == Moment::kReceived || moment == Moment::kSent ||
                          moment == Moment::kCycle || moment == Moment::kReleased;
    if (moment == Moment::kInputsOf) inputs.emplace_back(task, at_ns / kMs);
    if (moment == Moment::kOutputsOf) outputs.emplace_back(task, at_ns / kMs);
    if (exchange || moment == Moment::kInputsOf || moment == Moment::kOutputsOf) return;
    text += std::to_string(at_ns / kMs) + " " + std::string(task) + " " + name_of(moment);
    for (size_t i = 0; i < controller->image().tasks.size(); ++i) {
      text += std::string(i == 0 ? ": " : ", ") + vm::state_text(activity(i).state) +
              (activity(i).late ? " (late)" : "");
    }
    text += "\n";
  }
  vm::TaskActivity activity(size_t task) const {
    auto found = controller->activity(task, controller->generation().number());
    EXPECT_TRUE(found.has_value());
    return found.value_or(vm::TaskActivity{});
  }
  std::string cycles(int count) {
    text.clear();
    for (int i = 0; i < count; ++i) controller->cycle();
    return text;
  }

  vm::VirtualClock clock;
  vm::SimulatedIo io;
  std::unique_ptr<vm::Controller> controller;
  std::string text;
  std::vector<std::pair<std::string, int64_t>> inputs;  // of which task, received when
  std::vector<std::pair<std::string, int64_t>> outputs;
};

std::string two_tasks(const std::string& of_slow = "", const std::string& interval = "T#40ms") {
  return R"(
PROGRAM Copy VAR a AT %IB0 : BYTE; q AT %QB0 : BYTE; END_VAR q := a; END_PROGRAM
PROGRAM Copy2 VAR a AT %IB1 : BYTE; q AT %QB1 : BYTE; END_VAR q := a; END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 1);
  )" + of_slow +
         " TASK Slow (INTERVAL := " + interval + R"(, PRIORITY := 2);
  PROGRAM f WITH Fast : Copy; PROGRAM s WITH Slow : Copy2;
END_RESOURCE END_CONFIGURATION
)";
}

TEST(Activity, B1_B11_EachStateIsShownWhileItLasts) {
  Observed seen;
  seen.clock.let_scans_last("FAST", 3 * kMs);
  seen.clock.let_scans_last("Slow", 12 * kMs);
  seen.start(two_tasks());
  ASSERT_TRUE(seen.controller);
  EXPECT_EQ(seen.activity(1).state, TaskState::kWaiting);
  EXPECT_EQ(seen.cycles(2),
            "0 Fast begun: running, due\n"
            "3 Fast ended: running, due\n"
            "3 Slow begun: waiting, running\n"
            "10 Slow suspended: due, suspended\n"
            "10 Fast begun: running, suspended\n"
            "13 Fast ended: running, suspended\n"
            "13 Slow resumed: waiting, running\n"
            "18 Slow ended: waiting, running\n");
  EXPECT_EQ(seen.activity(1).state, TaskState::kWaiting);
  EXPECT_EQ(seen.clock.now_ns(), 18 * kMs);
}

// Late while its scan goes on, and behind it until the next one begins.
TEST(Activity, B7_B11_AScanThatEndsLate) {
  Observed seen;
  seen.clock.let_scans_last("Slow", 25 * kMs);
  seen.start(two_tasks("", "T#20ms"));
  ASSERT_TRUE(seen.controller);
  seen.cycles(2);
  EXPECT_FALSE(seen.activity(1).late);
  EXPECT_EQ(seen.cycles(1),
            "20 Slow missed: due, running (late)\n"
            "20 Slow suspended: due, suspended (late)\n"
            "20 Fast begun: running, suspended (late)\n"
            "20 Fast ended: running, suspended (late)\n"
            "20 Slow resumed: waiting, running (late)\n"
            "25 Slow ended: waiting, running (late)\n");
  EXPECT_EQ(seen.activity(1).state, TaskState::kEndedLate);
  EXPECT_EQ(seen.cycles(1),
            "30 Fast begun: running, ended late (late)\n"
            "30 Fast ended: running, ended late (late)\n");
  seen.cycles(1);
  EXPECT_FALSE(seen.activity(1).late);
  const vm::TaskStatus slow = seen.controller->tasks()[1];
  EXPECT_EQ(slow.missed, 1u);
  EXPECT_EQ(slow.run.max, 25 * kMs);
}

// A watchdog ends a scan that is said to last too long, at its limit.
TEST(Activity, B11_TheWatchdogHoldsForSaidDurations) {
  Observed seen;
  seen.clock.let_scans_last("Slow", 100 * kMs);
  seen.start(two_tasks("{attribute 'watchdog' := 'T#15ms'} {attribute 'on_trap' := 'stop_task'}"));
  ASSERT_TRUE(seen.controller);
  seen.cycles(2);
  EXPECT_NE(seen.text.find("15 Slow trapped"), std::string::npos) << seen.text;
  EXPECT_EQ(seen.activity(1).state, TaskState::kStopped);
  EXPECT_EQ(seen.activity(0).state, TaskState::kWaiting);
}

// B6 by what is told: inputs of the first cycle of the period, outputs in the first of the next one.
TEST(Activity, B6_B11_WhichInputsAndOutputsAreOfWhichScan) {
  for (const bool synchronous : {false, true}) {
    Observed seen;
    seen.clock.let_scans_last("Fast", 6 * kMs);
    seen.clock.let_scans_last("Slow", 6 * kMs);
    seen.start(two_tasks(synchronous ? "{attribute 'io' := 'synchronous'}" : ""));
    ASSERT_TRUE(seen.controller);
    seen.cycles(10);
    std::vector<int64_t> received, sent;
    for (const auto& [task, ms] : seen.inputs) {
      if (task == "Slow") received.push_back(ms);
    }
    for (const auto& [task, ms] : seen.outputs) {
      if (task == "Slow") sent.push_back(ms);
    }
    EXPECT_EQ(received, (std::vector<int64_t>{0, 40, 80}));
    EXPECT_EQ(sent, synchronous ? (std::vector<int64_t>{40, 80}) : (std::vector<int64_t>{20, 60}));
  }
}

// Three buffers change places; what came in since is fresh until a scan begins.
TEST(Activity, B4_B11_WhichBufferIsWithWhom) {
  Observed seen;
  seen.clock.let_scans_last("Slow", 12 * kMs);
  seen.start(two_tasks("{attribute 'input_buffer' := 'three'}"));
  ASSERT_TRUE(seen.controller);
  seen.cycles(1);
  const vm::BufferState first = seen.activity(1).inputs;
  EXPECT_EQ(first.kind, ir::IoBuffer::kThree);
  EXPECT_FALSE(first.fresh);
  EXPECT_TRUE(first.locked);
  seen.cycles(1);
  const vm::BufferState ended = seen.activity(1).inputs;
  EXPECT_TRUE(ended.fresh);
  EXPECT_FALSE(ended.locked);
  EXPECT_EQ(ended.reader, first.reader);
  EXPECT_EQ(ended.waiting, first.writer);
  EXPECT_EQ(ended.writer, first.waiting);
  seen.cycles(3);
  const vm::BufferState next = seen.activity(1).inputs;
  EXPECT_FALSE(next.fresh);
  EXPECT_EQ(next.writer + next.waiting + next.reader, 0 + 1 + 2);
  EXPECT_NE(next.reader, ended.reader);
  EXPECT_EQ(seen.activity(0).inputs.waiting, vm::BufferState::kNone);
}

// Outputs are fresh from the end of the scan until they are sent.
TEST(Activity, B5_B11_OutputsThatAreNotSentYet) {
  Observed seen;
  seen.start(two_tasks("{attribute 'io' := 'synchronous'}"));
  ASSERT_TRUE(seen.controller);
  EXPECT_FALSE(seen.activity(0).outputs.fresh);
  seen.cycles(1);
  EXPECT_TRUE(seen.activity(0).outputs.fresh);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(seen.activity(1).outputs.fresh) << i;
    seen.cycles(1);
  }
  EXPECT_TRUE(seen.outputs.empty() || seen.outputs.back().first == "Fast");
}

TEST(Activity, B11_StatesThroughAChangeAndARestart) {
  Observed seen;
  seen.start(two_tasks());
  ASSERT_TRUE(seen.controller);
  seen.cycles(1);
  const uint32_t before = seen.controller->generation().number();
  auto next = build(two_tasks("{attribute 'input_buffer' := 'swapped'}"),
                    &seen.controller->image());
  ASSERT_TRUE(next);
  auto generation = seen.controller->prepare(*next);
  ASSERT_TRUE(generation.ok());
  auto old = seen.controller->publish(std::move(*generation));
  EXPECT_FALSE(seen.controller->activity(1, before).has_value());
  EXPECT_FALSE(seen.controller->activity(64, before + 1).has_value());
  EXPECT_EQ(seen.activity(1).inputs.kind, ir::IoBuffer::kSwapped);
  EXPECT_EQ(seen.activity(1).state, TaskState::kWaiting);
  ASSERT_TRUE(seen.controller->restart(vm::Restart::kCold, kMs).ok());
  EXPECT_EQ(seen.activity(0).state, TaskState::kWaiting);
}

TEST(Activity, B11_EveryStateGoesThroughItsNumber) {
  vm::TaskActivity activity;
  activity.late = true;
  activity.inputs = {ir::IoBuffer::kFirstUnseen, 2, 1, 0, true, false};
  activity.outputs = {ir::IoBuffer::kLocked, 0, vm::BufferState::kNone, 0, false, true};
  for (uint32_t state = 0; state < vm::kTaskStateCount; ++state) {
    activity.state = static_cast<TaskState>(state);
    EXPECT_EQ(vm::unpacked(vm::packed(activity)), activity) << state;
    EXPECT_STRNE(vm::state_text(activity.state), "unknown");
  }
  EXPECT_STREQ(vm::state_text(static_cast<TaskState>(7)), "unknown");
}

// By another thread while a scan goes on: the control thread stays inside of it until that has
// looked.
class Asking : public vm::Timeline {
 public:
  void note(Moment moment, std::string_view, int64_t) override {
    const bool inside = moment == Moment::kBegun || moment == Moment::kResumed;
    if (!inside || looker == nullptr) return;
    asked = true;
    while (asked) std::this_thread::yield();
  }
  // The other thread.
  void look() {
    while (!over) {
      if (asked) {
        for (size_t task : {0, 1}) {
          text += vm::state_text(looker->activity(task, generation)->state);
          text += task == 0 ? ", " : "\n";
        }
        asked = false;
      }
      std::this_thread::yield();
    }
  }
  vm::Controller* looker = nullptr;
  uint32_t generation = 0;
  std::atomic<bool> asked{false}, over{false};
  std::string text;
};

TEST(Activity, B11_AnotherThreadReadsWhileScansGoOn) {
  auto image = build(two_tasks());
  ASSERT_TRUE(image);
  Asking asking;
  vm::VirtualClock clock;
  clock.let_scans_last("Slow", 12 * kMs);
  vm::SimulatedIo io;
  vm::ControllerOptions options;
  options.timeline = &asking;
  auto controller = vm::Controller::start(*image, options, clock, io);
  ASSERT_TRUE(controller.ok());
  asking.generation = (*controller)->generation().number();
  asking.looker = controller->get();
  std::thread other([&] { asking.look(); });
  for (int i = 0; i < 2; ++i) (*controller)->cycle();
  asking.over = true;
  other.join();
  EXPECT_EQ(asking.text,
            "running, due\nwaiting, running\nrunning, suspended\nwaiting, running\n");
}

}  // namespace
}  // namespace runtime_test
