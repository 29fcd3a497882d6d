// The live values behind a fate report: a copy of data memory, taken in slices between scans, so
// that however much there is to say, no scan waits for it. Whether the values are still such is
// looked at again when the switch comes.
#pragma once

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "online_change/apply/change.h"
#include "vm/exec/memory.h"
#include "vm/runtime/controller.h"

namespace stvm {

class LiveReport {
 public:
  static base::Result<LiveReport> take(vm::Controller& controller,
                                       const online_change::Change& change,
                                       const online_change::AtBoundary& at_boundary);

  // Of the program that runs; "" when there is no such variable.
  std::string value(const std::string& path) const;
  const std::vector<online_change::LiveLoss>& losses() const { return losses_; }
  const online_change::LiveLoss* loss(const std::string& path) const;

 private:
  LiveReport(vm::Memory memory, ir::VerifiedImage image)
      : memory_(std::move(memory)), image_(std::move(image)) {}

  vm::Memory memory_;
  ir::VerifiedImage image_;
  std::vector<online_change::LiveLoss> losses_;
  std::unordered_map<std::string, size_t> by_path_;  // folded
};

}  // namespace stvm
