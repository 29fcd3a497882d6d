// Where executions of a program stop, and what memory is there: the same on every tier.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/exec/machine.h"

namespace sample {

struct Stop {
  vm::Exit exit;
  uint64_t fuel;
  std::string state;
  uint32_t unit;  // of a trap
  std::string trap;
  friend bool operator==(const Stop&, const Stop&) = default;
};

inline void PrintTo(const Stop& stop, std::ostream* out) {
  *out << "exit " << static_cast<int>(stop.exit) << ", fuel " << stop.fuel << ", unit " << stop.unit
       << " " << stop.trap << "\n"
       << stop.state;
}

// Three scans, each in slices, of `most` fuel together.
inline std::vector<Stop> stops(const ir::Image& image, const vm::TierOptions& tier, uint64_t slice,
                               uint64_t most = UINT64_MAX) {
  Machine machine(image, tier);
  std::vector<Stop> out;
  for (int scan = 0; scan < 3; ++scan) {
    machine.start();
    uint64_t spent = 0;
    for (vm::Exit exit = vm::Exit::kSuspended; exit == vm::Exit::kSuspended && spent < most;
         spent += slice) {
      exit = machine.execution().run(slice);
      const bool trapped = exit == vm::Exit::kTrap;
      out.push_back({exit, machine.execution().fuel_used(), machine.state(),
                     trapped ? machine.execution().trap().unit : 0,
                     trapped ? machine.trap_text() : ""});
    }
  }
  return out;
}

}  // namespace sample
