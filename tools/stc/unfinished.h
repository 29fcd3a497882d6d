// Which files are not yet what somebody saved: away for a moment, or being written. Until they are
// complete nothing is built: a program without its variables is nobody's program.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "tools/stc/file_stamp.h"

namespace stc {

class Unfinished {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Nobody pauses longer in the middle of a file: what stays open longer is complete.
  explicit Unfinished(std::chrono::seconds longest_pause) : longest_pause_(longest_pause) {}

  // What the system says of writers.
  struct Writers {
    const std::map<std::string, Time>& begun;  // files that are not closed yet; the last write
    Time lost;  // when it was seen last that more had happened than the system could tell
  };
  // Between what the files of a project were at the last build and what they are now, looked at
  // `time`: when the last of them is complete, if nothing is written until then; nullopt: they are.
  // Who is held back for kToldAfter is told on stderr, once, by which file.
  static constexpr auto kToldAfter = std::chrono::seconds(5);
  std::optional<Time> until(const Stamps& before, const Stamps& now, const Writers& writers,
                            Time time);

 private:
  struct Wait {
    Time until = Time::min();
    std::string why;
  };
  Wait for_files_away(const Stamps& before, const Stamps& now, Time time);
  Wait for_writers(const Stamps& before, const Stamps& now, const Writers& writers) const;
  // Editors save by writing another file and renaming it, or remove the old one first: a file that
  // is away or empty is believed to be so when it has stayed so for as long.
  std::chrono::milliseconds believed_gone() const { return longest_pause_ / 5; }
  std::string pause_text() const { return std::to_string(longest_pause_.count()) + " s"; }

  const std::chrono::seconds longest_pause_;
  std::map<std::string, Time> away_;  // since when
  std::optional<Time> held_since_;    // something that was saved
  bool told_ = false;
};

}  // namespace stc
