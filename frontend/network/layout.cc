#include "frontend/network/layout.h"

#include <algorithm>
#include <iterator>

#include "frontend/network/branches.h"

namespace frontend::network {

bool is_placed(Kind kind) {
  return kind == Kind::kContact || kind == Kind::kCoil || kind == Kind::kBlock ||
         kind == Kind::kJump || kind == Kind::kReturn;
}

namespace {

constexpr uint32_t kToRail = 0xffffffffu;

class Placer {
 public:
  Placer(const Network& network, const Branches& branches)
      : network_(network), branches_(branches) {}

  Placement run() {
    out_.rows = series(branches_.rung, {0, 0, true, true}).rows;
    finish();
    return std::move(out_);
  }

 private:
  struct Start {
    uint32_t row = 0;
    uint32_t column = 0;
    bool at_rail = false;  // the left one
    bool ends = false;     // at the right one
  };
  struct Extent {
    uint32_t rows = 1;
    uint32_t column = 0;  // boundary behind it
  };
  struct Count {  // of what has been placed
    size_t cells = 0;
    size_t wires = 0;
    size_t joints = 0;
  };

  Extent series(const Series& items, Start start);
  Extent parts(const Item& item, Start start);
  size_t right_run(const Series& items) const;
  bool has_coil(const Series& items) const;
  bool has_coil_below(const Item& item) const;
  void cell(uint32_t element, uint32_t row, uint32_t column, bool at_right);
  void wire(uint32_t row, uint32_t from, uint32_t to, bool from_rail);
  Count count() const { return {out_.cells.size(), out_.wires.size(), out_.joints.size()}; }
  bool touches(const Count& above, const Count& begin, uint32_t row) const;
  void move_down(const Count& begin);
  void finish();

  const Network& network_;
  const Branches& branches_;
  Placement out_;
};

void Placer::cell(uint32_t element, uint32_t row, uint32_t column, bool at_right) {
  const PowerPins& pins = branches_.pins[element];
  out_.cells.push_back({element, row, column, at_right, pins.input, pins.output});
  uint32_t& columns = at_right ? out_.right_columns : out_.columns;
  columns = std::max(columns, column + 1);
}

void Placer::wire(uint32_t row, uint32_t from, uint32_t to, bool from_rail) {
  if (from < to || from_rail) out_.wires.push_back({row, from, to, from_rail, to == kToRail});
}

// The coils at the end of a row stand at the right rail.
size_t Placer::right_run(const Series& items) const {
  size_t count = 0;
  for (; count < items.size(); ++count) {
    const Item& item = items[items.size() - 1 - count];
    if (!item.branches.empty()) break;
    Kind kind = network_.elements[item.element].kind;
    if (kind != Kind::kCoil && kind != Kind::kJump && kind != Kind::kReturn) break;
  }
  return count;
}

// Branches behind branches up to the right rail: where they begin at the left one, each row would
// look like a rung of its own, if the first did not meet in front of where the next part.
bool joins_to_end(const Series& items) {
  return items.back().end && std::none_of(items.begin(), items.end(),
                                          [](const Item& item) { return item.branches.empty(); });
}

bool Placer::has_coil(const Series& items) const {
  return std::any_of(items.begin(), items.end(), [&](const Item& item) {
    return item.branches.empty()
               ? network_.elements[item.element].kind == Kind::kCoil
               : std::any_of(item.branches.begin(), item.branches.end(),
                             [&](const Series& branch) { return has_coil(branch); });
  });
}

// Is there a coil in a row below the first? From the left rail on that row would look like a rung
// of its own (E1050).
bool Placer::has_coil_below(const Item& item) const {
  for (size_t i = 1; i < item.branches.size(); ++i) {
    if (has_coil(item.branches[i])) return true;
  }
  return !item.branches.empty() &&
         std::any_of(item.branches[0].begin(), item.branches[0].end(),
                     [&](const Item& inside) { return has_coil_below(inside); });
}

Placer::Extent Placer::series(const Series& items, Start start) {
  Extent extent{1, start.column};
  size_t right = start.ends ? right_run(items) : 0;
  size_t left = items.size() - right;
  uint32_t wire_from = start.column;
  bool from_rail = start.at_rail;
  for (size_t i = 0; i < left; ++i) {
    const Item& item = items[i];
    if (item.branches.empty()) {
      cell(item.element, start.row, extent.column++, false);
      continue;
    }
    // Branches that begin at the rail and meet again have rows of their own there.
    const bool coils =
        has_coil_below(item) || (i + 1 < left && !items[i + 1].end && has_coil_below(items[i + 1]));
    bool at_rail = i == 0 && start.at_rail && !item.end && !coils;
    if (i == 1 && start.at_rail && joins_to_end(items)) {
      out_.columns = std::max(out_.columns, ++extent.column);
    }
    if (!at_rail) wire(start.row, wire_from, extent.column, from_rail);
    Extent part = parts(item, {start.row, extent.column, at_rail, item.end});
    extent.rows = std::max(extent.rows, part.rows);
    extent.column = part.column;
    if (item.end) return extent;
    wire_from = extent.column;
    from_rail = false;
  }
  for (size_t i = left; i < items.size(); ++i) {
    cell(items[i].element, start.row, static_cast<uint32_t>(items.size() - 1 - i), true);
  }
  if (start.ends) {
    wire(start.row, wire_from, kToRail, from_rail);
  } else if (items.empty() || items.back().branches.empty()) {
    wire(start.row, wire_from, extent.column, from_rail);
  }
  return extent;
}

// Branches, one below the other.
Placer::Extent Placer::parts(const Item& item, Start start) {
  Extent extent{0, start.column};
  Joint joint;
  std::vector<std::pair<uint32_t, uint32_t>> ends;  // row and boundary of each branch
  Count above;
  for (const Series& branch : item.branches) {
    Count begin = count();
    uint32_t row = start.row + extent.rows;
    Extent part = series(branch, {row, start.column, start.at_rail, start.ends});
    if (!joint.rows.empty() && touches(above, begin, row)) {
      move_down(begin);
      ++row;
      ++extent.rows;
    }
    above = begin;
    joint.rows.push_back(row);
    ends.emplace_back(row, part.column);
    extent.rows += part.rows;
    extent.column = std::max(extent.column, part.column);
  }
  if (!start.at_rail) {
    joint.boundary = start.column;
    out_.joints.push_back(joint);
  }
  if (start.ends) return extent;
  for (auto [row, column] : ends) wire(row, column, extent.column, false);
  joint.boundary = extent.column;
  out_.joints.push_back(std::move(joint));
  return extent;
}

// Does a joint of the branch above end right over one that begins in `row`?
bool Placer::touches(const Count& above, const Count& begin, uint32_t row) const {
  std::vector<uint32_t> boundaries;
  for (size_t j = above.joints; j < begin.joints; ++j) {
    if (out_.joints[j].rows.back() + 1 == row) boundaries.push_back(out_.joints[j].boundary);
  }
  std::sort(boundaries.begin(), boundaries.end());
  for (size_t j = begin.joints; j < out_.joints.size(); ++j) {
    if (out_.joints[j].rows.front() != row) continue;
    uint32_t boundary = out_.joints[j].boundary;
    if (std::binary_search(boundaries.begin(), boundaries.end(), boundary)) return true;
  }
  return false;
}

void Placer::move_down(const Count& begin) {
  for (size_t i = begin.cells; i < out_.cells.size(); ++i) ++out_.cells[i].row;
  for (size_t i = begin.wires; i < out_.wires.size(); ++i) ++out_.wires[i].row;
  for (size_t i = begin.joints; i < out_.joints.size(); ++i) {
    for (uint32_t& row : out_.joints[i].rows) ++row;
  }
}

// Sorts everything; wires and joints that touch become one: they are the same point of the rung.
void Placer::finish() {
  for (Wire& wire : out_.wires) {
    if (wire.to_rail) wire.to = out_.columns;
  }
  std::sort(out_.cells.begin(), out_.cells.end(), [](const Cell& a, const Cell& b) {
    if (a.row != b.row) return a.row < b.row;
    if (a.at_right != b.at_right) return b.at_right;
    return a.at_right ? a.column > b.column : a.column < b.column;
  });
  std::sort(out_.wires.begin(), out_.wires.end(), [](const Wire& a, const Wire& b) {
    if (a.row != b.row) return a.row < b.row;
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  std::vector<Wire> wires;
  for (const Wire& wire : out_.wires) {
    bool touch = !wires.empty() && wires.back().row == wire.row && wires.back().to >= wire.from;
    if (!touch) {
      wires.push_back(wire);
      continue;
    }
    wires.back().to = std::max(wires.back().to, wire.to);
    wires.back().from_rail |= wire.from_rail;
    wires.back().to_rail |= wire.to_rail;
  }
  out_.wires = std::move(wires);
  std::sort(out_.joints.begin(), out_.joints.end(), [](const Joint& a, const Joint& b) {
    return a.boundary != b.boundary ? a.boundary < b.boundary : a.rows.front() < b.rows.front();
  });
  std::vector<Joint> joints;
  for (Joint& joint : out_.joints) {
    bool touch = !joints.empty() && joints.back().boundary == joint.boundary &&
                 joints.back().rows.back() >= joint.rows.front();
    if (!touch) {
      joints.push_back(std::move(joint));
      continue;
    }
    std::vector<uint32_t> rows;
    std::set_union(joints.back().rows.begin(), joints.back().rows.end(), joint.rows.begin(),
                   joint.rows.end(), std::back_inserter(rows));
    joints.back().rows = std::move(rows);
  }
  out_.joints = std::move(joints);
}

}  // namespace

std::optional<Placement> place(const Network& network) {
  std::optional<Branches> branches = find_branches(network);
  if (!branches) return std::nullopt;
  return Placer(network, *branches).run();
}

}  // namespace frontend::network
