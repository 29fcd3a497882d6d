// The fate report of a change that is staged, rehearsed or on trial (its way back), page by page.
#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "ir/bytecode/renames.h"
#include "online_change/diff/initial_data.h"
#include "tools/common/old_names.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/force_edits.h"
#include "tools/stvm/shown_edits.h"

namespace stvm {
namespace {

using online_change::Fate;
using online_change::FateRow;
using online_change::StepKind;
using online_change::UpdateStep;

constexpr uint64_t kLinesPerPage = 1000;
constexpr size_t kShownLosses = 500;
constexpr size_t kVariablesPerPage = 5000;
constexpr uint64_t kMostEvery = 2'000'000;  // values of a plan, of which each is looked up

// Initial value of a scalar or string of the new version; "" for anything else.
std::string initial_text(const ir::Image& image, const std::string& path) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image, path);
  if (!symbol.ok()) return {};
  ir::Kind kind = image.types[symbol->type].kind;
  bool leaf = image.types.is_scalar(symbol->type) || kind == ir::Kind::kString ||
              kind == ir::Kind::kWstring;
  if (!leaf) return {};
  base::Bytes value(image.layouts[symbol->type].size);
  online_change::InitialData(image).read(symbol->data, value);
  ir::Symbol alone = *symbol;
  alone.data = 0;
  return ir::format_value(image, alone, value);
}

// The text of the old value as a value of the new type; "" where it is none.
std::string converted_text(const ir::Image& image, const std::string& path,
                           const std::string& now) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image, path);
  if (!symbol.ok()) return {};
  base::Result<base::Bytes> value = ir::parse_value(image, symbol->type, now);
  if (!value.ok()) return {};
  ir::Symbol alone = *symbol;
  alone.data = 0;
  return ir::format_value(image, alone, *value);
}

uint64_t line_bytes(const FateLine& line) {
  return line.row.path.size() + line.row.old_type.size() + line.row.new_type.size() +
         line.row.reason.size() + line.live.now.size() + line.live.after.size() +
         line.live.loss.size() + 64;
}

// Of rows from `first` to before `end`: their step, where it has bytes of its own; else null. What
// is made anew, and what an edit had converted that is taken out.
std::vector<const UpdateStep*> with_bytes(const online_change::Plan& plan, uint64_t first,
                                          uint64_t end) {
  std::vector<const UpdateStep*> steps(end - std::min(first, end));
  for (const UpdateStep& step : plan.steps) {
    if (step.fate == online_change::kNoFate || step.fate < first || step.fate >= end) continue;
    const auto* initial = step.as<online_change::InitialValues>();
    const auto* converted = step.as<online_change::ConvertedValues>();
    const bool has = (initial != nullptr && !initial->bytes.empty()) ||
                     (converted != nullptr && !converted->known.empty());
    if (step.count == 1 && has) steps[step.fate - first] = &step;
  }
  return steps;
}

FateLine with_loss(const LiveReport& live, FateLine line, const std::string& path) {
  // The value of one of several says nothing of the others: they are told one by one.
  if (online_change::stands_for_several(line.row)) {
    line.live = {};
  } else if (line.row.old_type.empty()) {  // what it takes the place of has a row of its own
  } else if (const online_change::LiveLoss* loss = live.loss(path)) {
    line.live = {loss->old_value, loss->new_value, loss->what};
  }
  return line;
}

// With the resulting value, and its loss when there is one.
FateLine live_line(const LiveReport& live, const FateRow& row,
                   const online_change::UpdateStep* known, const ir::Image& next) {
  FateLine line{row, {}};
  if (row.count == 1 && !row.old_type.empty()) line.live.now = live.value(row);
  if (row.fate == Fate::kMoved || row.fate == Fate::kKept) {
    line.live.after = line.live.now;
  } else if (known != nullptr && row.count == 1) {
    line.live.after = live.result_of(row, *known, next);
  } else if (row.fate == Fate::kInitialised && row.count == 1) {
    line.live.after = initial_text(next, row.path);
  } else if (row.fate == Fate::kConverted && !line.live.now.empty()) {
    line.live.after = converted_text(next, row.path, line.live.now);
  }
  return with_loss(live, std::move(line), row.path);
}

// By undo: what it takes back is shown as it will be, whatever it was made of. `path`: its name in
// the version before.
FateLine line_back(const LiveReport& live, const FateRow& row, const std::string& path,
                   const ir::Image& before) {
  FateLine line{row, {}};
  if (row.count == 1 && !row.old_type.empty()) line.live.now = live.value(row);
  const bool comes = row.fate == Fate::kInitialised || row.fate == Fate::kConverted;
  if (!comes) line.live.after = line.live.now;
  if (comes && row.count == 1) line.live.after = live.value_back(before, path);
  if (row.fate == Fate::kInitialised) line.row.reason = "as it was before the change";
  if (row.fate == Fate::kConverted) {
    line.row.reason = live.loss(path) == nullptr
                          ? "as it was before the change, unless written since"
                          : "written since the change";
  }
  return with_loss(live, std::move(line), path);
}

}  // namespace

// The report borrows the plan and the images of its change, so it ends before they do.
void ControllerService::forget_report() {
  every_.reset();
  live_.reset();
}

// Takes the live values; other pages show the same ones.
base::Status ControllerService::look(const ir::Image* next, bool whole) {
  forget_report();
  vm::Controller& controller = rehearses() ? rehearsal_->controller() : controller_;
  auto taken = LiveReport::take(controller, looked_at(), next, whole,
                                [this](auto ranges) { return copy_of(std::move(ranges)); });
  if (!taken.ok()) return taken.error();
  live_.emplace(std::move(*taken));
  live_of_ = session_;
  return base::Ok{};
}

// The values behind the undo of the newest edits, `below` of them.
base::Status ControllerService::look_back(size_t below) {
  forget_report();
  auto taken = LiveReport::take_back(controller_, change_, below,
                                     [this](auto ranges) { return copy_of(std::move(ranges)); });
  if (!taken.ok()) return taken.error();
  live_.emplace(std::move(*taken));
  live_of_ = session_;
  return base::Ok{};
}

base::Result<base::Bytes> ControllerService::fates(const vm::Request& request) {
  if (base::Status there = check_not_gone(); !there.ok()) return there.error();
  if (base::Status kept = check_not_aborted(); !kept.ok()) return kept.error();
  const online_change::Change& change = looked_at();
  const bool back = change.state() == online_change::State::kTrial && previous() != nullptr;
  if (!back && change.next() == nullptr) {
    return base::Error{base::Refusal::kBusy, "no change is staged, and none is on trial"};
  }
  if (back) {
    if (base::Status primed = change_.prime(); !primed.ok()) return primed.error();
  }
  size_t below = 0;
  if (back && request.names.size() > 1) {
    const auto named = std::ranges::find_if(
        trials_, [&](const Trial& trial) { return trial.edit.name == request.names[1]; });
    if (named == trials_.end()) {
      return base::Error{base::Refusal::kNothingToUndo,
                         "`" + request.names[1] + "` is not on trial"};
    }
    below = static_cast<size_t>(trials_.end() - named) - 1;
  }
  const ir::VerifiedImage& next_version = back ? change.way_back(below).to : *change.next();
  const ir::Image& next_image = next_version.image();
  const bool every = !request.names.empty() && request.names.front() == vm::kEveryVariable;
  if (every && back) {
    return base::Error{base::Refusal::kBusy, "the way back is shown by groups of variables only"};
  }
  const bool later = request.offset != 0 || every;
  if (!later || !live_ || live_of_ != session_ || (every && !live_->whole())) {
    base::Status looked = back ? look_back(below) : look(&next_image, every);
    if (!looked.ok()) return looked.error();
  }
  const online_change::Plan& plan = back ? change.way_back(below).plan : change.plan();
  FatePage page;
  page.counts = plan.counts;
  page.predicted_pause_ns =
      back ? change.way_back(below).predicted_pause_ns : change.predicted_pause_ns();
  page.boundary_bytes = plan.boundary_bytes;
  page.loss_count = live_->loss_count();
  const bool first_page = !every && request.offset == 0;
  const bool skips = !request.names.empty() && request.names.front() == vm::kWithoutExit;
  if (back && skips && !change.way_back(below).leaving.empty()) {
    page.system.push_back({"FB_Exit",
                           instances_text(live_->image(), change.way_back(below).leaving),
                           "does not run for what goes"});
  }
  if (first_page && (!back || below == 0)) {
    const vm::Controller& shown = rehearses() ? rehearsal_->controller() : controller_;
    std::ranges::move(force_edits(shown.image(), shown.forces(), next_image, change.next_forces()),
                      std::back_inserter(page.system));
  }
  return every ? every_page(request.offset, plan, next_image, std::move(page))
               : group_page(request.offset, plan, next_version, back, std::move(page));
}

base::Result<base::Bytes> ControllerService::every_page(uint64_t first,
                                                        const online_change::Plan& plan,
                                                        const ir::Image& next, FatePage page) {
  uint64_t values = 0;
  for (const online_change::UpdateStep& step : plan.steps) values += step.count;
  if (values > kMostEvery) {
    return base::Error{base::Refusal::kTooLarge, "the change touches " + std::to_string(values) +
                                                     " values; --all shows " +
                                                     std::to_string(kMostEvery) + " at most"};
  }
  if (!every_) every_.emplace(plan, live_->image(), next);
  const tools::OldNames old_names(controller_.image(), live_->image());
  uint64_t bytes = 0;
  page.next = every_->visit_from(first, [&](const online_change::VariableFate& variable) {
    page.lines.push_back(live_->line(variable, next));
    old_names.tell(page.lines.back());
    bytes += line_bytes(page.lines.back());
    return bytes <= vm::kChunkBytes && page.lines.size() < kVariablesPerPage;
  });
  return encode(page);
}

base::Result<base::Bytes> ControllerService::group_page(uint64_t first,
                                                        const online_change::Plan& plan,
                                                        const ir::VerifiedImage& next, bool back,
                                                        FatePage page) const {
  uint64_t bytes = 0;
  uint64_t row = first;
  const uint64_t end = std::min<uint64_t>(plan.fates.size(), first + kLinesPerPage);
  const std::vector<const UpdateStep*> known = with_bytes(plan, first, end);
  std::optional<ir::OldUnderNewNames> comes;  // by undo: the plan has the names of what runs
  if (back) comes.emplace(next.image(), live_->image());
  for (; row < end && bytes <= vm::kChunkBytes; ++row) {
    const FateRow& fate = plan.fates[row];
    const bool named = comes && fate.fate != Fate::kDropped;
    std::string own = named ? ir::own_path(next.image(), comes->image(), fate.path) : fate.path;
    if (own.empty()) own = fate.path;
    page.lines.push_back(back ? line_back(*live_, fate, own, next.image())
                              : live_line(*live_, fate, known[row - first], next.image()));
    page.lines.back().row.path = std::move(own);
    bytes += line_bytes(page.lines.back());
  }
  page.next = row < plan.fates.size() ? row : 0;
  if (first != 0) return encode(page);
  for (size_t i = 0; i < std::min(live_->losses().size(), kShownLosses); ++i) {
    page.losses.push_back({live_->losses()[i]});
  }
  page.edits = shown_edits(live_->version(), next);
  std::ranges::move(shown_system(live_->version(), next, back), std::back_inserter(page.system));
  return encode(page);
}

}  // namespace stvm
