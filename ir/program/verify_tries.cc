// The nesting of tries: which handler a block has says which tries are open in it, and every
// way into the block must agree.
#include <string>

#include "base/limits.h"
#include "ir/program/ops.h"
#include "ir/program/verify_parts.h"

namespace ir {
namespace {

class TriesVerifier {
 public:
  explicit TriesVerifier(const Pou& pou) : pou_(pou) {}

  base::Status verify() {
    for (uint32_t b = 0; b < pou_.blocks.size() && reason_.empty(); ++b) {
      check_handlers(b);
    }
    for (uint32_t b = 0; b < pou_.blocks.size() && reason_.empty(); ++b) {
      check_end(b);
    }
    return reason_.empty() ? base::Status(base::Ok{}) : not_verified(reason_);
  }

 private:
  void require(bool holds, uint32_t block, const char* why) {
    if (!holds && reason_.empty()) {
      reason_ = inst_place(pou_, block, pou_.blocks[block].insts.size() - 1) + why;
    }
  }

  BlockId handler_of(BlockId block) const { return pou_.blocks[block.index].handler; }

  void check_handlers(uint32_t b) {
    uint32_t depth = 0;
    for (BlockId at = handler_of(BlockId(b)); at.valid() && reason_.empty(); at = handler_of(at)) {
      require(at.index < pou_.blocks.size(), b, "the handler of its block does not exist");
      require(++depth <= base::kMaxTryDepth, b, "tries nest in a circle, or too deeply");
      if (reason_.empty()) {
        require(pou_.blocks[at.index].params.empty(), b, "a handler has parameters");
      } else {
        return;
      }
    }
    require(b != 0 || depth == 0, b, "the entry block has a handler");
  }

  void check_end(uint32_t b) {
    const Inst& end = pou_.blocks[b].insts.back();
    BlockId own = pou_.blocks[b].handler;
    if (end.op == Op::kTry) {
      const BlockId handler = end.targets[1].block;
      require(handler_of(end.targets[0].block) == handler, b, "the body has another handler");
      require(handler_of(handler) == own, b, "the handler is not beside the try");
      return;
    }
    if (end.op == Op::kEndTry) {
      require(own.valid(), b, "no try is open");
      own = own.valid() ? handler_of(own) : own;
    }
    require(end.op != Op::kReturn || !own.valid(), b, "a try is open");
    for (const Target& target : end.targets) {
      require(handler_of(target.block) == own, b, "a jump leads into a try, or out of it");
    }
  }

  const Pou& pou_;
  std::string reason_;
};

}  // namespace

base::Status verify_tries(const Pou& pou) { return TriesVerifier(pou).verify(); }

}  // namespace ir
