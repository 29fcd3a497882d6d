// Which files are not yet what somebody saved: away for a moment, or being written. Until they are
// complete nothing is built: a program without its variables is nobody's program.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "tools/stc/file_events.h"
#include "tools/stc/file_stamp.h"

namespace stc {

class Unfinished {
 public:
  using Time = FileEvents::Time;

  // Between what the files of a project were at the last build and what they are now, looked at
  // `time`: when the last of them is complete, if nothing is written until then; nullopt: they are.
  // Who is held back for longer than a writer may pause is told on stderr, once, by which file.
  std::optional<Time> until(const Stamps& before, const Stamps& now, const FileEvents& events,
                            Time time);

 private:
  struct Wait {
    Time until = Time::min();
    std::string why;
  };
  Wait for_files_away(const Stamps& before, const Stamps& now, Time time);
  static Wait for_writers(const Stamps& before, const Stamps& now, const FileEvents& events);

  std::map<std::string, Time> away_;  // since when
  std::optional<Time> held_since_;    // something that was saved
  bool told_ = false;
};

}  // namespace stc
