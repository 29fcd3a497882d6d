// Tables by IEC identifier: keys are views into the sources, compared without case.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace frontend {

// Not noexcept: tables keep the hashes of their keys then, instead of folding the names that they
// pass again and again.
struct FoldHash {
  size_t operator()(std::string_view name) const;
};
struct FoldEqual {
  bool operator()(std::string_view a, std::string_view b) const noexcept;
};
template <class T>
using NameMap = std::unordered_map<std::string_view, T, FoldHash, FoldEqual>;

// "Pump" of "A.B.Pump", all of it without a dot.
std::string_view last_name(std::string_view name);

// The way out of a mistake.
struct Fix {
  Fix() = default;
  Fix(std::string way) : text(std::move(way)) {}  // NOLINT(google-explicit-constructor)
  Fix(const char* way) : text(way) {}             // NOLINT(google-explicit-constructor)
  operator std::string() const { return text; }   // NOLINT(google-explicit-constructor)

  std::string text;
  std::string name;  // that was meant, perhaps
};

// Keeps the candidate that is nearest to what was written, for "did you mean".
// Names further away than a third of their letters are no help and stay out. A name without dots
// is compared with the last part of A.B.Name, too, which a USING would make visible.
class NearestName {
 public:
  explicit NearestName(std::string_view written);
  void offer(std::string_view candidate);
  template <class T>
  void offer_all(const NameMap<T>& names) {
    for (const auto& entry : names) offer(entry.first);
  }
  // "did you mean `X`?" or "".
  Fix fix() const;

 private:
  std::string written_;
  bool plain_;
  std::string best_;
  uint32_t best_distance_;
};

}  // namespace frontend
