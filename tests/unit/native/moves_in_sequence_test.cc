// Moves at once: one after the other they have the same effect, in time that grows with their
// number.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "tests/growth.h"
#include "vm/native/allocate.h"

namespace vm::native {
namespace {

using Cell = std::tuple<int, bool, uint32_t>;

Cell cell(const Place& place) { return {place.kind, place.floating, place.number}; }

Place a_place(uint32_t number) {
  constexpr uint32_t kRegisters = 16;
  if (number < kRegisters) return {Place::kRegister, false, false, number, 0};
  if (number < 2 * kRegisters) return {Place::kRegister, true, false, number - kRegisters, 0};
  return {Place::kSpill, false, false, number - 2 * kRegisters, 0};
}

// What each place holds: at first its own name.
class Cells {
 public:
  uint64_t read(const Place& place) const {
    if (place.kind == Place::kConstant) return place.bits;
    const auto found = content_.find(cell(place));
    if (found != content_.end()) return found->second;
    return uint64_t{place.kind} << 40 | uint64_t{place.floating} << 36 | place.number;
  }
  void write(const Place& place, uint64_t value) { content_[cell(place)] = value; }

 private:
  std::map<Cell, uint64_t> content_;
};

// As many targets as moves, from anywhere: fans, chains and circles.
std::vector<Move> random_moves(std::mt19937& random, uint32_t places) {
  std::vector<Move> moves;
  for (uint32_t to = 0; to < places; ++to) {
    if (random() % 4 == 0) continue;
    Place from = a_place(static_cast<uint32_t>(random()) % places);
    if (random() % 8 == 0) from = {Place::kConstant, false, false, 0, random()};
    moves.push_back({a_place(to), from, 8});
  }
  return moves;
}

std::vector<Move> one_circle(uint32_t places) {
  std::vector<Move> moves;
  for (uint32_t to = 0; to < places; ++to) {
    moves.push_back({a_place(to), a_place((to + 1) % places), 8});
  }
  return moves;
}

void expect_same_effect(const std::vector<Move>& moves) {
  Cells one_by_one;
  for (const Move& m : in_sequence(moves, kAside)) {
    one_by_one.write(m.to, one_by_one.read(m.from));
  }
  const Cells before;
  for (const Move& m : moves) EXPECT_EQ(one_by_one.read(m.to), before.read(m.from));
}

TEST(MovesInSequence, HaveTheEffectOfMovesAtOnce) {
  std::mt19937 random(1);
  for (uint32_t round = 0; round < 2'000; ++round) {
    expect_same_effect(random_moves(random, 2 + round % 60));
  }
  for (const uint32_t places : {2u, 3u, 40u}) expect_same_effect(one_circle(places));
}

TEST(MovesInSequence, WorkGrowsWithTheNumberOfMoves) {
  const auto seconds_for = [](int size) {
    const std::vector<Move> moves = one_circle(static_cast<uint32_t>(size));
    const double begin = tests::processor_seconds();
    EXPECT_EQ(in_sequence(moves, kAside).size(), moves.size() + 1);
    return tests::processor_seconds() - begin;
  };
  EXPECT_TRUE(tests::grows_linearly(seconds_for, 100'000));
}

}  // namespace
}  // namespace vm::native
