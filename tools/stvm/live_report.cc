#include "tools/stvm/live_report.h"

#include "ir/bytecode/renames.h"
#include "online_change/apply/losses.h"

namespace stvm {
base::Result<LiveReport> LiveReport::take(vm::Controller& controller,
                                          const online_change::Change& change,
                                          const ir::Image* next, const CopyRanges& copy_of) {
  std::vector<ir::DataRange> ranges;
  if (!change.keeps_all()) ranges.push_back({0, controller.image().data_capacity});
  base::Result<vm::LiveCopy> copy = copy_of(std::move(ranges));
  if (!copy.ok()) return copy.error();
  LiveReport report(std::move(*copy), controller.verified());
  if (next != nullptr) report.renamed_ = ir::under_new_names(report.image_.image(), *next);
  report.losses_ = change.live_losses(report.copy_.memory());
  report.loss_count_ = change.count_losses(report.copy_.memory());
  for (size_t i = 0; i < report.losses_.size(); ++i) {
    report.by_path_.emplace(ir::fold_name(report.losses_[i].path), i);
  }
  return report;
}

std::string LiveReport::value(const online_change::FateRow& row) const {
  const std::string& path = row.old_path.empty() ? row.path : row.old_path;
  base::Result<ir::Symbol> symbol = ir::find_symbol(image(), path);
  if (!symbol.ok()) return {};
  return online_change::shortened(ir::format_value(image(), *symbol, copy_.memory()));
}

const online_change::LiveLoss* LiveReport::loss(const std::string& path) const {
  const auto found = by_path_.find(ir::fold_name(path));
  return found == by_path_.end() ? nullptr : &losses_[found->second];
}

}  // namespace stvm
