#include "tools/stvm/fleet_walk.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>

namespace stvm {
namespace {

void say_who_is_left(const std::vector<FleetMember>& members, const std::vector<size_t>& left) {
  std::string names;
  for (const size_t i : left) names += (names.empty() ? "" : ", ") + members[i].name;
  std::fprintf(stderr, "waiting for: %s\n", names.c_str());
}

// Who answers is visited, and comes again only when it went away in between.
std::vector<FleetRow> when_they_answer(const std::vector<FleetMember>& members,
                                       const FleetWalk& how) {
  std::vector<FleetRow> rows(members.size());
  std::vector<size_t> left;
  for (size_t i = 0; i < members.size(); ++i) left.push_back(i);
  size_t said = 0;
  while (!left.empty()) {
    std::vector<size_t> still;
    for (const size_t i : left) {
      if (how.answers(members[i])) {
        rows[i] = how.visit(members[i]);
        how.told(members[i], rows[i]);
        if (rows[i].outcome == FleetOutcome::kNotAsked) return rows;  // nobody is to be asked
        if (rows[i].outcome != FleetOutcome::kUnreachable) continue;
      }
      still.push_back(i);
    }
    left = std::move(still);
    if (left.empty()) break;
    if (left.size() != said) say_who_is_left(members, left);
    said = left.size();
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  return rows;
}

}  // namespace

std::vector<FleetRow> walk(const std::vector<FleetMember>& members, const FleetWalk& how) {
  if (how.one_by_one) return when_they_answer(members, how);
  std::vector<FleetRow> rows(members.size());
  std::atomic<size_t> next{0};
  std::mutex telling;
  const auto work = [&] {
    for (size_t i = next++; i < members.size(); i = next++) {
      FleetRow row = how.visit(members[i]);
      const std::lock_guard<std::mutex> one(telling);
      rows[i] = std::move(row);
      how.told(members[i], rows[i]);
    }
  };
  std::vector<std::thread> others;
  for (size_t i = 1; i < how.jobs && i < members.size(); ++i) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  return rows;
}

}  // namespace stvm
