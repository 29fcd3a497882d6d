// Plain text tables for terminals: columns as wide as their content, the widest
// ones cut (with "..") until a row fits 80 columns. What a cell has of control characters is shown,
// not sent: names come out of images that others made (base/visible_text.h).
#pragma once

#include <string>
#include <vector>

namespace tools {

class Table {
 public:
  // A title that begins with '>' is right-aligned ("> scans").
  explicit Table(std::vector<std::string> titles);
  void row(std::vector<std::string> cells);
  bool empty() const { return rows_.empty(); }
  std::string text(size_t width = 80) const;

 private:
  std::vector<std::string> titles_;
  std::vector<bool> right_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace tools
