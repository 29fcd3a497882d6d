#include "tools/stc/difference.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace stc {
namespace {

constexpr size_t kContext = 3;
// How far lines are looked for around a place that differs.
constexpr size_t kReach = 400;

using Lines = std::vector<std::string_view>;

Lines lines_of(std::string_view text) {
  Lines out;
  while (!text.empty()) {
    size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    out.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return out;
}

// The nearest place after (a, b) where both go on with the same two lines (or end).
LineChange next_change(const Lines& from, const Lines& to, size_t a, size_t b) {
  auto same = [&](size_t i, size_t j) {
    if (i == from.size() || j == to.size()) return i == from.size() && j == to.size();
    if (from[i] != to[j]) return false;
    bool last = i + 1 == from.size() || j + 1 == to.size();
    return last || from[i + 1] == to[j + 1];
  };
  for (size_t sum = 1; sum <= kReach; ++sum) {
    for (size_t in_a = 0; in_a <= sum; ++in_a) {
      size_t i = a + in_a;
      size_t j = b + (sum - in_a);
      if (i <= from.size() && j <= to.size() && same(i, j)) return {a, i, b, j};
    }
  }
  return {a, from.size(), b, to.size()};
}

void append(std::string& out, char sign, std::string_view line) {
  out += sign;
  out += line;
  if (!line.ends_with('\n')) out += "\n\\ No newline at end of file\n";
}

std::string extent(size_t first, size_t count) {
  return std::to_string(count == 0 ? first : first + 1) + "," + std::to_string(count);
}

// Changes [first, last) with the lines around them.
void append_hunk(std::string& out, const Lines& from, const Lines& to,
                 const std::vector<LineChange>& changes, size_t first, size_t last) {
  size_t before = std::min(kContext, changes[first].a);
  size_t after = std::min(kContext, from.size() - changes[last - 1].a_end);
  size_t a = changes[first].a - before;
  size_t b = changes[first].b - before;
  out += "@@ -" + extent(a, changes[last - 1].a_end + after - a) + " +" +
         extent(b, changes[last - 1].b_end + after - b) + " @@\n";
  for (size_t n = first; n < last; ++n) {
    for (; a < changes[n].a; ++a) append(out, ' ', from[a]);
    for (; a < changes[n].a_end; ++a) append(out, '-', from[a]);
    for (b = changes[n].b; b < changes[n].b_end; ++b) append(out, '+', to[b]);
  }
  for (size_t end = a + after; a < end; ++a) append(out, ' ', from[a]);
}

}  // namespace

std::vector<LineChange> changes_between(const Lines& from, const Lines& to) {
  std::vector<LineChange> out;
  size_t a = 0;
  size_t b = 0;
  while (a < from.size() || b < to.size()) {
    if (a < from.size() && b < to.size() && from[a] == to[b]) {
      ++a;
      ++b;
      continue;
    }
    out.push_back(next_change(from, to, a, b));
    a = out.back().a_end;
    b = out.back().b_end;
  }
  return out;
}

std::string difference(std::string_view name, std::string_view before, std::string_view after) {
  Lines from = lines_of(before);
  Lines to = lines_of(after);
  std::vector<LineChange> changes = changes_between(from, to);
  if (changes.empty()) return {};
  std::string out = "--- " + std::string(name) + "\n+++ " + std::string(name) + "\n";
  for (size_t first = 0; first < changes.size();) {
    size_t last = first + 1;
    while (last < changes.size() && changes[last].a - changes[last - 1].a_end <= 2 * kContext) {
      ++last;
    }
    append_hunk(out, from, to, changes, first, last);
    first = last;
  }
  return out;
}

}  // namespace stc
