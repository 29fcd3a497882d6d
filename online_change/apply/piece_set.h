// Pieces of a transfer by number, and which of them read or write a page of data memory: so that
// bringing a second area up to date looks at the pieces of what has changed, and at no others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "online_change/apply/transfer.h"

namespace online_change {

class PieceSet {
 public:
  static constexpr size_t kNone = SIZE_MAX;

  explicit PieceSet(size_t pieces = 0) : words_((pieces + 63) / 64) {}
  void add(size_t piece) { words_[piece / 64] |= bit(piece); }
  void remove(size_t piece) { words_[piece / 64] &= ~bit(piece); }
  void clear() { words_.assign(words_.size(), 0); }
  bool has(size_t piece) const { return (words_[piece / 64] & bit(piece)) != 0; }
  // The first one from `piece` on that is in one of two sets of the same size; kNone.
  static size_t next_of(const PieceSet& a, const PieceSet& b, size_t piece);

 private:
  static uint64_t bit(size_t piece) { return uint64_t{1} << (piece % 64); }

  std::vector<uint64_t> words_;
};

class PagePieces {
 public:
  static constexpr uint32_t kPageBytes = 4096;

  PagePieces() = default;
  // The pieces of the pages below `pages`; memory and time follow the bytes that the pieces span.
  PagePieces(const Transfer& transfer, size_t pages);
  std::span<const uint32_t> of(size_t page) const {
    return std::span(pieces_).subspan(begin_[page], begin_[page + 1] - begin_[page]);
  }

 private:
  std::vector<size_t> begin_;  // in pieces_, by page
  std::vector<uint32_t> pieces_;
};

}  // namespace online_change
