#include "online_change/apply/piece_set.h"

#include <algorithm>
#include <bit>

namespace online_change {
namespace {

// Pages of an extent, below `pages`.
template <class Visit>
void visit_pages(uint64_t begin, uint64_t size, size_t pages, const Visit& visit) {
  if (size == 0) return;
  const uint64_t end = std::min<uint64_t>((begin + size - 1) / PagePieces::kPageBytes + 1, pages);
  for (uint64_t page = begin / PagePieces::kPageBytes; page < end; ++page) visit(page);
}

// A piece can be with a page twice: by what it reads and by what it writes.
template <class Visit>
void visit_pieces(const Transfer& transfer, size_t pages, const Visit& visit) {
  for (uint32_t i = 0; i < transfer.pieces().size(); ++i) {
    const Piece& piece = transfer.pieces()[i];
    const auto with_piece = [&](uint64_t page) { visit(page, i); };
    visit_pages(piece.from, transfer.source_extent(piece), pages, with_piece);
    visit_pages(piece.to, transfer.target_extent(piece), pages, with_piece);
  }
}

}  // namespace

size_t PieceSet::next_of(const PieceSet& a, const PieceSet& b, size_t piece) {
  uint64_t mask = ~uint64_t{0} << (piece % 64);
  for (size_t word = piece / 64; word < a.words_.size(); ++word) {
    const uint64_t found = (a.words_[word] | b.words_[word]) & mask;
    if (found != 0) return word * 64 + static_cast<size_t>(std::countr_zero(found));
    mask = ~uint64_t{0};
  }
  return kNone;
}

PagePieces::PagePieces(const Transfer& transfer, size_t pages) : begin_(pages + 1) {
  visit_pieces(transfer, pages, [&](uint64_t page, uint32_t) { ++begin_[page + 1]; });
  for (size_t page = 0; page < pages; ++page) begin_[page + 1] += begin_[page];
  pieces_.resize(begin_.back());
  std::vector<size_t> at(begin_.begin(), begin_.end() - 1);
  visit_pieces(transfer, pages, [&](uint64_t page, uint32_t i) { pieces_[at[page]++] = i; });
}

}  // namespace online_change
