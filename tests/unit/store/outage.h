// A controller with edits on trial whose power is cut (D4).
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace stvm {

// Each one is made on the one before: `a` narrows, `gone` goes, `c` comes; `n` is not retained.
inline std::string outage_source(int number) {
  const char* const variables[] = {"a : DINT; gone : INT := 3;", "a : INT; gone : INT := 3;",
                                   "a : INT;", "a : INT; c : INT := 8;"};
  return std::string("VAR_GLOBAL RETAIN r : DINT; ") + variables[number] +
         " END_VAR PROGRAM Main VAR n : DINT; END_VAR n := n + " + std::to_string(number + 1) +
         "; END_PROGRAM";
}

inline sim::SimStorage behind_cut(const sim::SimStorage& disk) {
  return disk.after_cut(sim::SimStorage::Choice(disk.dirty().size(), 0));
}

struct Outage {
  explicit Outage(uint32_t policy) : flags(policy | vm::kAllowLoss), plc(disk) {
    EXPECT_TRUE(plc.boot(outage_source(0)).ok());
    plc.set("a", "70000");
    plc.set("gone", "44");
    plc.set("r", "5");
    EXPECT_TRUE(plc.save().ok());
    digests.push_back(plc.status().running);
  }
  void change(int number) {
    const base::Status done = plc.change(outage_source(number), flags);
    ASSERT_TRUE(done.ok()) << base::to_string(done.error());
    plc.run(2);
    digests.push_back(plc.status().running);
  }
  void three_edits() {
    for (int number : {1, 2, 3}) change(number);
  }
  uint32_t flags;
  sim::SimStorage disk;
  plc::Plc plc;
  std::vector<base::Digest> digests;
};

}  // namespace stvm
