#include "tools/stvm/live_report.h"

#include <cstring>

#include "ir/bytecode/renames.h"
#include "online_change/apply/live_value.h"
#include "online_change/apply/losses.h"
#include "online_change/diff/initial_data.h"

namespace stvm {
namespace {

// "" for a variable that is already what the constant is that takes its place.
std::string why_lost(const online_change::VariableFate& variable, const ir::Image& old_image,
                     std::span<const uint8_t> memory, const ir::Image& next) {
  const base::Result<ir::Symbol> there = ir::find_symbol(next, variable.path);
  if (variable.new_address == 0 || !there.ok()) return online_change::why_lost(nullptr);
  const base::Result<ir::Symbol> before = ir::find_symbol(old_image, variable.path);
  const bool same = there->constant && before.ok() &&
                    online_change::is_constant_already(old_image, *before, memory, next, *there);
  return same ? "" : online_change::why_lost(&*there);
}

// An edit that is taken out has its values in the plan (apply/values_back.h).
void initial_value(const online_change::VariableFate& variable, const ir::Image& next,
                   base::Bytes& value) {
  const online_change::UpdateStep& step = *variable.step;
  const base::Bytes& bytes = step.as<online_change::InitialValues>()->bytes;
  const size_t at =
      size_t{variable.index} * step.size + (variable.new_address - step.place(variable.index));
  if (at + value.size() <= bytes.size()) {
    std::memcpy(value.data(), bytes.data() + at, value.size());
  } else {
    online_change::InitialData(next).read(variable.new_address, value);
  }
}

}  // namespace

base::Result<LiveReport> LiveReport::take(vm::Controller& controller,
                                          const online_change::Change& change,
                                          const ir::Image* next, bool whole,
                                          const CopyRanges& copy_of) {
  std::vector<ir::DataRange> ranges = change.looked_at();
  if (whole) ranges = {{0, controller.image().data_capacity}};
  base::Result<vm::LiveCopy> copy = copy_of(std::move(ranges));
  if (!copy.ok()) return copy.error();
  LiveReport report(std::move(*copy), controller.verified());
  report.whole_ = whole || !change.keeps_all();
  if (next != nullptr) report.renamed_ = ir::under_new_names(report.image_.image(), *next);
  report.note_losses(change.live_losses(report.memory()), change.count_losses(report.memory()));
  return report;
}

void LiveReport::note_losses(std::vector<online_change::LiveLoss> losses, uint64_t count) {
  losses_ = std::move(losses);
  loss_count_ = count;
  for (size_t i = 0; i < losses_.size(); ++i) {
    by_path_.emplace(ir::fold_name(losses_[i].path), i);
  }
}

base::Result<LiveReport> LiveReport::take_back(const vm::Controller& controller,
                                               online_change::Change& change, size_t below,
                                               const CopyRanges& copy_of) {
  const bool code_alone = below == 0 && change.keeps_all();
  const uint32_t size = controller.image().data_capacity;
  base::Result<vm::LiveCopy> copy =
      copy_of(code_alone ? change.looked_at() : std::vector<ir::DataRange>{{0, size}});
  if (!copy.ok()) return copy.error();
  LiveReport report(std::move(*copy), change.way_back(below).from);
  if (code_alone) return report;
  base::Result<vm::Memory> memory = vm::Memory::reserve();
  if (!memory.ok()) return memory.error();
  std::memcpy(memory->data(), report.copy_.memory().data(), size);
  for (size_t i = 0; i < below; ++i) (void)change.imagine_undo(i, memory->data());
  if (below != 0) {
    base::Result<vm::Memory> undone = vm::Memory::reserve();
    if (!undone.ok()) return undone.error();
    const uint32_t undone_size = report.image().data_capacity;
    std::memcpy(undone->data(), memory->data(), undone_size);
    report.undone_ = std::move(*undone);
  }
  auto imagined = change.imagine_undo(below, memory->data());
  report.note_losses(std::move(imagined.losses), imagined.loss_count);
  report.before_ = std::move(*memory);
  return report;
}

std::string LiveReport::value_back(const ir::Image& before, const std::string& path) const {
  if (!before_) return {};
  base::Result<ir::Symbol> symbol = ir::find_symbol(before, path);
  if (!symbol.ok()) return {};
  return online_change::shortened(ir::format_value(before, *symbol, before_->view()));
}

std::string LiveReport::value(const online_change::FateRow& row) const {
  const std::string& path = row.old_path.empty() ? row.path : row.old_path;
  base::Result<ir::Symbol> symbol = ir::find_symbol(image(), path);
  if (!symbol.ok()) return {};
  return online_change::shortened(ir::format_value(image(), *symbol, memory()));
}

const online_change::LiveLoss* LiveReport::loss(const std::string& path) const {
  const auto found = by_path_.find(ir::fold_name(path));
  return found == by_path_.end() ? nullptr : &losses_[found->second];
}

// "" where only the switch knows it: what a migration or an input gives.
std::string LiveReport::result_of(const online_change::VariableFate& variable,
                                  const std::string& now, const ir::Image& next) const {
  if (variable.new_address == 0) return {};
  const online_change::UpdateStep* const step = variable.step;
  if (step == nullptr || step->as<online_change::CopiedValues>() != nullptr) return now;
  ir::Symbol alone;
  alone.type = variable.new_type;
  if (const auto there = ir::find_symbol(next, variable.path); there.ok()) {
    alone.bit_mask = there->bit_mask;
  }
  base::Bytes value(next.layouts[variable.new_type].size);
  if (step->as<online_change::InitialValues>() != nullptr) {
    const base::Result<ir::Symbol> there = ir::find_symbol(next, variable.path);
    if (there.ok() && there->input) return {};  // the plant says it
    initial_value(variable, next, value);
  } else if (const auto* converted = step->as<online_change::ConvertedValues>()) {
    const uint8_t* source = memory().data() + variable.old_address;
    const online_change::Conversions rules(image(), next);
    rules.convert(*converted, variable.index, source, variable.new_address, value);
  } else if (variable.gather != nullptr) {
    online_change::InitialData(next).read(variable.new_address, value);
    online_change::gather(*variable.gather, memory().data(), variable.new_address - step->to,
                          value);
  } else {
    return {};
  }
  return online_change::shortened(ir::format_value(next, alone, value));
}

std::string LiveReport::result_of(const online_change::FateRow& row,
                                  const online_change::UpdateStep& step,
                                  const ir::Image& next) const {
  const base::Result<ir::Symbol> there = ir::find_symbol(next, row.path);
  if (!there.ok() || there->data != step.to || next.layouts[there->type].size != step.size) {
    return {};
  }
  const ir::Kind kind = next.types[there->type].kind;
  const bool leaf =
      next.types.is_scalar(there->type) || kind == ir::Kind::kString || kind == ir::Kind::kWstring;
  if (!leaf) return {};
  online_change::VariableFate variable;
  variable.path = row.path;
  variable.old_address = step.source().value_or(online_change::CopiedValues{}).from;
  variable.new_address = step.to;
  variable.new_type = there->type;
  variable.step = &step;
  return result_of(variable, {}, next);
}

tools::FateLine LiveReport::line(const online_change::VariableFate& variable,
                                 const ir::Image& next) const {
  tools::FateLine out = tools::every_line(variable, image(), next);
  if (variable.old_address != 0) {
    ir::Symbol before;
    before.data = variable.old_address;
    before.type = variable.old_type;
    const std::string& path = variable.old_path.empty() ? variable.path : variable.old_path;
    if (const auto there = ir::find_symbol(image(), path); there.ok()) {
      before.bit_mask = there->bit_mask;
    }
    out.live.now = online_change::shortened(ir::format_value(image(), before, memory()));
  }
  out.live.after = result_of(variable, out.live.now, next);
  if (const online_change::LiveLoss* lost = loss(variable.path)) {
    out.live.loss = lost->what;
    if (!lost->new_value.empty()) out.live.after = lost->new_value;
  } else if (variable.loses) {
    out.live.loss = why_lost(variable, image(), memory(), next);
  }
  return out;
}

}  // namespace stvm
