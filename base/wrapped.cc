#include "base/wrapped.h"

#include <utility>

namespace base {

std::vector<std::string> wrapped(std::string_view text, size_t columns) {
  std::vector<std::string> out;
  std::string line;
  std::string word;
  auto end_word = [&] {
    if (word.empty()) return;
    if (!line.empty() && line.size() + 1 + word.size() > columns)
      out.push_back(std::exchange(line, {}));
    line += (line.empty() ? "" : " ") + std::exchange(word, {});
  };
  for (char c : text) {
    if (c == ' ' || ('\t' <= c && c <= '\r')) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
  if (!line.empty()) out.push_back(line);
  return out;
}

}  // namespace base
