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
constexpr double kArrow = 46;  // room where a wire goes on in another strip
constexpr double kStripGap = 12;

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

Rung::Rung(const network::Network& network, network::Placement placement, const Look& look)
    : network_(network),
      placement_(std::move(placement)),
      look_(look),
      power_(network, look.live) {
  measure();
  cut();
  stack();
}

Rung::Shape Rung::measure(const Cell& cell, const network::Sinks& sinks) {
  const network::Element& element = network_.elements[cell.element];
  Shape shape;
  if (element.kind == Kind::kBlock) {
    shape.box = true;
    shape.number = static_cast<uint32_t>(boxes_.size());
    std::vector<bool> attached(element.outputs.size(), true);
    BoxStyle style{cell.input, power_output(element, cell), &look_, &power_};
    boxes_.push_back(make_box(network_, sinks, cell.element, attached, style));
    const Box& box = boxes_.back();
    shape.width = box.before + box.width + box.behind;
    shape.up = box.up;
    shape.down = box.down;
  } else {
    shape.number = static_cast<uint32_t>(symbols_.size());
    symbols_.push_back(make_symbol(element, look_));
    shape.width = symbols_.back().width;
    shape.up = symbols_.back().up;
    shape.down = symbols_.back().down;
  }
  return shape;
}

void Rung::measure() {
  const network::Placement& p = placement_;
  network::Sinks sinks(network_);
  columns_.assign(p.columns, 0);
  right_columns_.assign(p.right_columns, 0);
  for (const Cell& cell : p.cells) {
    shapes_.push_back(measure(cell, sinks));
    double& column = cell.at_right ? right_columns_[cell.column] : columns_[cell.column];
    column = std::max(column, shapes_.back().width);
  }
  std::vector<bool> joint(p.columns + 1);
  for (const Joint& one : p.joints) joint[one.boundary] = true;
  double x = 0;
  for (uint32_t b = 0; b <= p.columns; ++b) {
    double gap = joint[b] ? kJointGap : kGap;
    boundaries_.push_back(x + gap / 2);
    x += gap + (b < p.columns ? columns_[b] : 0);
  }
  width_ = x;
  for (double width : right_columns_) width_ += width + kGap;
}

// Into strips of whole columns, each as wide as may be; what stands at the right rail is the last
// of them.
void Rung::cut() {
  const uint32_t columns = placement_.columns;
  const bool whole = look_.width <= 0 || width_ <= look_.width;
  double right = 0;
  for (double width : right_columns_) right += width + kGap;
  Strip strip;
  for (uint32_t c = 0; c < columns && !whole; ++c) {
    const double from = strip.first == 0 ? 0 : boundaries_[strip.first] - kArrow;
    const double end = boundaries_[c + 1] + kArrow - from;
    if (c == strip.first || end <= look_.width) continue;
    strip.last = c;
    strips_.push_back(strip);
    strip.first = c;
  }
  const double from = strip.first == 0 ? 0 : boundaries_[strip.first] - kArrow;
  const double end = boundaries_[columns] + kJointGap / 2 + right - from;
  if (!whole && end > look_.width && strip.first < columns) {
    strip.last = columns;
    strips_.push_back(strip);
    strip.first = columns;
  }
  strip.last = columns;
  strips_.push_back(strip);
  width_ = 0;
  for (Strip& each : strips_) {
    each.left = each.first == 0 ? 0 : boundaries_[each.first] - kArrow;
    const bool last = &each == &strips_.back();
    const double gap = last ? kJointGap / 2 + right : kArrow;
    width_ = std::max(width_, boundaries_[each.last] - each.left + gap);
  }
}

bool Rung::shows(const Strip& strip, const Cell& cell) const {
  if (cell.at_right) return &strip == &strips_.back();
  return strip.first <= cell.column && cell.column < strip.last;
}

// Rows of each strip, and the strips below each other.
void Rung::stack() {
  const network::Placement& p = placement_;
  double y = 0;
  for (Strip& strip : strips_) {
    const bool last = &strip == &strips_.back();
    std::vector<double> up(p.rows, 10);
    std::vector<double> down(p.rows, 10);
    std::vector<bool> used(p.rows, strips_.size() == 1);
    for (size_t c = 0; c < p.cells.size(); ++c) {
      const uint32_t row = p.cells[c].row;
      if (!shows(strip, p.cells[c])) continue;
      used[row] = true;
      up[row] = std::max(up[row], shapes_[c].up);
      down[row] = std::max(down[row], shapes_[c].down);
    }
    for (const Wire& wire : p.wires) {
      const bool longer = wire.to > strip.last || wire.to_rail;
      const bool goes_on = !last && longer && wire.from <= strip.last;
      if (goes_on) strip.going_on.push_back(wire.row);
      const bool begun = wire.from < strip.last || (last && wire.from <= strip.last) || goes_on;
      const bool here = begun && (wire.to > strip.first || wire.to_rail);
      used[wire.row] = used[wire.row] || here;
    }
    strip.top = y;
    strip.wires.assign(p.rows, y);
    for (uint32_t r = 0; r < p.rows; ++r) {
      strip.wires[r] = y + (used[r] ? up[r] : 0);
      if (used[r]) y += up[r] + down[r] + kRowGap;
    }
    strip.bottom = y;
    if (!last) y += kStripGap;
  }
  height_ = y;
}

void Rung::widen_coil(double room) {
  if (right_columns_.empty() || right_columns_[0] >= room) return;
  const Strip& last = strips_.back();
  right_columns_[0] = room;
  double end = boundaries_[last.last] - last.left + kJointGap / 2;
  for (double width : right_columns_) end += width + kGap;
  width_ = std::max(width_, end);
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
    for (const Strip& strip : rung_.strips_) {
      const bool first = &strip == &rung_.strips_.front();
      strip_ = &strip;
      first ? begin() : resume();
      if (first) joints(0);
      for (uint32_t b = strip.first; b < strip.last; ++b) {
        column(b);
        joints(b + 1);
      }
      &strip == &rung_.strips_.back() ? finish() : pause();
    }
  }

 private:
  double boundary(uint32_t b) const { return kLeft + rung_.boundaries_[b] - strip_->left; }
  double row_y(uint32_t row) const { return y_ + strip_->wires[row]; }
  void rail(double x) const { svg_.rail(x, y_ + strip_->top, y_ + strip_->bottom); }
  void line(uint32_t row, double from, double to) {
    svg_.line(from, row_y(row), to, row_y(row), ink(now_[row]));
  }

  void begin() {
    rail(kLeft);
    for (const Wire& wire : p_.wires) {
      if (!wire.from_rail) continue;
      now_[wire.row] = rung_.look_.live != nullptr ? Truth::kTrue : Truth::kUnknown;
      line(wire.row, kLeft, boundary(0));
    }
  }
  void finish() {
    rail(kLeft + width_);
    for (const Wire& wire : p_.wires) {
      if (wire.to_rail) end(wire.row);
    }
  }

  // Where wires go on in the next strip, and where they come from.
  void pause() {
    for (uint32_t row : strip_->going_on) {
      const double x = boundary(strip_->last);
      line(row, x, x + 16);
      svg_.arrow_right(x + 22, row_y(row), ink(now_[row]));
      svg_.text(x + 26, row_y(row) + 4, std::to_string(++paused_), Type::kNote);
    }
  }
  void resume() {
    const Strip& before = *(strip_ - 1);
    for (uint32_t row : before.going_on) {
      const double x = boundary(strip_->first);
      svg_.text(x - 30, row_y(row) + 4, std::to_string(++resumed_), Type::kNote, Anchor::kEnd);
      svg_.arrow_right(x - 18, row_y(row), ink(now_[row]));
      line(row, x - 20, x);
    }
  }

  void joints(uint32_t b) {
    for (const Joint& joint : p_.joints) {
      if (joint.boundary == b) this->joint(joint);
    }
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
  const Strip* strip_ = nullptr;
  uint32_t paused_ = 0;
  uint32_t resumed_ = 0;
  std::vector<Truth> now_;
  std::vector<std::vector<const Wire*>> wires_;  // by row
  std::vector<std::vector<size_t>> left_;        // cells, by column
  std::vector<std::vector<size_t>> right_;       // the same, by row
};

void Rung::draw(Svg& svg, double y, double width) const { Pen(*this, svg, y, width).run(); }

}  // namespace frontend::draw
