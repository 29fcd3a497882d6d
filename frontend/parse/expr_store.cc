#include "frontend/parse/expr_store.h"

#include "base/check.h"

namespace frontend {

ExprId ExprStore::add(const Expr& expr) {
  uint32_t& open = open_[static_cast<size_t>(use_)];
  if (open == kNone || chunks_[open].size() == kChunk) {
    open = static_cast<uint32_t>(chunks_.size());
    chunks_.emplace_back().reserve(kChunk);
    if (use_ == Use::kBodies) body_chunks_.push_back(open);
  }
  std::vector<Expr>& chunk = chunks_[open];
  chunk.push_back(expr);
  ++size_;
  if (use_ == Use::kBodies) ++of_bodies_;
  return ExprId(open * kChunk + static_cast<uint32_t>(chunk.size() - 1));
}

void ExprStore::give_back_bodies(uint32_t number) {
  const uint32_t chunk = body_chunks_[number];
  base::check(!chunks_[chunk].empty(), "a chunk is given back once");
  std::vector<Expr>().swap(chunks_[chunk]);
  uint32_t& open = open_[static_cast<size_t>(Use::kBodies)];
  if (open == chunk) open = kNone;
}

}  // namespace frontend
