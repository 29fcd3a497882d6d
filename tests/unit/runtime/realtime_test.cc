// What a control thread asks of Linux: granted, or one clear error with the way out.
#include "vm/runtime/realtime.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/runtime/plant.h"

namespace runtime_test {
namespace {

// In a child without privileges: 0 when `options` are granted, else 1 + the refusal.
int without_privileges(const vm::RealTimeOptions& options) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_RTPRIO, &none);
    setrlimit(RLIMIT_MEMLOCK, &none);
    if (geteuid() == 0 && setuid(65534) != 0) _exit(255);
    const base::Status made = vm::make_real_time(options);
    _exit(made.ok() ? 0 : 1 + static_cast<int>(made.error().refusal));
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(RealTime, WhatTheMachineRefusesIsSaid) {
  const int refused = 1 + static_cast<int>(base::Refusal::kNotPermitted);
  ASSERT_LT(refused, 255);
  vm::RealTimeOptions fifo;
  fifo.fifo_priority = 50;
  EXPECT_EQ(without_privileges(fifo), refused);
#ifndef STC_SANITIZED_HEAP  // a sanitizer locks nothing
  vm::RealTimeOptions locked;
  locked.lock_memory = true;
  EXPECT_EQ(without_privileges(locked), refused);
#endif
  vm::RealTimeOptions nowhere;
  nowhere.cpu = 1000;
  EXPECT_EQ(without_privileges(nowhere), 1 + static_cast<int>(base::Refusal::kUsage));
  EXPECT_EQ(without_privileges({}), 0);
}

TEST(RealTime, PrefaultChangesNothing) {
  Plant plant(
      "PROGRAM P VAR a : ARRAY[0..9999] OF DINT := [10000(7)]; n : DINT; END_VAR n := n + "
      "a[3]; END_PROGRAM");
  ASSERT_TRUE(plant.ok());
  plant.cycles(3);
  const std::string before = ir::state_text(plant->image(), plant->memory().view());
  vm::prefault(*plant);
  EXPECT_EQ(ir::state_text(plant->image(), plant->memory().view()), before);
  plant.cycles(1);
  EXPECT_EQ(plant.get("P.n"), "28");
}

}  // namespace
}  // namespace runtime_test
