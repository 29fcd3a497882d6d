// The life of a controller with a store, step by step, and what may be found after each: shared by
// the tests that cut the power, kill the process or break the disk in it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/store/plc.h"

namespace plc {

// One of four versions of a program. r and s are always set together. Every version has them, in
// other places and types.
std::string source(int version);

// One step of a controller's life, and what may be found after a cut in it.
struct Step {
  std::function<bool(std::unique_ptr<Plc>&, vm::Storage&)> run;
  std::vector<int> boots;   // versions; 0: nothing was stored yet
  std::vector<int> values;  // of r and s
};

// Which of them runs, by a variable that the others have not.
int version_of(const Plc& plc);

bool set_and_save(Plc& plc, int value);
std::vector<Step> life();

// Boots from what was left; "" or what is wrong.
std::string found(vm::Storage& storage, const Step& step);

}  // namespace plc
