// The call discipline of ir.h. Arguments lie where the callee's frame will be, so
// nothing may use that memory between their writing and the call, and results are
// gone with the next call. Arguments are written in the block of their call;
// results may be read in later blocks as long as every way there comes from that call.
#include <algorithm>
#include <string>

#include "ir/program/verify_parts.h"

namespace ir {
namespace {

// The function whose results can be read; or none, or not known yet.
constexpr uint32_t kNobody = 0xfffffffeu;
constexpr uint32_t kUnknown = 0xffffffffu;

// In kArg places of its `pou`.
bool takes_arguments(Op op) {
  return op == Op::kCallFunction || op == Op::kCallMethod || op == Op::kCallVirtual;
}

bool is_call(Op op) {
  return op == Op::kCallInstance || op == Op::kCallNative || op == Op::kCallBody ||
         op == Op::kCallReference || takes_arguments(op);
}

class CallsVerifier {
 public:
  CallsVerifier(const Program& program, const Pou& pou)
      : program_(program), pou_(pou), results_at_entry_(pou.blocks.size(), kUnknown) {}

  base::Status verify() {
    spread_results();
    for (size_t b = 0; b < pou_.blocks.size(); ++b) {
      check_block(b);
      if (!reason_.empty()) {
        return not_verified(reason_);
      }
    }
    return base::Ok{};
  }

 private:
  void fail(const std::string& why) {
    if (reason_.empty()) {
      reason_ = inst_place(pou_, block_, inst_) + why;
    }
  }

  uint32_t results_after(const Block& block, uint32_t results) const {
    for (const Inst& inst : block.insts) {
      if (is_call(inst.op)) {
        results = takes_arguments(inst.op) ? inst.pou.index : kNobody;
      }
    }
    return results;
  }

  void spread_results() {
    std::vector<uint32_t> work = {0};
    results_at_entry_[0] = kNobody;
    while (!work.empty()) {
      const Block& block = pou_.blocks[work.back()];
      const uint32_t results = results_after(block, results_at_entry_[work.back()]);
      work.pop_back();
      for (const Target& target : block.insts.back().targets) {
        uint32_t& entry = results_at_entry_[target.block.index];
        const bool handler =
            &target != &block.insts.back().targets[0] && block.insts.back().op == Op::kTry;
        const bool agrees = !handler && (entry == kUnknown || entry == results);
        const uint32_t merged = agrees ? results : kNobody;
        if (merged != entry) {
          entry = merged;
          work.push_back(target.block.index);
        }
      }
    }
  }

  void check_block(size_t b) {
    block_ = b;
    results_ = results_at_entry_[b];
    pending_ = PouId();
    for (inst_ = 0; inst_ < pou_.blocks[b].insts.size(); ++inst_) {
      check_inst(pou_.blocks[b].insts[inst_]);
    }
    --inst_;
    if (pending_.valid()) {
      fail("arguments are written, but their call does not follow in this block");
    }
  }

  void check_inst(const Inst& inst) {
    if (inst.op == Op::kCopy) {
      check_read(inst.place2);
      if (argument(inst.place) != nullptr && argument(inst.place2) != nullptr) {
        fail("a result is copied to an argument; both lie in the next frame");
      }
    }
    switch (inst.op) {
      case Op::kLoad:
        check_read(inst.place);
        break;
      case Op::kAddress:
      case Op::kString:
      case Op::kHandle:
      case Op::kCallInstance:
        check_no_argument(inst.place);
        break;
      case Op::kCallMethod:
        if (inst.place.valid()) {
          check_no_argument(inst.place);
        }
        break;
      case Op::kStore:
      case Op::kCopy:
      case Op::kInit:
        check_write(inst.place);
        break;
      default:
        break;
    }
    if (is_call(inst.op)) {
      check_call(inst);
    }
  }

  const Place* argument(PlaceId id) const {
    const Place& place = pou_.places[id.index];
    return place.base == PlaceBase::kArg ? &place : nullptr;
  }

  LocalKind kind_of(const Place& place) const {
    return program_.pous[place.pou.index].locals[place.base_index].kind;
  }

  void check_read(PlaceId id) {
    const Place* place = argument(id);
    if (place == nullptr) {
      return;
    }
    if (place->pou.index != results_ || pending_.valid()) {
      fail("a result is read where its call is not the last one");
    }
    if (kind_of(*place) != LocalKind::kOutput && kind_of(*place) != LocalKind::kReturn) {
      fail("a parameter that is no result is read");
    }
  }

  void check_no_argument(PlaceId id) {
    if (argument(id) != nullptr) {
      fail("the callee's frame has no lasting address");
    }
  }

  void check_write(PlaceId id) {
    const Place* place = argument(id);
    if (place == nullptr) {
      return;
    }
    if (kind_of(*place) != LocalKind::kInput && kind_of(*place) != LocalKind::kInOut) {
      fail("a local that is no input is written by the caller");
    }
    if (pending_.valid() && pending_ != place->pou) {
      fail("arguments of two functions are mixed");
    }
    if (!pending_.valid()) {
      pending_ = place->pou;
      written_.assign(program_.pous[pending_.index].locals.size(), false);
    }
    if (!place->steps.empty() && !written_[place->base_index]) {
      fail("part of an argument is written before the whole");
    }
    written_[place->base_index] = true;
  }

  void check_call(const Inst& inst) {
    if (pending_.valid() && (!takes_arguments(inst.op) || inst.pou != pending_)) {
      fail("another call between an argument and its call");
    }
    if (takes_arguments(inst.op)) {
      check_all_written(program_.pous[inst.pou.index]);
    }
    pending_ = PouId();
    results_ = takes_arguments(inst.op) ? inst.pou.index : kNobody;
  }

  void check_all_written(const Pou& callee) {
    for (size_t i = 0; i < callee.locals.size(); ++i) {
      const LocalKind kind = callee.locals[i].kind;
      const bool needed = kind == LocalKind::kInput || kind == LocalKind::kInOut;
      if (needed && (!pending_.valid() || !written_[i])) {
        fail("argument " + callee.locals[i].name + " of " + callee.name + " is not written");
      }
    }
  }

  const Program& program_;
  const Pou& pou_;
  std::vector<uint32_t> results_at_entry_;
  size_t block_ = 0;
  size_t inst_ = 0;
  uint32_t results_ = kNobody;
  PouId pending_;
  std::vector<bool> written_;
  std::string reason_;
};

}  // namespace

base::Status verify_calls(const Program& program, const Pou& pou) {
  return CallsVerifier(program, pou).verify();
}

}  // namespace ir
