#include <algorithm>

#include "base/limits.h"
#include "frontend/ladder/read.h"
#include "frontend/network/element_text.h"
#include "frontend/network/head.h"
#include "frontend/network/layout.h"
#include "frontend/network/same.h"
#include "frontend/network/write.h"

namespace frontend::network {

namespace {

constexpr uint32_t kMinColumns = 60;   // of a rung, rails included
constexpr uint32_t kMaxColumns = 100;  // what is wider does not move the rail of other rungs

// A rung with the text of its elements.
struct Drawing {
  Placement placement;
  std::vector<std::string> texts;       // by cell
  std::vector<uint32_t> column_widths;  // left columns
  std::vector<bool> has_joint;          // by boundary
  std::vector<uint32_t> right_widths;   // by row, of what stands at the right rail
  uint32_t width = 0;
};

// Rows of columns that are written in any order; text stands in a column with what follows it in
// the next ones left empty.
class Canvas {
 public:
  Canvas(uint32_t rows, bool wide) : rows_(rows), wide_(wide) {}

  void fill(uint32_t row, uint32_t from, uint32_t to, char with) {
    reserve(row, to);
    for (uint32_t c = from; c < to; ++c) rows_[row][c] = with;
  }
  void put(uint32_t row, uint32_t column, std::string_view text) {
    uint32_t width = count_columns(text, wide_);
    reserve(row, column + width);
    for (uint32_t c = column; c < column + width; ++c) rows_[row][c].clear();
    rows_[row][column] = text;
  }
  std::string text(uint32_t row) const {
    std::string out;
    for (const std::string& cell : rows_[row]) out += cell;
    return out;
  }

 private:
  void reserve(uint32_t row, uint32_t columns) {
    if (rows_[row].size() < columns) rows_[row].resize(columns, " ");
  }
  std::vector<std::vector<std::string>> rows_;
  bool wide_;
};

// A character of any text that is no UTF-8 makes a byte a column everywhere (ladder/read.h).
bool is_wide(const Body& body) {
  for (const Network& network : body.networks) {
    if (!is_utf8(network.title)) return false;
    for (const std::string& comment : network.comments) {
      if (!is_utf8(comment)) return false;
    }
    for (const Element& element : network.elements) {
      bool good = is_utf8(element.operand.text) && is_utf8(element.type.text) &&
                  std::ranges::all_of(element.comments, is_utf8) && is_utf8(network.label.text);
      if (!good) return false;
    }
  }
  return true;
}

class Drawer {
 public:
  Drawer(const Body& body, uint32_t indent) : body_(body), indent_(indent), wide_(is_wide(body)) {}

  std::optional<std::string> run() {
    const std::vector<Headed> rungs = with_heads(body_);
    std::vector<Drawing> drawings;
    uint32_t rail = kMinColumns;
    for (const Headed& rung : rungs) {
      std::optional<Drawing> drawing = measure(rung.network != nullptr ? *rung.network : Network{});
      if (!drawing) return std::nullopt;
      if (drawing->width <= kMaxColumns) rail = std::max(rail, drawing->width);
      drawings.push_back(std::move(*drawing));
    }
    for (size_t n = 0; n < drawings.size(); ++n) {
      if (!out_.empty()) out_ += '\n';
      const std::string head = head_text(rungs[n].title, rungs[n].disabled);
      if (!head.empty()) row(head);
      for (const std::string& comment : rungs[n].comments) row(comment_rows(comment, indent_));
      if (!rungs[n].label.empty()) row(rungs[n].label + ":");
      if (!drawings[n].texts.empty()) draw(drawings[n], rail);
    }
    return std::move(out_);
  }

 private:
  std::optional<Drawing> measure(const Network& network);
  void draw(const Drawing& drawing, uint32_t rail);
  void row(std::string_view text) {
    out_.append(indent_, ' ');
    out_ += text;
    out_ += '\n';
  }

  const Body& body_;
  uint32_t indent_;
  bool wide_;
  std::string out_;
};

std::optional<Drawing> Drawer::measure(const Network& network) {
  Drawing drawing;
  std::optional<Placement> placement = place(network);
  if (!placement) return std::nullopt;
  drawing.placement = std::move(*placement);
  const Placement& p = drawing.placement;
  drawing.column_widths.resize(p.columns);
  drawing.right_widths.resize(p.rows);
  drawing.has_joint.resize(p.columns + 1);
  Sinks sinks(network);
  for (const Cell& cell : p.cells) {
    std::optional<std::string> text = ladder_element(network, sinks, cell);
    if (!text) return std::nullopt;
    uint32_t width = count_columns(*text, wide_);
    if (cell.at_right) {
      drawing.right_widths[cell.row] += width + 2;
    } else {
      drawing.column_widths[cell.column] = std::max(drawing.column_widths[cell.column], width);
    }
    drawing.texts.push_back(std::move(*text));
  }
  for (const Joint& joint : p.joints) drawing.has_joint[joint.boundary] = true;
  uint32_t right = 0;
  for (uint32_t width : drawing.right_widths) right = std::max(right, width);
  drawing.width = 2 + right;  // rails
  for (uint32_t width : drawing.column_widths) drawing.width += width;
  for (bool joint : drawing.has_joint) drawing.width += joint ? 5 : 2;
  if (uint64_t{drawing.width} * p.rows > base::kMaxRungCells) return std::nullopt;
  return drawing;
}

// Every row at once: wires first, then what stands on them.
void Drawer::draw(const Drawing& drawing, uint32_t rail) {
  const Placement& p = drawing.placement;
  uint32_t last = std::max(rail, drawing.width) - 1;  // column of the right rail
  std::vector<uint32_t> boundary_at;                  // first column of a boundary
  uint32_t at = 1;
  for (uint32_t b = 0; b <= p.columns; ++b) {
    boundary_at.push_back(at);
    at += drawing.has_joint[b] ? 5 : 2;
    if (b < p.columns) at += drawing.column_widths[b];
  }
  boundary_at.push_back(at);
  auto joint_at = [&](uint32_t b) { return boundary_at[b] + 2; };
  Canvas rows(p.rows, wide_);
  for (uint32_t r = 0; r < p.rows; ++r) rows.put(r, 0, "|");
  for (const Wire& wire : p.wires) {
    uint32_t from = wire.from_rail ? 1 : joint_at(wire.from);
    uint32_t to = wire.to_rail ? last : joint_at(wire.to);
    rows.fill(wire.row, from, to, '-');
    if (wire.to_rail) rows.put(wire.row, last, "|");
  }
  for (const Joint& joint : p.joints) {
    uint32_t column = joint_at(joint.boundary);
    for (uint32_t r = joint.rows.front(); r <= joint.rows.back(); ++r) rows.put(r, column, "|");
    for (uint32_t r : joint.rows) rows.put(r, column, "+");
  }
  std::vector<uint32_t> right_at(p.rows);
  for (uint32_t r = 0; r < p.rows; ++r) right_at[r] = last - drawing.right_widths[r];
  for (size_t c = 0; c < p.cells.size(); ++c) {
    const Cell& cell = p.cells[c];
    uint32_t column = right_at[cell.row];
    if (cell.at_right) {
      right_at[cell.row] += count_columns(drawing.texts[c], wide_) + 2;
    } else {
      column = boundary_at[cell.column] + (drawing.has_joint[cell.column] ? 5 : 2);
    }
    rows.put(cell.row, column, drawing.texts[c]);
  }
  for (uint32_t r = 0; r < p.rows; ++r) row(rows.text(r));
}

}  // namespace

std::optional<std::string> write_ladder(const Body& body, uint32_t indent) {
  if (body.language != Language::kLadder) return std::nullopt;
  std::optional<std::string> text = Drawer(body, indent).run();
  if (!text) return std::nullopt;
  // What an operand says may look like something else between the brackets of an element.
  base::Diagnostics diagnostics;
  Body again = ladder::read(*text, base::SourcePos{0}, diagnostics);
  if (!diagnostics.all().empty() ||
      canonical(again, Timing::kAsRead) != canonical(body, Timing::kAsRead))
    return std::nullopt;
  if (!is_one_diagram(Language::kLadder, *text)) return std::nullopt;
  return text;
}

}  // namespace frontend::network
