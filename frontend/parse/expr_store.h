// The expressions of a tree, in chunks that never move. Expressions of bodies and expressions of
// declarations are in different chunks, so that the memory of bodies can be given back, one after
// the other, as they are lowered: declarations are read until the end.
//
// An id is the place: the chunk and the number in it. Ids go up within each of the two uses, and
// some numbers below end() have no expression.
#pragma once

#include <cstddef>
#include <vector>

#include "frontend/parse/code_nodes.h"

namespace frontend {

class ExprStore {
 public:
  enum class Use : uint8_t { kDeclarations, kBodies };
  static constexpr uint32_t kChunk = 4096;  // expressions

  const Expr& operator[](uint32_t index) const { return chunks_[index / kChunk][index % kChunk]; }
  Expr& operator[](uint32_t index) { return chunks_[index / kChunk][index % kChunk]; }

  // What is added while an As lives belongs to `use`.
  class As {
   public:
    As(ExprStore& store, Use use) : store_(store), before_(store.use_) { store.use_ = use; }
    ~As() { store_.use_ = before_; }
    As(const As&) = delete;
    As& operator=(const As&) = delete;

   private:
    ExprStore& store_;
    Use before_;
  };
  ExprId add(const Expr& expr);

  size_t size() const { return size_; }
  // Above all ids.
  uint32_t end() const { return static_cast<uint32_t>(chunks_.size()) * kChunk; }
  // --- chunks of bodies: numbered as they are filled, each before the next one begins
  // How many expressions of bodies there were ever.
  uint32_t of_bodies() const { return of_bodies_; }
  // The chunk that the numbers of its expressions lie in: ids / kChunk.
  uint32_t chunk_of_bodies(uint32_t number) const { return body_chunks_[number]; }
  // Nobody reads an expression of that chunk from now on, and none is added.
  void give_back_bodies(uint32_t number);

  // With every expression that was not given back, in the order of ids.
  template <class F>
  void each(F f) const {
    for (const std::vector<Expr>& chunk : chunks_) {
      for (const Expr& expr : chunk) f(expr);
    }
  }
  template <class F>
  bool any_of(F f) const {
    bool found = false;
    each([&](const Expr& expr) { found = found || f(expr); });
    return found;
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;

  std::vector<std::vector<Expr>> chunks_;  // each has room for kChunk from the beginning
  std::vector<uint32_t> body_chunks_;      // in chunks_
  size_t size_ = 0;
  uint32_t of_bodies_ = 0;
  Use use_ = Use::kDeclarations;
  uint32_t open_[2] = {kNone, kNone};  // by use: the chunk that expressions are added to
};

}  // namespace frontend
