// Commands of the control channel when no boundary comes (a task that does not end, a controller
// that stops), and when the program writes between them: stage, report, switch, accept, undo and
// restart.
#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

using Outcome = vm::Boundary::Outcome;
using base::Refusal;

const std::string kOld =
    "VAR_GLOBAL RETAIN r : DINT := 1; END_VAR "
    "FUNCTION_BLOCK Tank VAR n : DINT := 8; d : DINT := 7; pad : ARRAY[0..8191] OF DINT; END_VAR "
    "END_FUNCTION_BLOCK PROGRAM P VAR t : ARRAY[0..9] OF Tank; END_VAR END_PROGRAM";
// Divides by zero unless `n` and `d` are of one instant; `pad` makes several slices of ten tanks.
const std::string kNew =
    "{migration of := 'Tank'} FUNCTION Divide VAR_INPUT n, d : DINT; pad : ARRAY[0..8191] OF "
    "DINT; END_VAR VAR_OUTPUT q : DINT; END_VAR q := n / (n - d) + pad[3]; END_FUNCTION "
    "VAR_GLOBAL RETAIN r : LINT := 1; END_VAR "
    "FUNCTION_BLOCK Tank VAR n : DINT := 8; d : DINT := 7; pad : ARRAY[0..8191] OF DINT; "
    "q : DINT; END_VAR END_FUNCTION_BLOCK "
    "PROGRAM P VAR t : ARRAY[0..9] OF Tank; END_VAR END_PROGRAM";

vm::Request request(vm::Command command, uint32_t flags = 0) {
  vm::Request made{.command = command};
  made.flags = flags;
  return made;
}

base::Status stage(Plc& plc, const ir::VerifiedImage& next, uint32_t flags) {
  auto package = online_change::make_package(plc.controller().verified().encoded(), next.encoded());
  base::check(package.ok(), "the package is made");
  vm::Request upload = request(vm::Command::kUpload);
  upload.data = online_change::encode(*package);
  vm::Request stage = request(vm::Command::kStage, flags);
  stage.digest = base::sha256(upload.data);
  base::Status done = plc.ask(std::move(upload));
  return done.ok() ? plc.ask(std::move(stage)) : done;
}

// The program writes as long as nobody looks: between two boundaries the values belong to no
// instant, and at each one they are others.
TEST(Boundary, X2_case60_StageTriesMigrationsOnValuesOfOneInstant) {
  sim::SimStorage disk;
  Plc plc(disk);
  ASSERT_TRUE(plc.boot(kOld).ok());
  int jobs = 0;
  const auto write = [&](int n, int d) {
    for (int i = 0; i < 10; ++i) {
      const std::string tank = "P.t[" + std::to_string(i) + "].";
      plc.set(tank + "n", std::to_string(n));
      plc.set(tank + "d", std::to_string(d));
    }
  };
  plc.at_boundary = [&] {
    ++jobs;
    write(jobs + 1, jobs);
    return Outcome::kDone;
  };
  // What a look at any other time would find: `d` already of the next instant.
  plc.behind_job = [&] { write(jobs + 1, jobs + 1); };
  write(1, 1);
  const ir::VerifiedImage next = build(kNew, &plc.controller().image());
  const base::Status staged = stage(plc, next, 0);
  EXPECT_TRUE(staged.ok()) << base::to_string(staged.error());
  EXPECT_GE(jobs, 3) << "one for the fault, and several slices";
}

// --- no boundary comes ---------------------------------------------------------------

struct Step {
  const char* name;
  std::function<base::Status(Plc&)> run;
};

std::vector<Step> commands(uint32_t strategy, uint32_t permanent) {
  const auto ask = [](vm::Command command, uint32_t flags = 0) {
    return [command, flags](Plc& plc) { return plc.ask(request(command, flags)); };
  };
  const auto set = [](vm::Command command) {
    return [command](Plc& plc) {
      vm::Request made = request(command);
      made.names = {"r"};
      if (command != vm::Command::kGet) made.values = {"5"};
      return plc.ask(std::move(made));
    };
  };
  const auto stage_new = [strategy](Plc& plc) {
    return stage(plc, build(kNew, &plc.controller().image()), strategy);
  };
  const uint32_t flags = vm::kAllowLoss | vm::kAllowOverrun | permanent;
  std::vector<Step> out = {
      {"set", set(vm::Command::kSet)},
      {"get", set(vm::Command::kGet)},
      {"force", set(vm::Command::kForce)},
      {"unforce", ask(vm::Command::kUnforce)},
      {"stage", stage_new},
      {"report", ask(vm::Command::kFates)},
      {"switch", ask(vm::Command::kSwitch, flags)},
  };
  if (permanent == 0) {
    out.push_back({"undo report", ask(vm::Command::kFates)});
    out.push_back({"undo", ask(vm::Command::kUndo)});
    out.push_back({"stage again", stage_new});
    out.push_back({"switch again", ask(vm::Command::kSwitch, flags)});
    out.push_back({"accept", ask(vm::Command::kAccept)});
  }
  const auto cold = static_cast<uint32_t>(vm::Restart::kCold);
  out.push_back({"restart", ask(vm::Command::kRestart, cold)});
  return out;
}

// What boots after a power cut is what status says, and what the state of the change says.
void check_what_boots(Plc& plc, sim::SimStorage& disk, const std::string& where) {
  const vm::StatusReport now = plc.status();
  const bool trial = now.change == "trial";
  EXPECT_EQ(now.boots_next, trial ? now.previous : now.running) << where;
  sim::SimStorage left = disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
  Plc later(left);
  ASSERT_TRUE(later.boot().ok()) << where;
  EXPECT_EQ(later.status().running, now.boots_next) << where;
  EXPECT_EQ(later.found().trial_lost.has_value(), trial) << where;
  for (const std::string& alarm : later.found().alarms) ADD_FAILURE() << where << ": " << alarm;
}

// The boundary with this number does not come; false: there are not so many.
bool fails_at(int number, Outcome outcome, const std::vector<Step>& steps) {
  sim::SimStorage disk;
  Plc plc(disk);
  EXPECT_TRUE(plc.boot(kOld).ok());
  EXPECT_TRUE(plc.save().ok());
  int boundaries = 0;
  plc.at_boundary = [&] {
    ++boundaries;
    const bool closed = outcome == Outcome::kClosed && boundaries > number;
    return boundaries == number || closed ? outcome : Outcome::kDone;
  };
  for (const Step& step : steps) {
    const std::string where =
        step.name + std::string(" without boundary ") + std::to_string(number);
    const vm::StatusReport before = plc.status();
    const std::string value = plc.get("r");
    const bool failed_before = boundaries >= number;
    const base::Status done = step.run(plc);
    if (failed_before || boundaries < number) {
      EXPECT_TRUE(done.ok()) << where << ": " << base::to_string(done.error());
      continue;
    }
    const vm::StatusReport now = plc.status();
    if (!done.ok()) {
      const Refusal code = outcome == Outcome::kClosed ? Refusal::kNotRunning : Refusal::kBusy;
      EXPECT_EQ(done.error().refusal, code) << where << ": " << base::to_string(done.error());
      EXPECT_EQ(now.running, before.running) << where;
      EXPECT_EQ(plc.get("r"), value) << where;
      EXPECT_EQ(now.edition, before.edition) << where;
    }
    check_what_boots(plc, disk, where);
    if (outcome == Outcome::kClosed) return true;
    if (done.ok()) continue;
    if (plc.status().change == "idle" && std::string(step.name).rfind("switch", 0) == 0) {
      EXPECT_TRUE(stage(plc, build(kNew, &plc.controller().image()), 0).ok()) << where;
    }
    const base::Status again = step.run(plc);
    EXPECT_TRUE(again.ok()) << where << ", again: " << base::to_string(again.error());
  }
  check_what_boots(plc, disk, "at the end");
  return boundaries >= number;
}

void every_boundary_fails(uint32_t strategy, uint32_t permanent, int at_least) {
  const std::vector<Step> steps = commands(strategy, permanent);
  for (const Outcome outcome : {Outcome::kTimeout, Outcome::kClosed}) {
    int number = 1;
    while (fails_at(number, outcome, steps)) ++number;
    EXPECT_GT(number, at_least);
  }
}

TEST(Boundary, C1_NoneComesForACommandInPlace) { every_boundary_fails(0, 0, 20); }
TEST(Boundary, C1_NoneComesForACommandByStandby) { every_boundary_fails(vm::kByStandby, 0, 20); }
TEST(Boundary, C1_NoneComesForAChangeThatIsFinalAtOnce) {
  every_boundary_fails(0, vm::kPermanent, 10);
}

}  // namespace
}  // namespace plc
