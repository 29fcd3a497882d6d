// What must hold at every boundary of every run, whatever happens (the laws at the end of
// docs/REQUIREMENTS.md), checked from outside: from values by path before and after.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/verify.h"
#include "tests/sim/violation.h"
#include "vm/runtime/controller.h"

namespace sim {

struct Value {
  std::string type;
  std::string text;
  bool comparable = true;  // neither constant nor reference, nor in a union, nor forced
  bool retain = false;
};
using Values = std::map<std::string, Value>;  // by path

// A boundary as it was: the version that ran, and its data.
class Snapshot {
 public:
  explicit Snapshot(vm::Controller& controller);
  const ir::VerifiedImage& image() const { return image_; }
  bool same_bytes(const Snapshot& other) const { return data_ == other.data_; }
  const Values& values() const;

 private:
  ir::VerifiedImage image_;
  base::Bytes data_;
  std::vector<std::string> forced_;  // whose scan trapped is not as it is forced until the next one
  mutable std::optional<Values> values_;
};

// Nothing that a program can see differs.
void check_untouched(const Snapshot& before, const Snapshot& now, const std::string& what);
// A switch, forward or back, between two looks at one boundary: what has the same path and type
// keeps its value.
void check_kept(const Snapshot& before, const Snapshot& now);
// Of the variables that are retained.
Values retained_values(vm::Controller& controller);
// Have all variables that both know with one type the same value?
bool agree(const Values& a, const Values& b);
// Undo at once or later: what only the old version has is as it was when it was dropped.
void check_restored(const Snapshot& at_switch, const Snapshot& before_undo, const Snapshot& now);

}  // namespace sim
