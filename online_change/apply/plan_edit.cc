#include "online_change/apply/plan_edit.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "online_change/apply/live_value.h"

namespace online_change {
namespace {

constexpr std::string_view kAsBefore = "as before the edit that is taken out";
constexpr std::string_view kUnlessWritten = ", unless written since";

// "; and 3 more like it" stays at the end.
void add_reason(FateRow& row, const std::string& what) {
  std::string more;
  if (stands_for_several(row)) {
    const size_t at = row.reason.rfind("; and ");
    more = row.reason.substr(at);
    row.reason.resize(at);
  }
  row.reason += (row.reason.empty() ? "" : ", ") + what + more;
}

std::string as_before(const FateRow& row) {
  std::string text(kAsBefore);
  if (row.fate == Fate::kConverted) text += kUnlessWritten;
  return text;
}

}  // namespace

PlanEdit::PlanEdit(Plan& plan, const ir::Image& running, const ir::Image& next)
    : plan_(plan), running_(running), next_(next) {
  for (uint32_t number = 0; number < plan.steps.size(); ++number) {
    const UpdateStep& step = plan.steps[number];
    for (uint32_t i = 0; i < step.count; ++i) {
      places_.push_back({step.place(i), step.size, number, i});
    }
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.to < b.to; });
}

const PlanEdit::Place* PlanEdit::writes(uint32_t to, uint32_t size) const {
  auto found = std::upper_bound(places_.begin(), places_.end(), to,
                                [](uint32_t at, const Place& one) { return at < one.to; });
  if (found == places_.begin()) return nullptr;
  const Place& place = *--found;
  return uint64_t{to} + size <= uint64_t{place.to} + place.size ? &place : nullptr;
}

void PlanEdit::count_row(uint32_t fate) {
  ++count_;
  if (fate != kNoFate) ++values_of_row_[fate];
}

void PlanEdit::initialise(uint32_t to, std::span<const uint8_t> value) {
  const Place* const place = writes(to, static_cast<uint32_t>(value.size()));
  if (place == nullptr) return;
  UpdateStep& step = plan_.steps[place->step];
  auto* const initial = step.as<InitialValues>();
  if (initial == nullptr) return;
  initial->bytes.resize(step.total());
  const size_t at = size_t{place->index} * step.size + (to - place->to);
  std::memcpy(initial->bytes.data() + at, value.data(), value.size());
  count_row(step.fate);
}

void PlanEdit::convert(const ir::Symbol& now, const std::string& path, const ir::Symbol& here,
                       std::span<const uint8_t> made, const uint8_t* value) {
  const uint32_t size = next_.layouts[here.type].size;
  if (running_.layouts[now.type].size != made.size()) return;
  const Place* const place = writes(here.data, size);
  UpdateStep one;
  one.to = here.data;
  one.size = size;
  one.how = ConvertedValues{now.data, 0, now.type, here.type, {}};
  if (place == nullptr) {
    if (now.data != here.data) return;
    know(one, 0, made, value);
    one.fate = own_row(now.type, here.type, path);
    --plan_.counts.kept;
    plan_.boundary_bytes += size;
    added_.push_back(std::move(one));
    return;
  }
  UpdateStep& step = plan_.steps[place->step];
  const uint32_t within = here.data - place->to;
  const std::optional<CopiedValues> source = step.source();
  if (!source || source->from + place->index * source->from_stride + within != now.data) return;
  const auto* converted = step.as<ConvertedValues>();
  if (converted != nullptr && within == 0 && step.size == size &&
      running_.layouts[converted->old_type].size == made.size()) {
    know(step, place->index, made, value);
    count_row(step.fate);
  } else if (step.as<CopiedValues>() != nullptr) {
    know(one, 0, made, value);
    if (step.fate != kNoFate) --plan_.fates[step.fate].count;
    one.fate = own_row(now.type, here.type, path);
    --plan_.counts.moved;
    cuts_.push_back({place->step, uint64_t{place->index} * step.size + within, std::move(one)});
  }
}

// Of a value that had none, or shared it with what only moves.
uint32_t PlanEdit::own_row(ir::TypeId old_type, ir::TypeId new_type, const std::string& path) {
  ++count_;
  ++plan_.counts.converted;
  FateRow row;
  row.fate = Fate::kConverted;
  row.old_type = running_.types.text(old_type);
  row.new_type = next_.types.text(new_type);
  const auto number = static_cast<uint32_t>(plan_.fates.size());
  const auto [known, is_new] = own_rows_.emplace(row.old_type + "\n" + row.new_type, number);
  if (!is_new) {
    ++plan_.fates[known->second].count;
    return known->second;
  }
  row.path = path;
  row.reason = as_before(row);
  plan_.fates.push_back(std::move(row));
  return number;
}

void PlanEdit::cut(const UpdateStep& step, std::span<const Cut> cuts,
                   std::vector<UpdateStep>& out) const {
  uint64_t done = 0;
  const auto copy_to = [&](uint64_t end) {
    while (done < end) {
      const auto index = static_cast<uint32_t>(done / step.size);
      const auto within = static_cast<uint32_t>(done % step.size);
      UpdateStep part = step;
      part.as<CopiedValues>()->from += index * part.as<CopiedValues>()->from_stride + within;
      part.to = step.place(index) + within;
      const bool whole = within == 0 && end - done >= step.size;
      part.count = whole ? static_cast<uint32_t>((end - done) / step.size) : 1;
      if (!whole)
        part.size = static_cast<uint32_t>(std::min(end - done, uint64_t{step.size - within}));
      done += part.total();
      out.push_back(std::move(part));
    }
  };
  for (const Cut& one : cuts) {
    copy_to(one.at);
    out.push_back(one.made);
    done += one.made.size;
  }
  copy_to(step.total());
}

void PlanEdit::cut_steps() {
  if (cuts_.empty()) return;
  std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
    return std::pair(a.step, a.at) < std::pair(b.step, b.at);
  });
  std::vector<UpdateStep> steps;
  auto next = cuts_.begin();
  for (uint32_t number = 0; number < plan_.steps.size(); ++number) {
    const auto first = next;
    while (next != cuts_.end() && next->step == number) ++next;
    if (first == next) {
      steps.push_back(std::move(plan_.steps[number]));
    } else {
      cut(plan_.steps[number], {first, next}, steps);
    }
  }
  plan_.steps = std::move(steps);
}

void PlanEdit::tell_rows() {
  for (const auto& [number, values] : values_of_row_) {
    FateRow& row = plan_.fates[number];
    add_reason(row, (values < row.count ? "some " : "") + as_before(row));
  }
  for (const auto& [types, number] : own_rows_) {
    FateRow& row = plan_.fates[number];
    if (row.count == 1) continue;
    row.reason += "; and " + std::to_string(row.count - 1) + std::string(kMoreLikeIt);
  }
  if (!cuts_.empty()) drop_empty_rows();
}

// Groups of which nothing is left but what has a row of its own now.
void PlanEdit::drop_empty_rows() {
  std::vector<uint32_t> number_of(plan_.fates.size(), kNoFate);
  std::vector<FateRow> rows;
  for (size_t i = 0; i < plan_.fates.size(); ++i) {
    FateRow& row = plan_.fates[i];
    if (row.fate == Fate::kMoved && row.count == 0) continue;
    number_of[i] = static_cast<uint32_t>(rows.size());
    rows.push_back(std::move(row));
  }
  plan_.fates = std::move(rows);
  for (UpdateStep& step : plan_.steps) {
    if (step.fate != kNoFate) step.fate = number_of[step.fate];
  }
}

uint64_t PlanEdit::finish() {
  cut_steps();
  for (UpdateStep& step : added_) plan_.steps.push_back(std::move(step));
  tell_rows();
  return count_;
}

}  // namespace online_change
