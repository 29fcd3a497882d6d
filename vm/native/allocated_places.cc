// What an emitter relies on, as allocate() promises it.
#include <algorithm>

#include "vm/native/allocate.h"

namespace vm::native {
namespace {

class AllocatedPlaces {
 public:
  AllocatedPlaces(const Function& function, const Allocated& all) : f_(function), all_(all) {}

  bool block(Block b) const {
    const AllocatedBlock& block = all_.blocks[b];
    const auto step = [&](const Step& s) {
      return s.node == kNone ? good(s.move) : s.node < f_.nodes.size() && good(s);
    };
    const auto move = [&](const Move& m) { return good(m); };
    return std::all_of(block.steps.begin(), block.steps.end(), step) && good(block.in[0]) &&
           good(block.in[1]) && std::all_of(block.edges[0].begin(), block.edges[0].end(), move) &&
           std::all_of(block.edges[1].begin(), block.edges[1].end(), move) &&
           std::all_of(block.resume.begin(), block.resume.end(), move);
  }
  bool exit(size_t number) const {
    const std::vector<Place>& places = all_.exits[number];
    const auto held = [&](const Place& p) { return p.kind != Place::kNowhere && good(p); };
    return (places.empty() || places.size() == f_.exits[number].slots.size()) &&
           std::all_of(places.begin(), places.end(), held);
  }

 private:
  bool good(const Place& place) const {
    switch (place.kind) {
      case Place::kNowhere:
      case Place::kConstant:
        return true;
      case Place::kRegister:
        return place.number <= kMostRegisters;
      case Place::kSpill:
        return place.number < all_.spill_slots;
      case Place::kHome:
        return place.number < f_.variables.size();
    }
    return false;
  }
  bool good(const Move& move) const {
    const bool to = move.to.kind == Place::kRegister || move.to.kind == Place::kSpill;
    return to && good(move.to) && move.from.kind != Place::kNowhere && good(move.from);
  }
  bool good(const Step& step) const {
    const auto place = [&](const Place& p) { return good(p); };
    return good(step.result) && good(step.index) && good(step.pointer) &&
           std::all_of(std::begin(step.in), std::end(step.in), place);
  }

  const Function& f_;
  const Allocated& all_;
};

}  // namespace

bool has_places(const Function& function, const Allocated& all) {
  if (all.blocks.size() != function.blocks.size()) return false;
  if (all.exits.size() != function.exits.size()) return false;
  const AllocatedPlaces places(function, all);
  for (Block b = 0; b < all.blocks.size(); ++b) {
    if (!places.block(b)) return false;
  }
  for (size_t exit = 0; exit < all.exits.size(); ++exit) {
    if (!places.exit(exit)) return false;
  }
  return true;
}

}  // namespace vm::native
