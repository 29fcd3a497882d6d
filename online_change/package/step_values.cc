#include "online_change/package/step_values.h"

#include <algorithm>
#include <map>
#include <queue>

namespace online_change {

StepValues::StepValues(const std::vector<UpdateStep>& steps) {
  make_combs(steps);
  make_ends();
}

void StepValues::make_combs(const std::vector<UpdateStep>& steps) {
  std::vector<uint32_t> order(steps.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto by_place = [&](uint32_t a, uint32_t b) { return steps[a].to < steps[b].to; };
  if (!std::is_sorted(order.begin(), order.end(), by_place)) {
    std::stable_sort(order.begin(), order.end(), by_place);
  }
  std::vector<uint32_t> comb_of(steps.size());
  std::map<uint32_t, uint32_t> last;  // comb, by stride
  for (const uint32_t number : order) {
    const UpdateStep& step = steps[number];
    const uint64_t period_end = uint64_t{step.to_stride} * (step.count - 1);
    const auto known = step.count > 1 ? last.find(step.to_stride) : last.end();
    if (known != last.end()) {
      Comb& comb = combs_[known->second];
      const uint64_t behind = comb.end - period_end;  // its last tooth, in the first turn
      if (comb.count == step.count && step.to >= behind &&
          uint64_t{step.to} + step.size <= uint64_t{comb.begin} + comb.stride) {
        comb_of[number] = known->second;
        ++comb.teeth;
        comb.end = step.to + period_end + step.size;
        continue;
      }
    }
    comb_of[number] = static_cast<uint32_t>(combs_.size());
    const uint32_t stride = step.count > 1 ? step.to_stride : step.size;
    combs_.push_back({step.to, stride, step.count, 0, 1, step.to + period_end + step.size});
    if (step.count > 1) last[step.to_stride] = comb_of[number];
  }
  uint32_t first = 0;
  for (Comb& comb : combs_) {
    comb.first = first;
    first += comb.teeth;
    comb.teeth = 0;
  }
  teeth_.resize(first);
  for (const uint32_t number : order) {
    Comb& comb = combs_[comb_of[number]];
    teeth_[comb.first + comb.teeth++] = {steps[number].to - comb.begin, steps[number].size, number};
  }
}

void StepValues::make_ends() {
  while (leaves_ < combs_.size()) leaves_ *= 2;
  ends_.resize(2 * leaves_);
  for (size_t i = 0; i < combs_.size(); ++i) ends_[leaves_ + i] = combs_[i].end;
  for (size_t i = leaves_ - 1; i > 0; --i) ends_[i] = std::max(ends_[2 * i], ends_[2 * i + 1]);
}

StepValue StepValues::value(const Place& place) const {
  const Comb& comb = combs_[place.comb];
  const Tooth& tooth = teeth_[comb.first + place.tooth];
  return {comb.begin + place.turn * comb.stride + tooth.phase, tooth.size, tooth.step, place.turn};
}

bool StepValues::next(Place& place) const {
  const Comb& comb = combs_[place.comb];
  if (++place.tooth < comb.teeth) return true;
  place.tooth = 0;
  return ++place.turn < comb.count;
}

// `place` lies between the beginning and the end of the comb.
StepValue StepValues::first_in(uint32_t number, uint32_t place) const {
  const Comb& comb = combs_[number];
  const uint32_t offset = place - comb.begin;
  const uint32_t turn = std::min(offset / comb.stride, comb.count - 1);
  const uint32_t phase = offset - turn * comb.stride;
  const auto begin = teeth_.begin() + comb.first;
  const auto found = std::partition_point(begin, begin + comb.teeth, [&](const Tooth& tooth) {
    return uint64_t{tooth.phase} + tooth.size <= phase;
  });
  const auto tooth = static_cast<uint32_t>(found - begin);
  return tooth < comb.teeth ? value({number, tooth, turn}) : value({number, 0, turn + 1});
}

std::optional<StepValue> StepValues::first_behind(uint32_t place) const {
  const auto behind = std::partition_point(combs_.begin(), combs_.end(),
                                           [&](const Comb& comb) { return comb.begin <= place; });
  const auto begun = static_cast<size_t>(behind - combs_.begin());
  std::optional<StepValue> best;
  if (begun < combs_.size()) best = value({static_cast<uint32_t>(begun), 0, 0});
  // Looks at the combs begun that end after the place.
  const auto look = [&](const auto& self, size_t node, size_t first, size_t count) -> void {
    if (first >= begun || ends_[node] <= place) return;
    if (node >= leaves_) {
      const StepValue found = first_in(static_cast<uint32_t>(first), place);
      if (!best || found.to < best->to) best = found;
      return;
    }
    self(self, 2 * node, first, count / 2);
    self(self, 2 * node + 1, first + count / 2, count / 2);
  };
  look(look, 1, 0, leaves_);
  return best;
}

std::optional<uint32_t> StepValues::overlap() const {
  for (size_t first = 0; first < combs_.size();) {
    uint64_t end = combs_[first].end;
    size_t behind = first + 1;
    for (; behind < combs_.size() && combs_[behind].begin < end; ++behind) {
      end = std::max(end, combs_[behind].end);
    }
    uint32_t at = 0;
    if (behind - first > 1 && overlaps_inside(first, behind, at)) return at;
    first = behind;
  }
  return std::nullopt;
}

bool StepValues::overlaps_inside(size_t first, size_t behind, uint32_t& at) const {
  const auto later = [this](const Place& a, const Place& b) { return value(a).to > value(b).to; };
  std::priority_queue<Place, std::vector<Place>, decltype(later)> coming(later);
  for (size_t i = first; i < behind; ++i) coming.push({static_cast<uint32_t>(i), 0, 0});
  uint64_t end = 0;
  while (!coming.empty()) {
    Place place = coming.top();
    coming.pop();
    const StepValue now = value(place);
    at = now.to;
    if (now.to < end) return true;
    end = now.end();
    if (next(place)) coming.push(place);
  }
  return false;
}

}  // namespace online_change
