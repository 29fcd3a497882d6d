#include "online_change/plan/by_address.h"

#include <algorithm>
#include <unordered_map>

namespace online_change {
namespace {

constexpr const char* kStays = "its bytes stay at their address";
constexpr const char* kStaysInPart =
    "bytes stay at their address, others begin with their initial value";

bool by_begin(const auto& a, const auto& b) { return a.begin < b.begin; }

// Does each bit of the variable come from somewhere?
bool gives_all(const Gather& parts, const AddressedVariable& variable) {
  uint64_t bits = 0;
  for (const AddressRun& run : variable.runs) bits += run.bits;
  for (const GatheredPart& part : parts) bits -= part.size == 0 ? 1 : uint64_t{part.size} * 8;
  return bits == 0;
}

}  // namespace

ByAddress::ByAddress(const ir::Image& old_image, const ir::Image& new_image, Plan& plan)
    : old_(old_image), new_(new_image), plan_(plan), new_areas_(new_image) {}

void ByAddress::run() {
  std::vector<AddressedVariable> after = addressed_variables(new_);
  if (after.empty()) return;
  const std::vector<AddressedVariable> before = addressed_variables(old_);
  if (before.empty()) return;
  find_ranges();
  if (initial_.empty()) return;
  const AddressBits bits(before);
  bool any = false;
  for (const AddressedVariable& variable : after) any = make(variable, bits) || any;
  if (!any) return;
  plan_.steps.insert(plan_.steps.end(), more_.begin(), more_.end());
  std::erase_if(plan_.steps, [](const UpdateStep& step) { return step.size == 0; });
  std::stable_sort(plan_.steps.begin(), plan_.steps.end(),
                   [](const UpdateStep& a, const UpdateStep& b) { return a.to < b.to; });
  keep_dropped(before);
  drop_empty_rows();
}

void ByAddress::find_ranges() {
  for (size_t i = 0; i < plan_.steps.size(); ++i) {
    const UpdateStep& step = plan_.steps[i];
    const uint64_t last = step.count - 1;
    written_.push_back({step.to, step.to + step.hull()});
    if (step.as<InitialValues>() != nullptr) {
      if (step.count == 1) initial_.emplace_back(step.to, i);
    } else if (const auto* converted = step.as<ConvertedValues>()) {
      const uint32_t size = old_.layouts[converted->old_type].size;
      read_.push_back({converted->from, converted->from + last * converted->from_stride + size});
    } else if (const auto* copied = step.as<CopiedValues>()) {
      read_.push_back({copied->from, copied->from + last * copied->from_stride + step.size});
    }
  }
  std::sort(initial_.begin(), initial_.end());
  for (std::vector<Range>* ranges : {&written_, &read_}) {
    std::sort(ranges->begin(), ranges->end(), by_begin<Range, Range>);
    uint64_t end = 0;  // each ends where the furthest of those before it does
    for (Range& range : *ranges) end = range.end = std::max(end, range.end);
  }
}

bool ByAddress::meets(const std::vector<Range>& sorted, uint64_t begin, uint64_t end) {
  const auto behind = std::partition_point(sorted.begin(), sorted.end(),
                                           [&](const Range& range) { return range.begin < end; });
  return behind != sorted.begin() && (behind - 1)->end > begin;
}

// Has nothing of the new version these bytes, by its name?
bool ByAddress::goes(const GatheredPart& part) const {
  const uint32_t size = std::max(part.size, 1u);
  const uint64_t end = uint64_t{part.from} + size;
  if (meets(read_, part.from, end)) return false;
  return meets(written_, part.from, end) || !new_areas_.owns(part.from, size);
}

bool ByAddress::make(const AddressedVariable& variable, const AddressBits& before) {
  const auto behind =
      std::upper_bound(initial_.begin(), initial_.end(), std::pair(variable.data, SIZE_MAX));
  if (!variable.any_bits || behind == initial_.begin()) return false;
  const size_t number = (behind - 1)->second;
  const UpdateStep step = plan_.steps[number];
  const uint64_t end = uint64_t{variable.data} + variable.size;
  if (step.size == 0 || step.to > variable.data || uint64_t{step.to} + step.size < end) {
    return false;
  }
  Gather parts = before.parts_of(variable);
  std::erase_if(parts, [&](const GatheredPart& part) { return !goes(part); });
  if (parts.empty() || step.fate == kNoFate) return false;
  const bool whole = gives_all(parts, variable);
  const FateRow& row = plan_.fates[step.fate];
  const bool retyped = !row.old_type.empty();
  if (row.reason.starts_with("constant") || (retyped && !whole)) return false;
  UpdateStep made;
  made.how = GatheredBits{static_cast<uint32_t>(plan_.gathers.size()), {}};
  made.to = variable.data;
  made.size = variable.size;
  made.fate = row_for(variable, step, whole);
  taken_.add(parts);
  plan_.gathers.push_back(std::move(parts));
  split(number, variable, std::move(made));
  return true;
}

// The variable leaves the row that says that it is initialised.
uint32_t ByAddress::row_for(const AddressedVariable& variable, const UpdateStep& step, bool whole) {
  FateRow& from = plan_.fates[step.fate];
  const bool alone = step.to == variable.data && step.size == variable.size;
  uint64_t leaves = alone && !stands_for_several(from) ? from.count : 1;
  leaves = std::min(leaves, from.count);
  from.count -= leaves;
  if (from.count == 0) emptied_.push_back(step.fate);
  plan_.counts.initialised -= std::min(plan_.counts.initialised, leaves);
  plan_.counts.moved += leaves;
  FateRow row;
  row.fate = Fate::kMoved;
  row.path = variable.path;
  row.old_type = from.old_type;
  if (alone) row.new_type = from.new_type;
  row.reason = whole ? kStays : kStaysInPart;
  row.count = leaves;
  plan_.fates.push_back(std::move(row));
  return static_cast<uint32_t>(plan_.fates.size() - 1);
}

// What is left of the step lies in front of the variable and after it.
void ByAddress::split(size_t number, const AddressedVariable& variable, UpdateStep made) {
  const UpdateStep step = plan_.steps[number];
  const auto& initial = *step.as<InitialValues>();
  const auto bytes = [&](uint32_t begin, uint32_t end) {
    if (initial.bytes.empty()) return base::Bytes();
    const auto first = initial.bytes.begin() + (begin - step.to);
    return base::Bytes(first, first + (end - begin));
  };
  const auto part = [&](uint32_t begin, uint32_t end) {
    UpdateStep out = step;
    out.to = begin;
    out.size = end - begin;
    out.as<InitialValues>()->bytes = bytes(begin, end);
    return out;
  };
  const uint32_t begin = variable.data;
  const uint32_t end = begin + variable.size;
  made.as<GatheredBits>()->rest = bytes(begin, end);
  UpdateStep& front = plan_.steps[number];
  front = part(step.to, begin);
  more_.push_back(std::move(made));
  if (end == step.to + step.size) return;
  // Variables come in the order of io rows, which is not that of places: the rest is found, too.
  initial_.insert(std::upper_bound(initial_.begin(), initial_.end(), std::pair(end, size_t{0})),
                  {end, plan_.steps.size()});
  plan_.steps.push_back(part(end, step.to + step.size));
}

// All bytes of these go on: no value is dropped.
void ByAddress::keep_dropped(const std::vector<AddressedVariable>& before) {
  const auto is_taken = [&](const AddressRun& run) {
    return taken_.all(run.data, run.data + std::max<uint64_t>(run.bits / 8, 1));
  };
  std::unordered_map<std::string, const AddressedVariable*> by_path;
  for (const AddressedVariable& variable : before) by_path.emplace(variable.path, &variable);
  for (uint32_t number = 0; number < plan_.fates.size(); ++number) {
    FateRow& row = plan_.fates[number];
    if (row.fate != Fate::kDropped || stands_for_several(row)) continue;
    const auto found = by_path.find(row.path);
    if (found == by_path.end() || found->second->runs.empty()) continue;
    const std::vector<AddressRun>& runs = found->second->runs;
    if (!std::all_of(runs.begin(), runs.end(), is_taken)) continue;
    plan_.counts.dropped -= std::min(plan_.counts.dropped, row.count);
    emptied_.push_back(number);
  }
}

void ByAddress::drop_empty_rows() {
  std::sort(emptied_.begin(), emptied_.end());
  std::vector<uint32_t> number(plan_.fates.size(), kNoFate);
  uint32_t kept = 0;
  for (uint32_t i = 0; i < plan_.fates.size(); ++i) {
    if (std::binary_search(emptied_.begin(), emptied_.end(), i)) continue;
    if (kept != i) plan_.fates[kept] = std::move(plan_.fates[i]);
    number[i] = kept++;
  }
  plan_.fates.resize(kept);
  for (UpdateStep& step : plan_.steps) {
    if (step.fate != kNoFate) step.fate = number[step.fate];
  }
}

}  // namespace online_change
