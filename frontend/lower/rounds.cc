#include "frontend/lower/rounds.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

namespace frontend {
namespace {

// A variable, as far as it has bytes of its own: of an instance the member, else the whole base.
using OwnBytes = std::tuple<ir::PlaceBase, uint32_t, uint32_t>;

// False: it may be any variable.
bool find_own_bytes(const ir::Place& place, OwnBytes& out) {
  const bool own = place.base == ir::PlaceBase::kSelf;
  if (!own && place.base != ir::PlaceBase::kLocal && place.base != ir::PlaceBase::kGlobal)
    return false;
  for (const ir::Step& step : place.steps) {
    if (step.kind == ir::StepKind::kDeref) return false;
  }
  const bool member = own && place.steps.size() != 0;
  if (own && (!member || place.steps[0].kind != ir::StepKind::kMember)) return false;
  out = {place.base, place.base_index, member ? place.steps[0].index : 0};
  return true;
}

// What computes from values and variables only, and what leads from block to block.
bool is_plain(ir::Op op) {
  switch (op) {
    case ir::Op::kAddress:
    case ir::Op::kHandle:
    case ir::Op::kMoveHandle:
    case ir::Op::kFlat:
    case ir::Op::kUnflat:
    case ir::Op::kCallFunction:
    case ir::Op::kCallInstance:
    case ir::Op::kCallNative:
    case ir::Op::kAdvanceTime:
    case ir::Op::kThis:
    case ir::Op::kIsType:
    case ir::Op::kCallMethod:
    case ir::Op::kCallBody:
    case ir::Op::kCallVirtual:
    case ir::Op::kCallReference:
    case ir::Op::kTrapKind:
    case ir::Op::kReturn:
    case ir::Op::kTrap:
    case ir::Op::kTrapAgain:
    case ir::Op::kTry:
    case ir::Op::kEndTry:
      return false;
    default:
      return true;
  }
}

}  // namespace

bool is_same_each_round(const ir::Pou& pou, std::span<const ir::BlockId> condition,
                        std::span<const ir::BlockId> loop) {
  std::set<OwnBytes> stored;
  for (const ir::BlockId block : loop) {
    for (const ir::Inst& inst : pou.blocks[block.index].insts) {
      if (!is_plain(inst.op)) return false;
      if (inst.op != ir::Op::kStore && inst.op != ir::Op::kCopy && inst.op != ir::Op::kInit)
        continue;
      OwnBytes bytes;
      if (!find_own_bytes(pou.places[inst.place.index], bytes)) return false;
      stored.insert(bytes);
    }
  }
  for (const ir::BlockId block : condition) {
    for (const ir::Inst& inst : pou.blocks[block.index].insts) {
      const bool copies = inst.op == ir::Op::kCopy;
      if (!copies && inst.op != ir::Op::kLoad && inst.op != ir::Op::kString) continue;
      OwnBytes bytes;
      const ir::PlaceId read = copies ? inst.place2 : inst.place;
      if (!find_own_bytes(pou.places[read.index], bytes)) return false;
      if (stored.contains(bytes)) return false;
    }
  }
  return true;
}

}  // namespace frontend
