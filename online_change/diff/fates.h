// The fate of every variable in a change (X1): exactly one each, known before
// anything happens.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace online_change {

enum class Fate : uint8_t {
  kKept,         // same address, same value; nothing is done
  kMoved,        // same value at another address
  kConverted,    // A14; may lose, depending on the live value
  kInitialised,  // new, or no rule: the new initial value
  kDropped,      // gone
};
const char* fate_name(Fate fate);

struct FateRow {
  Fate fate = Fate::kKept;
  std::string path;       // in the new version; of kDropped: in the old one
  std::string old_type;   // "" for added ones
  std::string new_type;   // "" for dropped ones
  bool may_lose = false;  // a value of the old type can be impossible in the new one
  std::string reason;  // "retyped", "new", "no conversion from REAL to STRING[10]", "area outgrown"
  uint64_t count = 1;  // leaf variables that this row stands for (arrays, identical instances)
  std::string old_path = {};  // of what was moved between variables: its path in the old version
};

// The reason of a row of an array that goes on, with fewer elements.
inline constexpr std::string_view kOutsideBounds = "elements outside the new bounds";
// Ends the reason of a row that stands for several variables or instances.
inline constexpr std::string_view kMoreLikeIt = " more like it";
inline bool stands_for_several(const FateRow& row) {
  return std::string_view(row.reason).ends_with(kMoreLikeIt);
}

// The reason of a row of a union's member that has another type, while the union keeps its bytes:
// no step belongs to it, and nothing is counted.
inline constexpr std::string_view kAnotherView = "reads bytes that stay as another type";

// How the reason of a row of something renamed begins; a rule moves parts under this word, too.
inline constexpr std::string_view kRenamed = "renamed from `";
inline bool is_renamed(const FateRow& row) { return row.reason.starts_with(kRenamed); }

struct FateCounts {
  uint64_t kept = 0, moved = 0, converted = 0, initialised = 0, dropped = 0;
  uint64_t total() const { return kept + moved + converted + initialised + dropped; }
};

}  // namespace online_change
