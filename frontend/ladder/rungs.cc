#include "frontend/ladder/rungs.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace frontend::ladder {
namespace {

using Code = base::DiagnosticCode;

// Sets of segments that wires join, by union-find.
class Sets {
 public:
  uint32_t add() {
    parents_.push_back(static_cast<uint32_t>(parents_.size()));
    return parents_.back();
  }
  uint32_t find(uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parents_[find(b)] = find(a); }

 private:
  std::vector<uint32_t> parents_;
};

enum class Rail : uint8_t { kNone, kLeft, kRight };

struct Wire {               // what is known of one segment
  uint32_t set = kNoNode;   // of wires
  uint32_t left = kNoNode;  // of elements: the sets beside them
  uint32_t right = kNoNode;
  Rail rail = Rail::kNone;
};

class Finder {
 public:
  Finder(const std::vector<Row>& rows, base::SourcePos begin, base::Diagnostics& diagnostics)
      : rows_(rows), begin_(begin.valid() ? begin.offset : 0), diagnostics_(diagnostics) {}

  std::vector<Rung> run() {
    wires_.resize(rows_.size());
    for (const Row& row : rows_) damaged_.push_back(row.damaged);
    find_left_rail();
    for (uint32_t r = 0; r < rows_.size(); ++r) wires_[r].resize(rows_[r].segments.size());
    find_rails();
    for (uint32_t r = 0; r < rows_.size(); ++r) join_row(r);
    joined_.resize(rows_.size());
    for (uint32_t r = 0; r < rows_.size(); ++r) join_below(r);
    for (uint32_t r = 0; r < rows_.size();) {
      uint32_t last = r;
      while (joined_[last]) ++last;
      if (!rows_[r].segments.empty()) make_rung(r, last);
      r = last + 1;
    }
    return std::move(rungs_);
  }

 private:
  // What is wrong with a row is said once.
  void report(Code code, uint32_t row, const Segment& at, std::string text, std::string fix) {
    if (damaged_[row]) return;
    damaged_[row] = true;
    diagnostics_.add(code, {{begin_ + at.byte}, {begin_ + at.byte + at.bytes}}, std::move(text),
                     std::move(fix));
  }

  void find_left_rail() {
    bool first_drawn = true;
    for (uint32_t r = 0; r < rows_.size(); ++r) {
      if (rows_[r].segments.empty()) continue;
      const Segment& first = rows_[r].segments.front();
      if (first.kind == SegmentKind::kBar) {
        left_rail_ = first.column;
        return;
      }
      if (first_drawn) {
        report(Code::kBadDrawing, r, first, "the drawing does not begin with the left rail",
               "write `|` in front of every rung");
      }
      first_drawn = false;
    }
  }

  // The right rail ends a row after a wire; where the row is empty else, rows around tell.
  void find_rails() {
    for (uint32_t r = 0; r < rows_.size(); ++r) {
      const std::vector<Segment>& row = rows_[r].segments;
      for (uint32_t i = 0; i < row.size(); ++i) {
        if (row[i].kind != SegmentKind::kBar) continue;
        bool touched = i > 0 && row[i - 1].end == row[i].column;
        bool last = i + 1 == row.size();
        Rail& rail = wires_[r][i].rail;
        if (row[i].column == left_rail_) {
          rail = Rail::kLeft;
        } else if (last && (touched || (r > 0 && is_right_rail(r - 1, row[i].column)))) {
          rail = Rail::kRight;
        }
      }
    }
    for (uint32_t r = static_cast<uint32_t>(rows_.size()); r-- > 1;) {
      const std::vector<Segment>& above = rows_[r - 1].segments;
      if (above.empty() || above.back().kind != SegmentKind::kBar) continue;
      Wire& bar = wires_[r - 1].back();
      bool free = bar.rail == Rail::kNone;
      if (free && is_right_rail(r, above.back().column)) bar.rail = Rail::kRight;
    }
  }

  bool is_right_rail(uint32_t r, uint32_t column) const {
    const std::vector<Segment>& row = rows_[r].segments;
    return !row.empty() && row.back().column == column && wires_[r].back().rail == Rail::kRight;
  }

  void join_row(uint32_t r) {
    const std::vector<Segment>& row = rows_[r].segments;
    for (uint32_t i = 0; i < row.size(); ++i) {
      if (!row[i].is_element()) wires_[r][i].set = sets_.add();
      if (i == 0 || row[i - 1].end != row[i].column) continue;
      Wire& before = wires_[r][i - 1];
      Wire& here = wires_[r][i];
      check_side(r, row[i - 1], before);
      check_side(r, row[i], here);
      bool element_before = row[i - 1].is_element();
      bool element_here = row[i].is_element();
      if (element_before && element_here) {
        before.right = here.left = sets_.add();
      } else if (element_before) {
        before.right = here.set;
      } else if (element_here) {
        here.left = before.set;
      } else {
        sets_.join(before.set, here.set);
      }
    }
  }

  // A `|` between rungs goes up and down only.
  void check_side(uint32_t r, const Segment& segment, const Wire& wire) {
    if (segment.kind != SegmentKind::kBar || wire.rail != Rail::kNone) return;
    report(Code::kBadDrawing, r, segment, "a wire touches `|` from its side",
           "write `+` where wires meet");
  }

  bool goes_vertical(uint32_t r, uint32_t i) const {
    SegmentKind kind = rows_[r].segments[i].kind;
    return kind == SegmentKind::kJoint ||
           (kind == SegmentKind::kBar && wires_[r][i].rail == Rail::kNone);
  }

  // Joins what stands above each other in this row and the next.
  void join_below(uint32_t r) {
    const std::vector<Segment>& row = rows_[r].segments;
    uint32_t j = 0;
    bool has_next = r + 1 < rows_.size();
    std::vector<bool> met(has_next ? rows_[r + 1].segments.size() : 0);
    for (uint32_t i = 0; i < row.size(); ++i) {
      if (!goes_vertical(r, i)) continue;
      bool found = false;
      if (has_next) {
        const std::vector<Segment>& next = rows_[r + 1].segments;
        while (j < next.size() && next[j].column < row[i].column) ++j;
        found = j < next.size() && next[j].column == row[i].column && goes_vertical(r + 1, j);
        if (found) {
          sets_.join(wires_[r][i].set, wires_[r + 1][j].set);
          joined_[r] = true;
          met[j] = true;
        }
      }
      if (!found && row[i].kind == SegmentKind::kBar) loose_bar(r, row[i], "below");
    }
    for (uint32_t k = 0; k < met.size(); ++k) {
      const Segment& below = rows_[r + 1].segments[k];
      bool bar = below.kind == SegmentKind::kBar && goes_vertical(r + 1, k);
      if (bar && !met[k]) loose_bar(r + 1, below, "above");
    }
  }

  void loose_bar(uint32_t r, const Segment& bar, const char* where) {
    report(Code::kOpenBranch, r, bar, std::string("this wire joins nothing ") + where + " it",
           "put `+` into the same column where it ends");
  }

  void make_rung(uint32_t first, uint32_t last) {
    Rung& rung = rungs_.emplace_back();
    rung.first_row = first;
    rung.last_row = last;
    std::unordered_map<uint32_t, uint32_t> nodes;
    auto node = [&](uint32_t set) {
      if (set == kNoNode) return kNoNode;
      auto [found, fresh] =
          nodes.emplace(sets_.find(set), static_cast<uint32_t>(rung.nodes.size()));
      if (fresh) rung.nodes.emplace_back();
      return found->second;
    };
    for (uint32_t r = first; r <= last; ++r) {
      rung.damaged = rung.damaged || damaged_[r];
      const std::vector<Segment>& row = rows_[r].segments;
      for (uint32_t i = 0; i < row.size(); ++i) {
        const Wire& wire = wires_[r][i];
        if (row[i].is_element()) {
          auto number = static_cast<uint32_t>(rung.pieces.size());
          rung.pieces.push_back(
              {row[i].kind, r, row[i].byte, row[i].bytes, node(wire.left), node(wire.right)});
          const Piece& piece = rung.pieces.back();
          if (piece.left != kNoNode) rung.nodes[piece.left].users.push_back(number);
          if (piece.right != kNoNode) rung.nodes[piece.right].drivers.push_back(number);
          continue;
        }
        Node& own = rung.nodes[node(wire.set)];
        own.powered = own.powered || wire.rail == Rail::kLeft;
        own.ends = own.ends || wire.rail == Rail::kRight;
        if (own.bytes == 0 || row[i].kind == SegmentKind::kWire) {
          own.byte = row[i].byte;
          own.bytes = row[i].bytes;
        }
      }
    }
    if (rung.pieces.empty()) return drop_empty(rung);
    if (!rung.damaged) check_joined(rung);
  }

  // Two rungs below each other, without a blank row, would be one when a `+` stands under a `+`.
  // Rarely that is meant, and it can be drawn so that nobody takes it for two.
  void check_joined(const Rung& rung) {
    uint32_t complete = 0;
    for (uint32_t r = rung.first_row; r <= rung.last_row; ++r) {
      const std::vector<Segment>& row = rows_[r].segments;
      bool coil = row.front().kind == SegmentKind::kCoil;
      bool joined = row.front().kind == SegmentKind::kJoint;
      uint32_t i = 1;
      for (; i < row.size() && row[i].column == row[i - 1].end; ++i) {
        coil = coil || row[i].kind == SegmentKind::kCoil;
        joined = joined || row[i].kind == SegmentKind::kJoint;
      }
      if (row.front().column != left_rail_ || !coil || !joined || ++complete != 2) continue;
      const Segment& at = row[1];
      diagnostics_.add(Code::kJoinedRungs,
                       {{begin_ + at.byte}, {begin_ + row[i - 1].byte + row[i - 1].bytes}},
                       "this row looks like a rung of its own, and a `+` under a `+` joins it with "
                       "the row above",
                       "for two rungs, leave a blank row between them; for one, join the rows in "
                       "front, and let the second coil begin at a `+` of its own: `+--( y )`");
    }
  }

  // Rails alone are blank rows; a wire alone is not.
  void drop_empty(const Rung& rung) {
    for (uint32_t r = rung.first_row; r <= rung.last_row; ++r) {
      for (const Segment& segment : rows_[r].segments) {
        if (segment.kind == SegmentKind::kBar) continue;
        report(Code::kRungWithoutCoil, r, segment, "this rung has no element",
               "put a contact and a coil on the wire, or take it away");
        rungs_.pop_back();
        return;
      }
    }
    rungs_.pop_back();
  }

  const std::vector<Row>& rows_;
  uint32_t begin_;
  base::Diagnostics& diagnostics_;
  uint32_t left_rail_ = kNoNode;
  std::vector<std::vector<Wire>> wires_;  // by row and segment
  std::vector<bool> joined_;              // with the row below
  std::vector<bool> damaged_;             // by row
  Sets sets_;
  std::vector<Rung> rungs_;
};

}  // namespace

std::vector<Rung> find_rungs(const std::vector<Row>& rows, base::SourcePos begin,
                             base::Diagnostics& diagnostics) {
  return Finder(rows, begin, diagnostics).run();
}

}  // namespace frontend::ladder
