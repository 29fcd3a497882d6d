#include "tools/stvm/live_report.h"

#include <algorithm>
#include <cstring>

#include "ir/bytecode/renames.h"
#include "online_change/apply/losses.h"
#include "online_change/plan/pause.h"

namespace stvm {
namespace {

// Some tens of microseconds at a boundary.
constexpr uint32_t kSliceBytes = 128u << 10;

}  // namespace

base::Result<LiveReport> LiveReport::take(vm::Controller& controller,
                                          const online_change::Change& change,
                                          const ir::Image* next,
                                          const online_change::AtBoundary& at_boundary) {
  base::Result<vm::Memory> memory = vm::Memory::reserve();
  if (!memory.ok()) return memory.error();
  LiveReport report(std::move(*memory), controller.verified());
  if (next != nullptr) report.renamed_ = ir::under_new_names(report.image_.image(), *next);
  const uint32_t end = change.keeps_all() ? 0 : controller.image().data_capacity;
  for (uint32_t at = 0; at < end; at += std::min(kSliceBytes, end - at)) {
    uint8_t* const to = report.memory_.data() + at;
    const size_t size = std::min(kSliceBytes, end - at);
    std::memset(to, 1, size);  // its pages are there before the boundary
    base::Status taken = at_boundary([&] {
      std::memcpy(to, controller.memory().data() + at, size);
      controller.worked(static_cast<int64_t>(size) / online_change::kPauseBytesPerNs);
    });
    if (!taken.ok()) return taken.error();
  }
  report.losses_ = change.live_losses(report.memory_.view());
  for (size_t i = 0; i < report.losses_.size(); ++i) {
    report.by_path_.emplace(ir::fold_name(report.losses_[i].path), i);
  }
  return report;
}

std::string LiveReport::value(const online_change::FateRow& row) const {
  const std::string& path = row.old_path.empty() ? row.path : row.old_path;
  base::Result<ir::Symbol> symbol = ir::find_symbol(image(), path);
  if (!symbol.ok()) return {};
  return online_change::shortened(ir::format_value(image(), *symbol, memory_.view()));
}

const online_change::LiveLoss* LiveReport::loss(const std::string& path) const {
  const auto found = by_path_.find(ir::fold_name(path));
  return found == by_path_.end() ? nullptr : &losses_[found->second];
}

}  // namespace stvm
