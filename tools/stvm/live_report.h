// The live values behind a fate report: a copy of data memory (vm/runtime/live_copy.h), so that
// however much there is to say, no scan waits for it. Whether the values are still such is
// looked at again when the switch comes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "online_change/apply/change.h"
#include "online_change/plan/every_fate.h"
#include "tools/common/fate_report.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/live_copy.h"

namespace stvm {

class LiveReport {
 public:
  using CopyRanges = std::function<base::Result<vm::LiveCopy>(std::vector<ir::DataRange>)>;
  // `next`: the version whose names the fate rows have, when it is not the one that runs. `whole`:
  // of all variables, not only of those that the change touches.
  static base::Result<LiveReport> take(vm::Controller& controller,
                                       const online_change::Change& change, const ir::Image* next,
                                       bool whole, const CopyRanges& copy_of);
  // Of the undo of the edit on trial that `below` others were made on top of: the values behind
  // their undo, and what becomes of these.
  static base::Result<LiveReport> take_back(const vm::Controller& controller,
                                            online_change::Change& change, size_t below,
                                            const CopyRanges& copy_of);

  // The value of the variable that the row is about, in the program that runs; "" when there is
  // none.
  std::string value(const online_change::FateRow& row) const;
  // What it becomes by that step, which is for this row alone; "" for what is no single value.
  std::string result_of(const online_change::FateRow& row, const online_change::UpdateStep& step,
                        const ir::Image& next) const;
  // By undo: what the variable of that name is then, in the version before; "" for what is the same
  // as now, or not known.
  std::string value_back(const ir::Image& before, const std::string& path) const;
  // The first of them, and how many there are.
  const std::vector<online_change::LiveLoss>& losses() const { return losses_; }
  uint64_t loss_count() const { return loss_count_; }
  bool whole() const { return whole_; }
  const online_change::LiveLoss* loss(const std::string& path) const;
  // The line of one variable: its value, what it becomes and what is lost.
  tools::FateLine line(const online_change::VariableFate& variable, const ir::Image& next) const;
  // What runs; by undo, the version that the edit made.
  const ir::VerifiedImage& version() const { return image_; }
  // The image of the program that runs, under the names of the next version.
  const ir::Image& image() const { return renamed_ ? *renamed_ : image_.image(); }

 private:
  LiveReport(vm::LiveCopy copy, ir::VerifiedImage image)
      : copy_(std::move(copy)), image_(std::move(image)) {}

  std::string result_of(const online_change::VariableFate& variable, const std::string& now,
                        const ir::Image& next) const;

  std::span<const uint8_t> memory() const { return undone_ ? undone_->view() : copy_.memory(); }
  void note_losses(std::vector<online_change::LiveLoss> losses, uint64_t count);

  vm::LiveCopy copy_;
  std::optional<vm::Memory> undone_;  // behind the undo of edits above; none: copy_
  std::optional<vm::Memory> before_;  // behind that of the edit itself
  ir::VerifiedImage image_;
  std::optional<ir::Image> renamed_;  // the same under the names of the next version
  std::vector<online_change::LiveLoss> losses_;
  uint64_t loss_count_ = 0;
  bool whole_ = false;
  std::unordered_map<std::string, size_t> by_path_;  // folded
};

}  // namespace stvm
