// X6-03 to X6-05: conditions of a trial, which the controller computes at each boundary.
#include "tools/stvm/trial_guard.h"

#include <gtest/gtest.h>

#include "online_change/package/package.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/condition_parse.h"

namespace stvm {
namespace {

using plc::Plc;

constexpr int64_t kMs = 1'000'000;

// `errors` follows from n as the body says.
std::string watched_program(const std::string& body) {
  return "PROGRAM Main VAR n : DINT; errors : INT; zero : INT; rate : REAL := 2.0; big : ULINT; "
         "ok : BOOL := TRUE; level : INT := 3; END_VAR n := n + 1; " +
         body + " END_PROGRAM\n" +
         "CONFIGURATION c RESOURCE r ON cpu TASK t (INTERVAL := T#1ms, PRIORITY := 1);"
         " PROGRAM Main WITH t : Main; END_RESOURCE END_CONFIGURATION";
}

// The edit counts its own scans in `m`.
std::string edited_program(const std::string& body) {
  std::string text = watched_program("m := m + 1; " + body);
  text.replace(text.find("VAR "), 4, "VAR m : DINT; ");
  return text;
}

GuardOrder order_of(const std::vector<std::string>& conditions) {
  GuardOrder order;
  order.note = "plan 12345678 wave 1 by ann";
  order.deadline_ns = 3'600'000 * kMs;
  for (const std::string& text : conditions) {
    size_t at = 0;
    const base::Status added = add_condition(text, order, at);
    EXPECT_TRUE(added.ok()) << base::to_string(added.error()) << " at " << at;
  }
  return order;
}

struct GuardRig {
  explicit GuardRig(const std::string& body = {}) : plc(disk) {
    EXPECT_TRUE(plc.boot(watched_program(body)).ok());
    plc.run(5);
    plc.set("Main.level", "77");
  }
  base::Status guard(const GuardOrder& order) {
    vm::Request request{.command = vm::Command::kGuard};
    request.data = encode(order);
    return plc.ask(std::move(request));
  }
  base::Status change(const std::string& source, const GuardOrder& order,
                      uint32_t flags = vm::kAllowOverrun) {
    base::Status done = plc.stage(plc::build(source, &plc.controller().image()));
    if (done.ok()) done = guard(order);
    vm::Request change{.command = vm::Command::kSwitch};
    change.flags = flags;
    return done.ok() ? plc.ask(std::move(change)) : done;
  }
  // Cycles until it is undone, each with a look as the server's thread has it when it is woken.
  int cycles_until_undone(int most) {
    for (int i = 1; i <= most; ++i) {
      do {
        plc.run(1);
      } while (!plc.controller().at_boundary());
      plc.service().keep_up();
      if (plc.status().change == "idle") return i;
    }
    return 0;
  }
  std::string journal() {
    std::string text;
    for (const auto& entry : plc.store().history()) text += entry.text + "\n";
    return text;
  }
  sim::SimStorage disk;
  Plc plc;
};

void expect_noted(GuardRig& rig, const std::string& what) {
  EXPECT_NE(rig.journal().find(what), std::string::npos) << what << " in:\n" << rig.journal();
}

TEST(TrialGuard, X603_X604_X605_AConditionThatFailsUndoesItAtThatBoundary) {
  GuardRig rig("errors := 2;");
  const base::Digest before = rig.plc.status().running;
  ASSERT_TRUE(rig.change(edited_program("errors := 2; IF m >= 6 THEN errors := 5; END_IF"),
                         order_of({"Main.errors <= baseline(Main.errors) + 2"}))
                  .ok());
  int woken = 0;
  rig.plc.service().wake = [&] { ++woken; };
  const int after = rig.cycles_until_undone(20);
  EXPECT_EQ(woken, 1);
  ASSERT_GT(after, 0);
  EXPECT_EQ(rig.plc.status().running, before);
  EXPECT_EQ(rig.plc.get("Main.level"), "77");
  expect_noted(rig,
               "edit E1: plan 12345678 wave 1 by ann: `Main.errors <= baseline(Main.errors) + "
               "2` is FALSE in cycle ");
  expect_noted(rig, ": Main.errors = 5, baseline(Main.errors) = 2");
}

// The boundary behind the cycle that made it FALSE, and no other: what is FALSE for one cycle only
// is seen.
TEST(TrialGuard, X604_AConditionThatIsFalseForOneCycleIsSeen) {
  for (const bool looks : {true, false}) {
    GuardRig rig;
    ASSERT_TRUE(rig.change(edited_program("ok := m <> 6;"), order_of({"Main.ok"})).ok());
    uint64_t seen = 0;
    for (int i = 0; i < 30 && seen == 0; ++i) {
      rig.plc.run(1);
      if (looks) rig.plc.service().keep_up();
      if (rig.plc.get("Main.ok") == "FALSE") seen = rig.plc.controller().cycles();
      if (looks && rig.plc.status().change == "idle") seen = rig.plc.controller().cycles();
    }
    rig.plc.run(3);
    rig.plc.service().keep_up();
    EXPECT_EQ(rig.plc.status().change, "idle");
    expect_noted(rig, looks ? "is FALSE in cycle "
                            : "is FALSE in cycle " + std::to_string(seen) + ": Main.ok = FALSE");
  }
}

TEST(TrialGuard, X605_NobodyAcceptsByTheDeadline) {
  GuardRig rig;
  GuardOrder order = order_of({});
  order.deadline_ns = 20 * kMs;
  ASSERT_TRUE(rig.change(edited_program(""), order).ok());
  rig.plc.run(10);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "trial");
  EXPECT_GT(rig.cycles_until_undone(12), 0);
  expect_noted(rig, "plan 12345678 wave 1 by ann: nobody has accepted it by its deadline in cycle");
}

TEST(TrialGuard, X605_WhatIsAcceptedStays) {
  GuardRig rig;
  GuardOrder order = order_of({"Main.m < 20"});
  order.deadline_ns = 15 * kMs;
  ASSERT_TRUE(rig.change(edited_program(""), order).ok());
  rig.plc.run(4);
  ASSERT_TRUE(rig.plc.accept().ok());
  rig.plc.run(40);
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "idle");
  EXPECT_EQ(rig.plc.get("Main.m").substr(0, 3) == "no ", false);
  expect_noted(rig, "edit E1, plan 12345678 wave 1 by ann");
}

// X7 looks at the first 1000 cycles, and a roll-out at all of them.
TEST(TrialGuard, X605_ATrapAfterTheFirstCyclesUndoesItToo) {
  GuardRig rig;
  ASSERT_TRUE(
      rig.change(edited_program("IF m > 1500 THEN zero := 1 / zero; END_IF"), order_of({})).ok());
  rig.plc.run(1600);
  EXPECT_TRUE(rig.plc.controller().faulted());
  rig.plc.service().keep_up();
  EXPECT_EQ(rig.plc.status().change, "idle");
  EXPECT_FALSE(rig.plc.status().faulted);
  expect_noted(rig, "a trap on trial");
}

// What cannot be computed counts as FALSE, and stops no program.
TEST(TrialGuard, X603_AConditionThatTrapsCountsAsFalse) {
  const std::pair<const char*, const char*> kCases[] = {
      {"10 / Main.zero > 1", "divides by zero"},
      {"10 MOD Main.zero = 1", "divides by zero"},
      {"Main.rate / 0.0 > 1.0", "divides by zero"},
      {"Main.big < 5", "has no room in 64 bits"},
      {"Main.n * 9_223_372_036_854_775_807 > 0", "has no room in 64 bits"},
  };
  for (const auto& [text, said] : kCases) {
    GuardRig rig("n := n + 1; big := 16#FFFF_FFFF_FFFF_FFFF;");
    ASSERT_TRUE(rig.change(edited_program("big := 16#FFFF_FFFF_FFFF_FFFF;"), order_of({text})).ok())
        << text;
    EXPECT_GT(rig.cycles_until_undone(3), 0) << text;
    EXPECT_FALSE(rig.plc.controller().faulted());
    expect_noted(rig, said);
  }
}

TEST(TrialGuard, X603_ConditionsThatFlapCountWhenTheyHoldOn) {
  for (const bool flaps : {true, false}) {
    GuardRig rig;
    GuardOrder order = order_of({"Main.ok"});
    order.hold_ns = 5 * kMs;
    order.grace_ns = 3 * kMs;
    ASSERT_TRUE(
        rig.change(edited_program(flaps ? "ok := m MOD 4 = 0;" : "ok := m < 30;"), order).ok());
    EXPECT_EQ(rig.cycles_until_undone(100) == 0, flaps);
  }
}

// `errors` goes from 0 to 9 and over again; what it is at the switch says little.
TEST(TrialGuard, X603_WithAWindowTheBaselineIsTheMeanBefore) {
  const std::string body = "errors := DINT_TO_INT(n MOD 10); rate := DINT_TO_REAL(n MOD 4) * 0.5;";
  std::string next = edited_program(body);
  next.replace(next.find("errors : INT"), 12, "errors : DINT");  // it lies elsewhere then
  for (const int64_t window_ns : {int64_t{0}, 40 * kMs}) {
    for (int cycles = 40; cycles < 44; ++cycles) {
      GuardRig rig(body);
      GuardOrder order = order_of({"baseline(Main.errors) = 4 OR baseline(Main.errors) = 5",
                                   "ABS(baseline(Main.rate) - 0.75) < 0.05", "Main.m >= 0"});
      order.window_ns = window_ns;
      ASSERT_TRUE(rig.plc.stage(plc::build(next, &rig.plc.controller().image())).ok());
      ASSERT_TRUE(rig.guard(order).ok());
      rig.plc.run(cycles);
      vm::Request change{.command = vm::Command::kSwitch};
      change.flags = vm::kAllowOverrun;
      ASSERT_TRUE(rig.plc.ask(std::move(change)).ok());
      EXPECT_EQ(rig.cycles_until_undone(3) == 0, window_ns != 0) << cycles;
    }
  }
}

// What only the new version has, or has as another type, begins with its first value.
TEST(TrialGuard, X603_WithAWindowOtherVariablesHaveTheirFirstValue) {
  GuardRig rig("errors := 7; ok := n > 0;");
  std::string next = edited_program("errors := 7; ok := TRUE;");
  next.replace(next.find("level : INT"), 11, "level : REAL");
  GuardOrder order =
      order_of({"baseline(Main.m) <= 1", "baseline(Main.level) = 77.0", "baseline(Main.ok)"});
  order.window_ns = 5 * kMs;
  ASSERT_TRUE(rig.plc.stage(plc::build(next, &rig.plc.controller().image())).ok());
  ASSERT_TRUE(rig.guard(order).ok());
  rig.plc.run(5);
  vm::Request change{.command = vm::Command::kSwitch};
  change.flags = vm::kAllowOverrun;
  ASSERT_TRUE(rig.plc.ask(std::move(change)).ok());
  EXPECT_EQ(rig.cycles_until_undone(3), 0) << rig.journal();
}

// An order that another one replaces is not looked at any more.
TEST(TrialGuard, X603_AWindowThatIsGivenAnewBeginsAnew) {
  const std::string body = "errors := DINT_TO_INT(n);";
  GuardRig rig(body);
  GuardOrder order = order_of({"baseline(Main.errors) > 20"});
  order.window_ns = 5 * kMs;
  ASSERT_TRUE(rig.plc.stage(plc::build(edited_program(body), &rig.plc.controller().image())).ok());
  ASSERT_TRUE(rig.guard(order).ok());
  rig.plc.run(30);
  ASSERT_TRUE(rig.guard(order).ok());
  rig.plc.run(3);
  vm::Request change{.command = vm::Command::kSwitch};
  change.flags = vm::kAllowOverrun;
  ASSERT_TRUE(rig.plc.ask(std::move(change)).ok());
  EXPECT_EQ(rig.cycles_until_undone(3), 0) << rig.journal();
}

TEST(TrialGuard, X603_NothingCountsInTheGraceTime) {
  GuardRig rig;
  GuardOrder order = order_of({"Main.m > 30"});
  order.grace_ns = 40 * kMs;
  ASSERT_TRUE(rig.change(edited_program(""), order).ok());
  EXPECT_EQ(rig.cycles_until_undone(100), 0);
}

// Everything that can be written, against values that are known.
TEST(TrialGuard, X603_ExpressionsAreThoseOfTheLanguage) {
  const ir::VerifiedImage image = plc::build(watched_program(""));
  const std::pair<const char*, bool> kCases[] = {
      {"1 + 2 * 3 = 7", true},
      {"(1 + 2) * 3 = 9", true},
      {"7 - 2 - 1 = 4", true},
      {"-7 / 2 = -3 AND -7 MOD 2 = -1", true},
      {"NOT FALSE AND TRUE", true},
      {"TRUE OR FALSE AND FALSE", true},
      {"TRUE XOR TRUE", false},
      {"1 < 2 = TRUE", true},
      {"1.5e1 >= 15", true},
      {"ABS(-3) = 3 & MIN(2, 5) = 2 & max(2, 5) = 5", true},
      {"ABS(-2.5) > 2.4", true},
      {"0.1 + 0.2 <> 0.3", true},
      {"1 > 2", false},
      {"2 <= 1", false},
  };
  for (const auto& [text, expected] : kCases) {
    GuardOrder order = order_of({text});
    ASSERT_TRUE(TrialGuard::check(order, image.image()).ok()) << text;
    EXPECT_EQ(compute(order.conditions[0], {}, {}), expected ? Computed::kTrue : Computed::kFalse)
        << text;
  }
}

TEST(TrialGuard, X603_WhatIsNoConditionIsRefusedWithItsPlace) {
  const std::pair<const char*, size_t> kMistakes[] = {
      {"", 0},
      {"1 +", 3},
      {"Main.n > ", 9},
      {"(1 = 1", 6},
      {"1 = 1 )", 6},
      {"Start(Main.n)", 0},
      {"1 = 1 AND Loop()", 10},
      {"baseline(3) = 3", 9},
      {"Main.n := 3", 7},
      {"12ab = 3", 0},
      {"T#5s > 3", 1},
  };
  for (const auto& [text, where] : kMistakes) {
    GuardOrder order;
    size_t at = 0;
    EXPECT_FALSE(add_condition(text, order, at).ok()) << text;
    EXPECT_EQ(at, where) << text;
    EXPECT_TRUE(order.names.empty() && order.conditions.empty()) << text;
  }
  GuardOrder order;
  size_t at = 0;
  EXPECT_FALSE(add_condition(std::string(500, '('), order, at).ok());
  EXPECT_FALSE(add_condition(std::string(500, '-') + "1 = 1", order, at).ok());
}

// The controller believes no tool: of types, names and lengths it makes sure itself.
TEST(TrialGuard, X603_TheControllerChecksWhatItIsSent) {
  GuardRig rig;
  ASSERT_TRUE(rig.plc.stage(plc::build(edited_program(""), &rig.plc.controller().image())).ok());
  const char* const kBad[] = {"Main.n",     "Main.n AND TRUE", "Main.ok + 1 = 2",
                              "NOT Main.n", "Main.none = 1",   "Main.rate MOD 2 = 0",
                              "-Main.ok",   "Main.ok < TRUE",  "Main.n = TRUE"};
  for (const char* const text : kBad) {
    EXPECT_FALSE(rig.guard(order_of({text})).ok()) << text;
  }
  EXPECT_TRUE(rig.guard(order_of({"Main.m >= 0"})).ok()) << "a variable of the new version";
  std::vector<GuardOrder> bad(5, order_of({"Main.ok"}));
  bad[0].deadline_ns = 0;
  bad[1].conditions[0].steps = {{ConditionOp::kAnd, 0}};
  bad[2].conditions[0].steps = {{ConditionOp::kVariable, 7}};
  bad[3].conditions[0].steps.assign(40, {ConditionOp::kBool, 1});
  bad[4].conditions[0].steps.clear();
  for (const GuardOrder& order : bad) EXPECT_FALSE(rig.guard(order).ok());
  vm::Request longer{.command = vm::Command::kGuard};
  longer.data = encode(order_of({"Main.ok"}));
  longer.data.push_back(0);
  EXPECT_TRUE(rig.plc.ask(longer).ok()) << "a newer tool asks for nothing more";
  longer.data.push_back(1);
  EXPECT_FALSE(rig.plc.ask(longer).ok()) << "what a newer tool relies on";
  longer.data.resize(longer.data.size() - 3);
  EXPECT_FALSE(rig.plc.ask(longer).ok());
}

// Whatever becomes of the bytes: refused, or conditions that end.
TEST(TrialGuard, X603_DamagedOrdersAreRefusedOrHarmless) {
  const ir::VerifiedImage image = plc::build(watched_program(""));
  const base::Bytes whole =
      encode(order_of({"Main.errors <= baseline(Main.errors) + 2 AND NOT (Main.rate > 0.5)",
                       "MIN(Main.n, 3) MOD 2 = ABS(-1)"}));
  const size_t first_form = whole.size() - sizeof(int64_t);  // without a window
  EXPECT_EQ(base::short_hex(base::sha256(base::ByteSpan(whole).first(first_form))), "d0d6bacc8e34")
      << "what newer tools send grows at its end";
  EXPECT_TRUE(decode_guard_order(base::ByteSpan(whole).first(first_form)).ok());
  size_t computed = 0;
  const std::vector<ConditionValue> values(kMostConditionNames);
  const auto look = [&](const base::Bytes& bytes) {
    base::Result<GuardOrder> order = decode_guard_order(bytes);
    if (!order.ok() || !TrialGuard::check(*order, image.image()).ok()) return;
    for (const Condition& condition : order->conditions) {
      (void)compute(condition, values, values);
      ++computed;
    }
  };
  for (size_t i = 0; i < whole.size(); ++i) {
    const base::ByteSpan part(whole.data(), i);
    EXPECT_EQ(decode_guard_order(part).ok(), i == first_form) << i;
    for (int bit = 0; bit < 8; ++bit) {
      base::Bytes flipped = whole;
      flipped[i] = static_cast<uint8_t>(flipped[i] ^ (1u << bit));
      look(flipped);
    }
  }
  EXPECT_GT(computed, 100u);
}

// A second roll-out, and anybody else: nothing is made on top of a trial that is watched.
TEST(TrialGuard, X605_NothingIsMadeOnTopOfIt) {
  GuardRig rig;
  ASSERT_TRUE(rig.change(edited_program(""), order_of({"Main.ok"})).ok());
  const base::Status second = rig.plc.change(watched_program("level := 1;"));
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().refusal, base::Refusal::kChangePending);
  EXPECT_NE(second.error().text.find("plan 12345678 wave 1 by ann"), std::string::npos);
  ASSERT_TRUE(rig.plc.undo().ok());
  EXPECT_TRUE(rig.plc.change(watched_program("level := 1;")).ok());
  rig.plc.run(2);
  EXPECT_EQ(rig.plc.status().change, "trial");
}

// The step that is active is one that only the edit has.
std::string chart_program(bool edited) {
  return std::string(
             "PROGRAM Main VAR go : BOOL := TRUE; back : BOOL; ok : BOOL := TRUE; END_VAR "
             "INITIAL_STEP First: END_STEP STEP Second: END_STEP ") +
         (edited ? "STEP Third: Deny(N); END_STEP ACTION Deny: ok := FALSE; END_ACTION "
                   "TRANSITION FROM First TO Third := go; END_TRANSITION "
                   "TRANSITION FROM Third TO Second := back; END_TRANSITION "
                 : "TRANSITION FROM First TO Second := back; END_TRANSITION ") +
         "TRANSITION FROM Second TO First := back; END_TRANSITION END_PROGRAM";
}

// It is said before (the plan), and what then happens is a policy.
TEST(TrialGuard, X606_WhatCannotBeTakenBackStaysOrStopsSafely) {
  for (const bool safe : {false, true}) {
    sim::SimStorage disk;
    Plc plc(disk);
    ASSERT_TRUE(plc.boot(chart_program(false)).ok());
    plc.run(3);
    ASSERT_TRUE(plc.stage(plc::build(chart_program(true), &plc.controller().image())).ok());
    GuardOrder order = order_of({"Main.ok"});
    order.stop_safe = safe;
    vm::Request guard{.command = vm::Command::kGuard};
    guard.data = encode(order);
    ASSERT_TRUE(plc.ask(guard).ok());
    vm::Request change{.command = vm::Command::kSwitch};
    change.flags = vm::kAllowOverrun;
    ASSERT_TRUE(plc.ask(change).ok());
    for (int i = 0; i < 10; ++i) {
      plc.run(1);
      plc.service().keep_up();
    }
    EXPECT_EQ(plc.get("Main.ok"), "FALSE");
    const vm::StatusReport status = plc.status();
    EXPECT_EQ(status.edits, 1u) << "it stays";
    ASSERT_FALSE(status.alarms.empty());
    EXPECT_NE(status.alarms[0].find("R0313"), std::string::npos) << status.alarms[0];
    EXPECT_EQ(static_cast<ControllerService&>(plc.service()).stop_wanted(), safe);
  }
}

// A power cut and a clean end both end the trial: after them nobody would watch it.
TEST(TrialGuard, X608_ATrialEndsWithItsController) {
  for (const bool clean : {true, false}) {
    GuardRig rig;
    const base::Digest before = rig.plc.status().running;
    ASSERT_TRUE(rig.change(edited_program(""), order_of({"Main.ok"}),
                           vm::kAllowOverrun | vm::kLastEditBoots)
                    .ok());
    rig.plc.run(3);
    if (clean) rig.plc.stop();
    ASSERT_TRUE(rig.plc.boot().ok());
    EXPECT_EQ(rig.plc.status().running, before);
    EXPECT_EQ(rig.plc.status().edits, 0u);
  }
}

TEST(TrialGuard, X603_MissedReleasesAndLoadCount) {
  for (const bool load : {true, false}) {
    GuardRig rig;
    GuardOrder order = order_of({});
    if (load) order.most_load = 40;
    if (!load) order.most_missed = 0;
    if (load) rig.plc.clock().let_scans_last("t", kMs / 2);
    ASSERT_TRUE(rig.change(edited_program(""), order).ok());
    if (!load) rig.plc.clock().advance(5 * kMs);
    EXPECT_GT(rig.cycles_until_undone(30), 0);
    expect_noted(rig, load ? "% of their time in cycle" : "release(s) were missed in cycle");
  }
}

// A device that was lost before the edit came does not speak against it.
TEST(TrialGuard, X603_ADeviceThatIsLostCounts) {
  for (const bool counts : {true, false}) {
    GuardRig rig;
    rig.plc.devices().resize(2);
    rig.plc.devices()[0].state = "online";
    rig.plc.devices()[1].state = "lost";
    GuardOrder order = order_of({});
    order.devices = counts;
    ASSERT_TRUE(rig.change(edited_program(""), order).ok());
    EXPECT_EQ(rig.cycles_until_undone(20), 0);
    rig.plc.devices()[0].state = "lost";
    EXPECT_EQ(rig.cycles_until_undone(20) > 0, counts);
    if (counts) expect_noted(rig, "a device is no longer online in cycle");
  }
}

TEST(TrialGuard, X603_AnAlarmOfTheStorageCounts) {
  for (const bool counts : {true, false}) {
    GuardRig rig;
    GuardOrder order = order_of({});
    order.alarms = counts;
    ASSERT_TRUE(rig.change(edited_program(""), order).ok());
    EXPECT_EQ(rig.cycles_until_undone(20), 0);
    rig.disk.fails = [](std::string_view call) {
      return call == "write" ? sim::Failure::kError : sim::Failure::kNone;
    };
    (void)rig.plc.save().ok();
    (void)rig.plc.save().ok();
    EXPECT_EQ(rig.cycles_until_undone(20) > 0, counts);
    rig.disk.fails = nullptr;
    if (counts) expect_noted(rig, "an alarm of the storage in cycle");
  }
}

// A text of a tool that is cut in the journal is cut between characters; names may have such.
TEST(TrialGuard, X603_NamesOfAllLettersAreKnown) {
  sim::SimStorage disk;
  Plc plc(disk);
  const auto program = [](const char* more) {
    return std::string("PROGRAM Main VAR Füllstände : INT := 1; ") + more +
           "END_VAR Füllstände := Füllstände + 1; END_PROGRAM";
  };
  ASSERT_TRUE(plc.boot(program("")).ok());
  ASSERT_TRUE(plc.stage(plc::build(program("m : INT; "), &plc.controller().image())).ok());
  GuardOrder order =
      order_of({"Main.Füllstände <= baseline(Main.Füllstände) + 2 AND           "
                "Main.Füllstände > 0"});
  vm::Request guard{.command = vm::Command::kGuard};
  guard.data = encode(order);
  ASSERT_TRUE(plc.ask(guard).ok());
  vm::Request change{.command = vm::Command::kSwitch};
  change.flags = vm::kAllowOverrun;
  ASSERT_TRUE(plc.ask(change).ok());
  for (int i = 0; i < 9; ++i) {
    plc.run(1);
    plc.service().keep_up();
  }
  EXPECT_EQ(plc.status().change, "idle");
  const std::string said = plc.store().history().back().text;
  EXPECT_NE(said.find("Main.Füllstände = "), std::string::npos) << said;
  EXPECT_NE(said.find("Main.Füllst` is FALSE"), std::string::npos)
      << "no character is cut: " << said;
}

}  // namespace
}  // namespace stvm
