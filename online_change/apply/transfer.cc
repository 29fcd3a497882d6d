#include "online_change/apply/transfer.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "online_change/plan/plan_invariants.h"

namespace online_change {
namespace {

constexpr uint32_t kPieceBytes = 4096;
// Values that are copied or converted fast take some 5 ns, others (fast_conversion.h) up to 80.
constexpr uint32_t kFastValues = 1024;
constexpr uint32_t kSlowValues = 128;

// Values of `piece`, `stride` apart, to or from a place without gaps.
void gather_piece(const uint8_t* from, const Piece& piece, uint32_t stride, uint8_t* out) {
  if (piece.count == 1 || stride == piece.size) {
    std::memcpy(out, from, piece.total());
    return;
  }
  for (uint32_t i = 0; i < piece.count; ++i) {
    std::memcpy(out + size_t{i} * piece.size, from + size_t{i} * stride, piece.size);
  }
}

void scatter(const uint8_t* from, const Piece& piece, uint32_t stride, uint8_t* to) {
  if (piece.count == 1 || stride == piece.size) {
    std::memcpy(to, from, piece.total());
    return;
  }
  for (uint32_t i = 0; i < piece.count; ++i) {
    std::memcpy(to + size_t{i} * stride, from + size_t{i} * piece.size, piece.size);
  }
}

bool without_gaps(const UpdateStep& step) {
  if (step.as<ConvertedValues>() != nullptr) return false;
  const auto* copied = step.as<CopiedValues>();
  const bool read_so = copied == nullptr || copied->from_stride == step.size;
  return step.count == 1 || (read_so && step.to_stride == step.size);
}

}  // namespace

Transfer::Transfer(const Plan& plan, const ir::Image& from, const ir::Image& to, Steps which)
    : plan_(plan), conversions_(from, to) {
  expect_promises(plan, from, to);
  size_t bytes = 0;
  for (uint32_t number = 0; number < plan.steps.size(); ++number) {
    const UpdateStep& step = plan.steps[number];
    if (which == Steps::kBoundary && step.early()) continue;
    if (which == Steps::kEarly && !step.early()) continue;
    add_step(number, bytes);
    bytes += step.total();
  }
  auto by_place = [](const Converted& a, const Converted& b) { return a.to < b.to; };
  if (!std::is_sorted(converted_.begin(), converted_.end(), by_place)) {
    std::sort(converted_.begin(), converted_.end(), by_place);
  }
  base::dcheck([&] { return pieces_cover(bytes); }, "the pieces are the steps, in their order");
  staged_.resize(bytes);
  if (which == Steps::kBoundary || which == Steps::kAll) saved_.resize(bytes);
  if (which == Steps::kAll) remembered_.resize(bytes);
}

// Each piece follows the one before it in the buffers, and all of them fill these.
bool Transfer::pieces_cover(size_t bytes) const {
  size_t at = 0;
  for (const Piece& piece : pieces_) {
    if (piece.at != at || piece.count == 0) return false;
    at += piece.total();
  }
  return at == bytes;
}

void Transfer::add_step(uint32_t number, size_t at) {
  const UpdateStep& step = plan_.steps[number];
  Piece piece;
  piece.step = number;
  piece.at = at;
  const CopiedValues source = step.source().value_or(CopiedValues{});
  piece.from = source.from;
  piece.to = step.to;
  piece.kind = step.kind();
  piece.from_stride = source.from_stride;
  piece.to_stride = step.to_stride;
  if (const auto* entered = step.as<EnteredStep>()) {
    piece.active = entered->active;
    converted_.push_back({step.to, step.size, at});
  }
  if (without_gaps(step)) return add_bytes(piece, step.total());
  const auto* conversion = step.as<ConvertedValues>();
  const bool converts = conversion != nullptr;
  if (converts) {
    piece.fast = conversions_.fast(*conversion);
    piece.left = conversions_.left_by_inverse(*conversion);
  }
  piece.size = step.size;
  uint32_t most = converts && piece.fast == nullptr ? kSlowValues : kFastValues;
  most = std::clamp(kPieceBytes / std::max(step.size, 1u), 1u, most);
  for (piece.first = 0; piece.first < step.count; piece.first += piece.count) {
    piece.count = std::min(most, step.count - piece.first);
    piece.from = source.from + piece.first * source.from_stride;
    piece.to = step.place(piece.first);
    piece.within = piece.first * step.size;
    piece.at = at + piece.within;
    if (step.size > kPieceBytes && !converts) {
      add_bytes(piece, step.size);
    } else {
      pieces_.push_back(piece);
    }
    for (uint32_t i = 0; converts && i < piece.count; ++i) {
      converted_.push_back(
          {piece.to + i * step.to_stride, step.size, piece.at + size_t{i} * step.size});
    }
  }
}

void Transfer::add_bytes(Piece part, uint64_t length) {
  part.count = 1;
  while (length != 0) {
    part.size = static_cast<uint32_t>(std::min<uint64_t>(length, kPieceBytes));
    pieces_.push_back(part);
    part.from += part.size;
    part.to += part.size;
    part.within += part.size;
    part.at += part.size;
    length -= part.size;
  }
}

uint64_t Transfer::source_extent(const Piece& piece) const {
  if (!step_of(piece).source()) return 0;
  const bool converts = piece.kind == StepKind::kConvert;
  const uint32_t size = converts ? source_size(piece) : piece.size;
  return uint64_t{piece.count - 1} * piece.from_stride + size;
}

uint64_t Transfer::target_extent(const Piece& piece) const {
  return uint64_t{piece.count - 1} * piece.to_stride + piece.size;
}

void Transfer::touch(uint8_t* memory) const {
  constexpr uint64_t kPage = 4096;
  for (const Piece& piece : pieces_) {
    const uint64_t end = piece.to + target_extent(piece);
    for (uint64_t at = piece.to; at < end; at = (at / kPage + 1) * kPage) {
      volatile uint8_t* byte = memory + at;
      *byte = *byte;
    }
  }
}

void Transfer::read_values(const Piece& piece, const uint8_t* memory, uint8_t* out) const {
  if (piece.kind == StepKind::kCopy)
    return gather_piece(memory + piece.from, piece, piece.from_stride, out);
  if (piece.kind == StepKind::kEnter) {
    const uint32_t from = memory[piece.active] != 0 ? piece.active : piece.from;
    std::memcpy(out, memory + from, piece.total());
    return;
  }
  const base::Bytes& bytes = *step_of(piece).bytes();
  if (bytes.empty()) {
    std::memset(out, 0, piece.total());
  } else {
    std::memcpy(out, bytes.data() + piece.within, piece.total());
  }
  if (piece.kind == StepKind::kGather) gather_parts(piece, memory, out);
}

void Transfer::gather_parts(const Piece& piece, const uint8_t* memory, uint8_t* out) const {
  const uint32_t row = step_of(piece).as<GatheredBits>()->row;
  online_change::gather(plan_.gathers[row], memory, piece.within, {out, piece.total()});
}

bool Transfer::read_converted(const Piece& piece, const uint8_t* memory, uint8_t* out,
                              const OnLoss& on_loss) const {
  for (uint32_t i = 0; i < piece.count; ++i) {
    const uint8_t* source = memory + piece.from + size_t{i} * piece.from_stride;
    uint8_t* to = out + size_t{i} * piece.size;
    if (piece.fast != nullptr) {
      i += static_cast<uint32_t>(piece.fast({source, piece.from_stride, to, piece.count - i}));
      if (i == piece.count) return true;
      source = memory + piece.from + size_t{i} * piece.from_stride;
      to = out + size_t{i} * piece.size;
    }
    const char* what = conversions_.convert(conversion_of(piece), piece.first + i, source,
                                            piece.to + i * piece.to_stride, {to, piece.size});
    if (what != nullptr && !on_loss({piece.step, piece.first + i, what})) return false;
  }
  return true;
}

bool Transfer::losses(const uint8_t* memory, const OnLoss& on_loss) const {
  base::Bytes scratch;
  for (const Piece& piece : pieces_) {
    if (piece.kind != StepKind::kConvert) continue;
    scratch.resize(std::max<size_t>(scratch.size(), piece.total()));
    if (!read_converted(piece, memory, scratch.data(), on_loss)) return false;
  }
  return true;
}

bool Transfer::read_piece(const Piece& piece, const uint8_t* memory, const OnLoss& on_loss) {
  uint8_t* out = staged_.data() + piece.at;
  if (piece.kind == StepKind::kConvert) {
    return read_converted(piece, memory, out, on_loss);
  }
  read_values(piece, memory, out);
  return true;
}

bool Transfer::read(const uint8_t* memory, const OnLoss& on_loss, const Interrupted& interrupted) {
  for (const Piece& piece : pieces_) {
    if (interrupted && interrupted()) return false;
    if (!read_piece(piece, memory, on_loss)) return false;
  }
  return true;
}

bool Transfer::move(const Piece& piece, const uint8_t* source, uint8_t* target,
                    const OnLoss& on_loss) {
  if (!read_piece(piece, source, on_loss)) return false;
  scatter(staged_.data() + piece.at, piece, piece.to_stride, target + piece.to);
  return true;
}

// As boundary_work() counts: a step once, and a long value once, in however many pieces.
void Transfer::count(const Piece& piece, BoundaryWork& work) const {
  const uint32_t size = step_of(piece).size;
  const bool slow = piece.kind == StepKind::kConvert && piece.fast == nullptr;
  if (piece.within == 0) work.step(piece.from, piece.to);
  if (size == 0 || piece.within % size == 0) {
    (slow ? work.slow_values : work.values) += piece.count;
  }
  work.bytes += piece.total();
}

bool Transfer::remember(const uint8_t* memory, const Interrupted& interrupted) {
  base::dcheck(remembered_.size() == staged_.size(), "the way back has room for what was");
  for (const Piece& piece : pieces_) {
    if (piece.kind == StepKind::kCopy) continue;
    if (interrupted && interrupted()) return false;
    gather_piece(memory + piece.to, piece, piece.to_stride, remembered_.data() + piece.at);
  }
  return true;
}

bool Transfer::read_back(const uint8_t* memory, const Transfer& forward, const OnLoss& on_loss,
                         const Interrupted& interrupted) {
  base::dcheck(remembered_.size() == staged_.size(), "the way back has room for what was");
  for (const Piece& piece : pieces_) {
    if (interrupted && interrupted()) return false;
    switch (piece.kind) {
      case StepKind::kCopy:
        read_values(piece, memory, staged_.data() + piece.at);
        break;
      case StepKind::kConvert:
        if (!read_back_converted(piece, memory, forward, on_loss)) return false;
        break;
      case StepKind::kGather:
        std::memcpy(staged_.data() + piece.at, remembered_.data() + piece.at, piece.total());
        gather_parts(piece, memory, staged_.data() + piece.at);
        break;
      case StepKind::kEnter:
        if (forward.still_as_converted(piece.from, piece.total(), memory)) {
          std::memcpy(staged_.data() + piece.at, remembered_.data() + piece.at, piece.total());
        } else {
          read_values(piece, memory, staged_.data() + piece.at);
        }
        break;
      case StepKind::kMigrate:
        if (!step_of(piece).bytes()->empty()) {
          read_values(piece, memory, staged_.data() + piece.at);
          break;
        }
        [[fallthrough]];  // nobody has written what it would be made of
      case StepKind::kInitialise:
        std::memcpy(staged_.data() + piece.at, remembered_.data() + piece.at, piece.total());
        break;
    }
  }
  return true;
}

bool Transfer::read_back_converted(const Piece& piece, const uint8_t* memory,
                                   const Transfer& forward, const OnLoss& on_loss) {
  const ConvertedValues& how = conversion_of(piece);
  const uint32_t size = conversions_.source_size(how);
  for (uint32_t i = 0; i < piece.count; ++i) {
    const size_t at = piece.at + size_t{i} * piece.size;
    std::span<uint8_t> out(staged_.data() + at, piece.size);
    const uint8_t* const before = remembered_.data() + at;
    uint32_t from = piece.from + i * piece.from_stride;
    const bool as_before = piece.left && std::memcmp(memory + from, before, size) == 0;
    if (as_before || forward.still_as_converted(from, size, memory)) {
      std::memcpy(out.data(), before, out.size());
      continue;
    }
    const char* const what = conversions_.convert(how, piece.first + i, memory + from,
                                                  piece.to + i * piece.to_stride, out);
    if (what != nullptr && !on_loss({piece.step, piece.first + i, what})) return false;
  }
  return true;
}

bool Transfer::save(const uint8_t* memory, const Interrupted& interrupted) {
  base::dcheck(saved_.size() == staged_.size(), "what is overwritten in place can be kept");
  for (const Piece& piece : pieces_) {
    if (interrupted && interrupted()) return false;
    gather_piece(memory + piece.to, piece, piece.to_stride, saved_.data() + piece.at);
  }
  return true;
}

bool Transfer::write(uint8_t* memory, const Interrupted& interrupted) {
  base::dcheck(!interrupted || saved_.size() == staged_.size(), "what may end early was saved");
  for (size_t done = 0; done < pieces_.size(); ++done) {
    if (interrupted && interrupted()) {
      restore_first(memory, done);
      return false;
    }
    const Piece& piece = pieces_[done];
    scatter(staged_.data() + piece.at, piece, piece.to_stride, memory + piece.to);
  }
  return true;
}

void Transfer::restore_first(uint8_t* memory, size_t count) const {
  base::dcheck(saved_.size() == staged_.size(), "only what was saved is restored");
  for (size_t done = 0; done < count; ++done) {
    const Piece& piece = pieces_[done];
    scatter(saved_.data() + piece.at, piece, piece.to_stride, memory + piece.to);
  }
}

size_t Transfer::first_converted(uint32_t offset, size_t& hint) const {
  auto is_first = [&](size_t i) {
    return i < converted_.size() && converted_[i].end() > offset &&
           (i == 0 || converted_[i - 1].end() <= offset);
  };
  if (is_first(hint)) return hint;
  if (is_first(hint + 1)) return ++hint;
  auto found = std::partition_point(converted_.begin(), converted_.end(),
                                    [&](const Converted& one) { return one.end() <= offset; });
  return hint = static_cast<size_t>(found - converted_.begin());
}

const uint8_t* Transfer::converted(uint32_t offset, uint32_t size) const {
  const size_t at = first_converted(offset, converted_hint_);
  if (at == converted_.size() || converted_[at].to != offset) return nullptr;
  return converted_[at].size == size ? staged_.data() + converted_[at].at : nullptr;
}

bool Transfer::still_as_converted(uint32_t offset, uint32_t size, const uint8_t* memory) const {
  const uint8_t* const made = converted(offset, size);
  return made != nullptr && std::memcmp(memory + offset, made, size) == 0;
}

}  // namespace online_change
