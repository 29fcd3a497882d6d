// Plain text tables for terminals: columns as wide as their content, the widest
// ones cut (with "..") until a row fits 80 columns.
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
