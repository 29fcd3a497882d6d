// Moves that happen at once, as moves one after the other.
#include <algorithm>
#include <utility>

#include "vm/native/allocate.h"

namespace vm::native {
namespace {

bool same_place(const Place& a, const Place& b) {
  return a.kind == b.kind && a.number == b.number &&
         (a.kind != Place::kRegister || a.floating == b.floating);
}

uint64_t place_key(const Place& place) {
  const bool floating = place.kind == Place::kRegister && place.floating;
  return uint64_t{place.kind} << 33 | uint64_t{floating} << 32 | place.number;
}

// Which move waits for which: one that writes a place waits for all that read it.
struct MoveOrder {
  std::vector<uint32_t> writer;   // of a move: the one that writes what it reads, or kNone
  std::vector<uint32_t> readers;  // of a move: how many read what it writes, and are still to come
};

MoveOrder order_of(const std::vector<Move>& moves) {
  std::vector<std::pair<uint64_t, uint32_t>> targets;
  targets.reserve(moves.size());
  for (uint32_t i = 0; i < moves.size(); ++i) targets.emplace_back(place_key(moves[i].to), i);
  std::sort(targets.begin(), targets.end());
  MoveOrder order{std::vector<uint32_t>(moves.size(), kNone),
                  std::vector<uint32_t>(moves.size(), 0)};
  for (uint32_t i = 0; i < moves.size(); ++i) {
    const std::pair<uint64_t, uint32_t> source{place_key(moves[i].from), 0};
    const auto found = std::lower_bound(targets.begin(), targets.end(), source);
    if (found == targets.end() || found->first != source.first) continue;
    order.writer[i] = found->second;
    ++order.readers[found->second];
  }
  return order;
}

}  // namespace

std::vector<Move> in_sequence(std::vector<Move> moves, Place aside) {
  std::erase_if(moves, [](const Move& m) { return same_place(m.to, m.from); });
  MoveOrder order = order_of(moves);
  std::vector<Move> out;
  std::vector<uint32_t> ready;
  std::vector<bool> done(moves.size(), false);
  const auto read = [&](uint32_t reader) {
    const uint32_t writer = order.writer[reader];
    if (writer != kNone && --order.readers[writer] == 0) ready.push_back(writer);
  };
  const auto emit_ready = [&] {
    while (!ready.empty()) {
      const uint32_t next = ready.back();
      ready.pop_back();
      done[next] = true;
      out.push_back(moves[next]);
      read(next);
    }
  };
  out.reserve(moves.size() + 1);
  for (uint32_t i = 0; i < moves.size(); ++i) {
    if (order.readers[i] == 0) ready.push_back(i);
  }
  emit_ready();
  // What is left are circles, in which each place is read once: one source of each waits aside.
  for (uint32_t i = 0; i < moves.size(); ++i) {
    if (done[i]) continue;
    out.push_back({aside, moves[i].from, 8});
    read(i);
    order.writer[i] = kNone;
    moves[i].from = aside;
    emit_ready();
  }
  return out;
}

}  // namespace vm::native
