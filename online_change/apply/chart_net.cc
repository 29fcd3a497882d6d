#include "online_change/apply/chart_net.h"

#include <algorithm>
#include <set>

namespace online_change {
namespace {

constexpr uint64_t kPrime = 2147483647;
constexpr uint64_t kMostWork = 1'000'000;

using Sum = std::map<uint32_t, uint64_t>;

void add(Sum& to, uint32_t coordinate, uint64_t value) {
  const auto [at, fresh] = to.emplace(coordinate, value % kPrime);
  if (!fresh) at->second = (at->second + value) % kPrime;
  if (at->second == 0) to.erase(at);
}

void add(Sum& to, const Sum& what, uint64_t times) {
  for (const auto& [coordinate, value] : what) add(to, coordinate, value * times);
}

uint64_t inverse(uint64_t value) {
  uint64_t result = 1;
  for (uint64_t left = kPrime - 2; left != 0; left >>= 1) {
    if ((left & 1) != 0) result = result * value % kPrime;
    value = value * value % kPrime;
  }
  return result;
}

std::set<ir::TypeId> with_bases(const ir::Image& image, ir::TypeId type) {
  std::set<ir::TypeId> all;
  while (image.types.contains(type) && image.types.is_instance(type) && all.insert(type).second) {
    type = image.types[type].base;
  }
  return all;
}

}  // namespace

ChartNet::ChartNet(const ir::Image& image, ir::TypeId type) {
  const std::set<ir::TypeId> types = with_bases(image, type);
  std::vector<ir::ChartMove> moves;
  for (const ir::LinkedChart& chart : image.charts) {
    if (!types.contains(image.pous[chart.pou].self)) continue;
    moves.insert(moves.end(), chart.moves.begin(), chart.moves.end());
  }
  join_networks(moves);
  if (!solve(moves)) sums_.clear();
}

void ChartNet::join_networks(const std::vector<ir::ChartMove>& moves) {
  const auto first_of = [&](uint32_t step) {
    uint32_t first = network_.emplace(step, step).first->second;
    while (network_[first] != first) first = network_[first];
    return network_[step] = first;
  };
  for (const ir::ChartMove& move : moves) {
    std::vector<uint32_t> steps = move.from;
    steps.insert(steps.end(), move.to.begin(), move.to.end());
    for (const uint32_t step : steps) {
      const auto [low, high] = std::minmax({first_of(steps.front()), first_of(step)});
      network_[high] = low;
    }
    if (move.from.empty()) initial_.insert(initial_.end(), move.to.begin(), move.to.end());
  }
  for (auto& [step, first] : network_) first = first_of(step);
}

bool ChartNet::solve(const std::vector<ir::ChartMove>& moves) {
  for (const ir::ChartMove& move : moves) {
    if (move.from.empty()) continue;
    Sum nothing;
    for (const uint32_t step : move.to) add(nothing, step, 1);
    for (const uint32_t step : move.from) add(nothing, step, kPrime - 1);
    Sum left = reduced(std::move(nothing));
    if (work_ > kMostWork) return false;
    if (left.empty()) continue;
    const auto [step, factor] = *left.rbegin();
    left.erase(step);
    add(sums_[step], left, kPrime - inverse(factor));
  }
  // What a step adds up to names steps before it only, so these are done.
  for (const auto& [step, first] : network_) {
    const auto known = sums_.find(step);
    sums_[step] = known == sums_.end() ? Sum{{step, 1}} : reduced(known->second);
    if (work_ > kMostWork) return false;
  }
  return true;
}

ChartNet::Sum ChartNet::reduced(Sum sum) {
  Sum left;
  while (!sum.empty() && work_ <= kMostWork) {
    const auto [step, factor] = *sum.rbegin();
    sum.erase(step);
    const auto known = sums_.find(step);
    if (known == sums_.end() || known->second == Sum{{step, 1}}) {
      left.emplace(step, factor);
      work_ += 1;
    } else {
      add(sum, known->second, factor);
      work_ += 1 + known->second.size();
    }
  }
  return left;
}

bool ChartNet::reaches(const std::vector<uint32_t>& active) const {
  Sum sum;
  std::set<uint32_t> begun;
  for (const uint32_t step : active) {
    const auto known = sums_.find(step);
    if (known == sums_.end()) return false;
    add(sum, known->second, 1);
    begun.insert(network_.at(step));
  }
  for (const uint32_t step : initial_) {
    if (begun.contains(network_.at(step))) add(sum, sums_.at(step), kPrime - 1);
  }
  return sum.empty();
}

}  // namespace online_change
