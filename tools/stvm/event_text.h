// Events in words: one line each for people, and as JSON.
#pragma once

#include <string>
#include <vector>

#include "online_change/store/journal.h"
#include "vm/runtime/forces.h"

namespace stvm {

const char* level_name(online_change::Level level);
// "switched 1a2b.. -> 3c4d.. by anna: 3 kept, ..., pause 12 us": one line, nothing in it speaks to
// a terminal.
std::string event_text(const online_change::JournalEntry& entry);
// "12 kept, 1 moved, ..."; "" where none are counted.
std::string counts_text(const online_change::FateCounts& counts);
// "pause 12 us, expected 10 us"; "": there is none.
std::string pause_text(const online_change::JournalEntry& entry);
// " 1a2b.. -> 3c4d.."
std::string versions_text(const online_change::JournalEntry& entry);
// "task Fast: a.st:7 (P): ...".
std::string what_text(const online_change::JournalEntry& entry);
// "... and 412 more like this in 10 s"
std::string more_text(uint64_t count, int64_t span_ns);
// "a, b, and 12 more": as many as an event has room for.
std::string list_text(const std::vector<std::string>& rows);
// Their paths.
std::string list_text(const std::vector<vm::Force>& forces);
// "90 s", "12 min", "3 h", "2 d"
std::string age_text(int64_t ns);

// A line for a log, with its end.
std::string log_line(online_change::Level level, int64_t time_ns, const std::string& text,
                     bool for_journald);

// A list of objects.
std::string events_json(const std::vector<online_change::JournalEntry>& entries);
// One line.
std::string event_json_line(const online_change::JournalEntry& entry);

}  // namespace stvm
