#include "tools/common/table.h"

#include <algorithm>

#include "base/visible_text.h"

namespace tools {
namespace {

constexpr size_t kMinColumn = 6;

std::string cell_text(const std::string& cell, size_t width, bool right) {
  if (cell.size() > width) return cell.substr(0, width - 2) + "..";
  std::string pad(width - cell.size(), ' ');
  return right ? pad + cell : cell + pad;
}

void shrink(std::vector<size_t>& widths, size_t limit) {
  for (;;) {
    size_t total = 2 * (widths.size() - 1);
    for (size_t width : widths) total += width;
    auto widest = std::max_element(widths.begin(), widths.end());
    if (total <= limit || *widest <= kMinColumn) return;
    *widest -= 1;
  }
}

}  // namespace

Table::Table(std::vector<std::string> titles) : titles_(std::move(titles)) {
  for (std::string& title : titles_) {
    right_.push_back(title.substr(0, 1) == ">");
    if (right_.back()) title.erase(0, title.find_first_not_of("> "));
  }
}

void Table::row(std::vector<std::string> cells) {
  cells.resize(titles_.size());
  for (std::string& cell : cells) cell = base::visible(cell);
  rows_.push_back(std::move(cells));
}

std::string Table::text(size_t width) const {
  std::vector<size_t> widths;
  for (const std::string& title : titles_) widths.push_back(title.size());
  for (const auto& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  shrink(widths, width);
  std::string out;
  auto add = [&](const std::vector<std::string>& cells) {
    std::string line;
    for (size_t i = 0; i < cells.size(); ++i) {
      if (i != 0) line += "  ";
      line += cell_text(cells[i], widths[i], right_[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  };
  add(titles_);
  for (const auto& row : rows_) add(row);
  return out;
}

}  // namespace tools
