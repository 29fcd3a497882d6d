// Carries values from one version's state to the other's: from a source to a target memory, which
// may be the same one (in place; docs/adr/0011-two-strategies.md). In place it goes in three
// passes: read all sources into a buffer, save what will be overwritten, write. Sources and targets
// may overlap; until write() begins nothing has happened, and restore() takes back what write()
// did. With a target apart from the source, move() carries one piece at a time, in any order and
// again. All memory is allocated beforehand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "online_change/apply/live_value.h"
#include "online_change/plan/pause.h"

namespace online_change {

// Asked before each step; true: stop here (a deadline, a test).
using Interrupted = std::function<bool()>;

struct Loss {  // of one value of a step that converts
  uint32_t step = 0;
  uint32_t index = 0;
  const char* what = nullptr;
};
// False: stop here.
using OnLoss = std::function<bool(const Loss&)>;

// Values of a step, few enough for one unit of idle time; or a part of one long value.
struct Piece {
  uint32_t step = 0;
  uint32_t first = 0;   // number of its first value
  uint32_t count = 1;   // values
  uint32_t size = 0;    // of each, or of the part
  uint32_t from = 0;    // in the source
  uint32_t to = 0;      // in the target
  uint32_t within = 0;  // in the step's values laid end to end
  uint32_t from_stride = 0;
  uint32_t to_stride = 0;
  StepKind kind = StepKind::kCopy;
  uint32_t active = 0;  // kEnter: where the other step is
  size_t at = 0;        // in the transfer's buffers
  FastConverter fast = nullptr;
  bool left = false;  // kConvert: the way in the other direction leaves its bytes
  uint32_t total() const { return size * count; }
};

class Transfer {
 public:
  // Steps of the boundary; steps that are done before it in place (A19); all, in place; all, into a
  // memory apart.
  enum class Steps : uint8_t { kBoundary, kEarly, kAll, kApart };
  Transfer(const Plan& plan, const ir::Image& from, const ir::Image& to, Steps which);

  // Makes every page that write() needs present, so that the operating system has nothing to do at
  // the boundary. Changes no byte.
  void touch(uint8_t* memory) const;
  // Losses that read() would find now; changes nothing.
  bool losses(const uint8_t* memory, const OnLoss& on_loss) const;

  // First pass. Losses are handed to `on_loss`; false from it ends the pass. False: ended early.
  bool read(const uint8_t* memory, const OnLoss& on_loss, const Interrupted& interrupted);
  // On the way back, before `forward` writes, or from the memory that it left untouched: keeps what
  // this plan will initialise or convert. The memory that version 2 writes cannot keep it: whole
  // structures are copied there, with the gaps that it has in the place of dropped members. False:
  // interrupted.
  bool remember(const uint8_t* memory, const Interrupted& interrupted);
  // The way back: like read(), but what this plan initialises, and what nobody wrote since
  // `forward` converted it, is what was remembered. Losses of what is converted as in read().
  bool read_back(const uint8_t* memory, const Transfer& forward, const OnLoss& on_loss,
                 const Interrupted& interrupted);
  bool save(const uint8_t* memory, const Interrupted& interrupted);
  // False: interrupted and restored.
  bool write(uint8_t* memory, const Interrupted& interrupted);
  void restore(uint8_t* memory) const { restore_first(memory, pieces_.size()); }

  const std::vector<Piece>& pieces() const { return pieces_; }
  // For the way back, after remember(): the bytes of a piece that this plan will initialise or
  // convert.
  const uint8_t* remembered(const Piece& piece) const { return remembered_.data() + piece.at; }
  // Of the way there: what it has made of the value for `offset`, converted; null: none is.
  const uint8_t* converted(uint32_t offset, uint32_t size) const;
  uint32_t source_size(const Piece& piece) const {  // kConvert: of one value
    return conversions_.source_size(conversion_of(piece));
  }
  // Reads a piece and writes it. False: ended by `on_loss`, not written.
  bool move(const Piece& piece, const uint8_t* source, uint8_t* target, const OnLoss& on_loss);
  // What that takes.
  void count(const Piece& piece, BoundaryWork& work) const;
  // Bytes from the first value's begin to the last one's end; 0 for what is initialised.
  uint64_t source_extent(const Piece& piece) const;
  uint64_t target_extent(const Piece& piece) const;
  // Is it made anew at the boundary, whatever it was before?
  bool is_late(const Piece& piece) const {
    return piece.kind == StepKind::kMigrate || piece.kind == StepKind::kEnter ||
           piece.kind == StepKind::kGather;
  }

  const Conversions& conversions() const { return conversions_; }
  const Plan& plan() const { return plan_; }

 private:
  struct Converted {  // one value that was written
    uint32_t to = 0;
    uint32_t size = 0;
    size_t at = 0;
    uint64_t end() const { return uint64_t{to} + size; }
  };

  bool pieces_cover(size_t bytes) const;
  void add_step(uint32_t number, size_t at);
  void add_bytes(Piece part, uint64_t length);
  const UpdateStep& step_of(const Piece& piece) const { return plan_.steps[piece.step]; }
  const ConvertedValues& conversion_of(const Piece& piece) const {
    return *step_of(piece).as<ConvertedValues>();
  }
  void read_values(const Piece& piece, const uint8_t* memory, uint8_t* out) const;
  void gather_parts(const Piece& piece, const uint8_t* memory, uint8_t* out) const;
  bool read_converted(const Piece& piece, const uint8_t* memory, uint8_t* out,
                      const OnLoss& on_loss) const;
  bool read_piece(const Piece& piece, const uint8_t* memory, const OnLoss& on_loss);
  bool read_back_converted(const Piece& piece, const uint8_t* memory, const Transfer& forward,
                           const OnLoss& on_loss);
  void restore_first(uint8_t* memory, size_t count) const;
  // Does memory still hold what this transfer converted to `offset`?
  bool still_as_converted(uint32_t offset, uint32_t size, const uint8_t* memory) const;
  size_t first_converted(uint32_t offset, size_t& hint) const;

  const Plan& plan_;
  Conversions conversions_;
  std::vector<Piece> pieces_;         // in the order of the steps
  std::vector<Converted> converted_;  // sorted
  // Where the search before ended: offsets go upwards.
  mutable size_t converted_hint_ = 0;
  base::Bytes staged_;
  base::Bytes saved_;
  base::Bytes remembered_;  // of the way back
};

}  // namespace online_change
