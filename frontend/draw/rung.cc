#include <algorithm>

#include "frontend/draw/pictures.h"
#include "frontend/draw/shapes.h"
#include "ir/types/types.h"

namespace frontend::draw {

using network::Cell;
using network::Joint;
using network::Kind;
using network::kNoPin;
using network::Wire;

namespace {

constexpr double kGap = 14;       // wire between columns
constexpr double kJointGap = 28;  // the same with a joint in the middle
constexpr double kRowGap = 6;

// Where power goes on, or would if something followed the box.
uint32_t power_output(const network::Element& block, const Cell& cell) {
  if (cell.output != kNoPin) return cell.output;
  bool enabled = ir::same_name(block.inputs[cell.input].name, "EN");
  const char* usual = enabled ? "ENO" : block.operand.empty() ? "" : "Q";
  for (uint32_t pin = 0; pin < block.outputs.size(); ++pin) {
    if (ir::same_name(block.outputs[pin].name, usual)) return pin;
  }
  return kNoPin;
}

}  // namespace

Rung::Rung(const network::Network& network, network::Placement placement, const Live* live)
    : network_(network), placement_(std::move(placement)), live_(live), power_(network, live) {
  measure();
}

void Rung::measure() {
  const network::Placement& p = placement_;
  network::Sinks sinks(network_);
  columns_.assign(p.columns, 0);
  right_columns_.assign(p.right_columns, 0);
  std::vector<double> up(p.rows, 10);
  std::vector<double> down(p.rows, 10);
  for (const Cell& cell : p.cells) {
    const network::Element& element = network_.elements[cell.element];
    Shape shape;
    double above;
    double below;
    if (element.kind == Kind::kBlock) {
      shape.box = true;
      shape.number = static_cast<uint32_t>(boxes_.size());
      std::vector<bool> attached(element.outputs.size(), true);
      BoxStyle style{cell.input, power_output(element, cell), live_, &power_};
      boxes_.push_back(make_box(network_, sinks, cell.element, attached, style));
      const Box& box = boxes_.back();
      shape.width = box.before + box.width + box.behind;
      above = box.up;
      below = box.down;
    } else {
      shape.number = static_cast<uint32_t>(symbols_.size());
      symbols_.push_back(make_symbol(element, live_));
      shape.width = symbols_.back().width;
      above = symbols_.back().up;
      below = symbols_.back().down;
    }
    double& column = cell.at_right ? right_columns_[cell.column] : columns_[cell.column];
    column = std::max(column, shape.width);
    up[cell.row] = std::max(up[cell.row], above);
    down[cell.row] = std::max(down[cell.row], below);
    shapes_.push_back(shape);
  }
  std::vector<bool> joint(p.columns + 1);
  for (const Joint& one : p.joints) joint[one.boundary] = true;
  double x = 0;
  for (uint32_t b = 0; b <= p.columns; ++b) {
    double gap = joint[b] ? kJointGap : kGap;
    boundaries_.push_back(x + gap / 2);
    x += gap + (b < p.columns ? columns_[b] : 0);
  }
  for (double width : right_columns_) x += width + kGap;
  width_ = x;
  double y = 0;
  for (uint32_t r = 0; r < p.rows; ++r) {
    wires_.push_back(y + up[r]);
    y += up[r] + down[r] + kRowGap;
  }
  height_ = y;
}

void Rung::widen_coil(double room) {
  if (right_columns_.empty() || right_columns_[0] >= room) return;
  width_ += room - right_columns_[0];
  right_columns_[0] = room;
}

// Draws one rung from left to right, boundary by boundary: `now_` is the power on each row's wire.
class Rung::Pen {
 public:
  Pen(const Rung& rung, Svg& svg, double y, double width)
      : rung_(rung), p_(rung.placement_), svg_(svg), y_(y), width_(width) {
    now_.assign(p_.rows, Truth::kUnknown);
    wires_.resize(p_.rows);
    left_.resize(p_.columns);
    right_.resize(p_.rows);
    for (const Wire& wire : p_.wires) wires_[wire.row].push_back(&wire);
    for (size_t c = 0; c < p_.cells.size(); ++c) {
      const Cell& cell = p_.cells[c];
      (cell.at_right ? right_[cell.row] : left_[cell.column]).push_back(c);
    }
  }

  void run() {
    svg_.rail(kLeft, y_, y_ + rung_.height_);
    svg_.rail(kLeft + width_, y_, y_ + rung_.height_);
    for (const Wire& wire : p_.wires) {
      if (!wire.from_rail) continue;
      now_[wire.row] = rung_.live_ != nullptr ? Truth::kTrue : Truth::kUnknown;
      line(wire.row, kLeft, boundary(0));
    }
    for (uint32_t b = 0; b <= p_.columns; ++b) {
      for (const Joint& joint : p_.joints) {
        if (joint.boundary == b) this->joint(joint);
      }
      if (b < p_.columns) column(b);
    }
    for (const Wire& wire : p_.wires) {
      if (wire.to_rail) end(wire.row);
    }
  }

 private:
  double boundary(uint32_t b) const { return kLeft + rung_.boundaries_[b]; }
  double row_y(uint32_t row) const { return y_ + rung_.wires_[row]; }
  void line(uint32_t row, double from, double to) {
    svg_.line(from, row_y(row), to, row_y(row), ink(now_[row]));
  }
  const Wire* wire_at(uint32_t row, uint32_t b) const {
    for (const Wire* wire : wires_[row]) {
      if (wire->from <= b && b <= wire->to) return wire;
    }
    return nullptr;
  }
  static bool comes_from_left(const Wire* wire, uint32_t b) {
    return wire != nullptr && (wire->from < b || wire->from_rail);
  }

  void joint(const Joint& joint) {
    double x = boundary(joint.boundary);
    Truth arrived = Truth::kFalse;
    for (uint32_t row : joint.rows) {
      const Wire* wire = wire_at(row, joint.boundary);
      if (comes_from_left(wire, joint.boundary)) arrived = any(arrived, now_[row]);
    }
    svg_.line(x, row_y(joint.rows.front()), x, row_y(joint.rows.back()), ink(arrived));
    for (uint32_t row : joint.rows) {
      now_[row] = arrived;
      const Wire* wire = wire_at(row, joint.boundary);
      bool corner = row == joint.rows.front() || row == joint.rows.back();
      bool through =
          comes_from_left(wire, joint.boundary) && (wire->to > joint.boundary || wire->to_rail);
      if (!corner || through) svg_.dot(x, row_y(row), ink(arrived));
    }
  }

  // Shapes stand in the middle between the boundaries.
  void column(uint32_t b) {
    double x = boundary(b);
    std::vector<double> from(p_.rows, x);
    double width = rung_.columns_[b];
    double start = (x + boundary(b + 1) - width) / 2;
    for (size_t c : left_[b]) {
      uint32_t row = p_.cells[c].row;
      line(row, x, start);
      from[row] = shape(c, start, width);
    }
    for (const Wire& wire : p_.wires) {
      if (wire.from <= b && b < wire.to) line(wire.row, from[wire.row], boundary(b + 1));
    }
  }

  // The last box of the row has no output that power could leave by.
  bool ends_in_box(uint32_t row) const {
    for (size_t c = p_.cells.size(); c-- > 0;) {
      const Cell& cell = p_.cells[c];
      if (cell.row != row) continue;
      const network::Element& element = rung_.network_.elements[cell.element];
      return rung_.shapes_[c].box && power_output(element, cell) == kNoPin;
    }
    return false;
  }

  // What stands at the right rail, or the wire there.
  void end(uint32_t row) {
    double at = kLeft + width_;
    for (size_t c : right_[row]) at -= rung_.right_columns_[p_.cells[c].column] + kGap;
    if (right_[row].empty() && ends_in_box(row)) return;
    line(row, boundary(p_.columns), at);
    for (size_t c : right_[row]) {
      double width = rung_.right_columns_[p_.cells[c].column];
      at = shape(c, at, width);
      const network::Element& element = rung_.network_.elements[p_.cells[c].element];
      if (!element.outputs.empty()) line(row, at, at + kGap);
      at += kGap;
    }
  }

  // Returns where its own wire ends.
  double shape(size_t c, double x, double width) {
    const Cell& cell = p_.cells[c];
    const Shape& shape = rung_.shapes_[c];
    const network::Element& element = rung_.network_.elements[cell.element];
    Truth& now = now_[cell.row];
    Ink in = ink(now);
    double y = row_y(cell.row);
    uint32_t output = shape.box                 ? power_output(element, cell)
                      : element.outputs.empty() ? kNoPin
                                                : 0;
    if (output != kNoPin) now = rung_.power_.output({cell.element, output});
    if (!shape.box) {
      draw_symbol(svg_, rung_.symbols_[shape.number], x, width, y, in, ink(now));
      return x + width;
    }
    const Box& box = rung_.boxes_[shape.number];
    svg_.line(x, y, x + box.before, y, in);
    draw_box(svg_, box, x, y);
    if (output != kNoPin) line(cell.row, x + box.before + box.width, x + width);
    return x + width;
  }

  const Rung& rung_;
  const network::Placement& p_;
  Svg& svg_;
  double y_;
  double width_;
  std::vector<Truth> now_;
  std::vector<std::vector<const Wire*>> wires_;  // by row
  std::vector<std::vector<size_t>> left_;        // cells, by column
  std::vector<std::vector<size_t>> right_;       // the same, by row
};

void Rung::draw(Svg& svg, double y, double width) const { Pen(*this, svg, y, width).run(); }

}  // namespace frontend::draw
