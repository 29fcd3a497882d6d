#include "tools/stc/unfinished.h"

#include <cstdio>

namespace stc {

std::optional<Unfinished::Time> Unfinished::until(const Stamps& before, const Stamps& now,
                                                  const Writers& writers, Time time) {
  const Wait away = for_files_away(before, now, time);
  const Wait written = for_writers(before, now, writers);
  const Wait& last = away.until < written.until ? written : away;
  if (time >= last.until || before == now) {
    held_since_.reset();
    told_ = false;
    if (time >= last.until) return std::nullopt;
    return last.until;
  }
  if (!held_since_) held_since_ = time;
  if (!told_ && time - *held_since_ >= kToldAfter) {
    told_ = true;
    std::fprintf(stderr, "waiting with what was saved: %s\n", last.why.c_str());
  }
  return last.until;
}

Unfinished::Wait Unfinished::for_files_away(const Stamps& before, const Stamps& now, Time time) {
  std::map<std::string, Time> away;
  Wait wait;
  auto at = now.begin();
  for (const auto& [path, stamp] : before) {
    if (stamp.bytes == 0) continue;
    while (at != now.end() && at->first < path) ++at;
    if (at != now.end() && at->first == path && at->second.bytes != 0) continue;
    const auto known = away_.find(path);
    const Time since = known == away_.end() ? time : known->second;
    away.emplace(path, since);
    if (since + believed_gone() > wait.until)
      wait = {since + believed_gone(), path + " appears and disappears"};
  }
  away_ = std::move(away);
  return wait;
}

Unfinished::Wait Unfinished::for_writers(const Stamps& before, const Stamps& now,
                                         const Writers& writers) const {
  Wait wait;
  for (const auto& [path, written] : writers.begun) {
    if (!before.contains(path) && !now.contains(path)) continue;
    const Time until = written + longest_pause_;
    if (until > wait.until) {
      wait = {until, path + " is being written; until it is closed, or for " + pause_text() +
                         " after its last write"};
    }
  }
  // Whatever differs may be being written.
  const Time until = writers.lost + longest_pause_;
  if (before != now && until > wait.until) {
    wait = {until, "more is written in these folders than the system can tell; until " +
                       pause_text() + " after its end"};
  }
  return wait;
}

}  // namespace stc
