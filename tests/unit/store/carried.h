// Retained values over a power cut: a program that is begun, a cut, and what boots behind it.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {

inline std::string program(const std::string& variables, const std::string& body = ";",
                    const std::string& types = "") {
  return types + "\nVAR_GLOBAL RETAIN " + variables + " END_VAR\nPROGRAM P VAR n : DINT; END_VAR " +
         body + " n := n + 1; END_PROGRAM\n";
}

// Values of `before` set, saved, then the power fails and the program on the command line is
// `after`: what stored values become.
class Carried : public ::testing::Test {
 protected:
  void begin(const std::string& before) {
    plc_ = std::make_unique<Plc>(disk_);
    const base::Status booted = plc_->boot(before);
    ASSERT_TRUE(booted.ok()) << base::to_string(booted.error());
    plc_->run(1);
  }
  void cut() {
    disk_ = disk_.after_cut(sim::SimStorage::Choice(disk_.dirty().size(), 0));
    plc_ = std::make_unique<Plc>(disk_);
  }
  // Linked against what ran, as a change would be.
  void boot_with(const std::string& after) {
    ASSERT_TRUE(plc_->save().ok());
    const ir::VerifiedImage next = build(after, &plc_->controller().image());
    cut();
    const base::Status booted = plc_->boot(std::optional(next));
    ASSERT_TRUE(booted.ok()) << base::to_string(booted.error());
    EXPECT_TRUE(plc_->found().alarms.empty()) << plc_->found().alarms.front();
  }

  sim::SimStorage disk_;
  std::unique_ptr<Plc> plc_;
};

}  // namespace plc
