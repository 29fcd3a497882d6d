// What is known of each expression, in chunks as the tree has (expr_store.h): a chunk is made when
// something of it is asked for, and dropped with the expressions.
#pragma once

#include <memory>
#include <vector>

#include "frontend/sema/model.h"

namespace frontend {

class NoteStore {
 public:
  // For ids up to `end`; more than before.
  void grow(uint32_t end) { chunks_.resize((end + kChunk - 1) / kChunk); }
  Note& operator[](uint32_t index) {
    std::unique_ptr<Note[]>& chunk = chunks_[index / kChunk];
    if (chunk == nullptr) [[unlikely]]
      chunk = std::make_unique<Note[]>(kChunk);
    return chunk[index % kChunk];
  }
  void drop(uint32_t chunk) { chunks_[chunk].reset(); }

 private:
  static constexpr uint32_t kChunk = ExprStore::kChunk;
  std::vector<std::unique_ptr<Note[]>> chunks_;
};

}  // namespace frontend
