#include "tools/stvm/event_text.h"

#include <algorithm>

#include "base/hash.h"
#include "base/visible_text.h"
#include "tools/common/fate_report.h"
#include "tools/common/json.h"
#include "tools/stvm/controller_service.h"

namespace stvm {

using online_change::Event;
using online_change::JournalEntry;
using online_change::Level;

const char* level_name(Level level) {
  switch (level) {
    case Level::kError:
      return "error";
    case Level::kWarning:
      return "warning";
    case Level::kNotice:
      return "notice";
    case Level::kInfo:
      break;
  }
  return "info";
}

std::string versions_text(const JournalEntry& entry) {
  const base::Digest none{};
  std::string out;
  if (entry.from != none) out += " " + base::short_hex(entry.from);
  if (entry.from != none && entry.to != none) out += " ->";
  if (entry.to != none) out += " " + base::short_hex(entry.to);
  return out;
}

namespace {

struct FateCount {
  const char* name;
  uint64_t online_change::FateCounts::*count;
};
constexpr FateCount kFates[] = {{"kept", &online_change::FateCounts::kept},
                                {"moved", &online_change::FateCounts::moved},
                                {"converted", &online_change::FateCounts::converted},
                                {"initialised", &online_change::FateCounts::initialised},
                                {"dropped", &online_change::FateCounts::dropped}};

}  // namespace

std::string counts_text(const online_change::FateCounts& counts) {
  std::string out;
  if (counts.total() == 0) return out;
  for (const FateCount& fate : kFates) {
    if (!out.empty()) out += ", ";
    out += std::to_string(counts.*fate.count) + " " + fate.name;
  }
  return out;
}

std::string pause_text(const JournalEntry& entry) {
  std::string out;
  if (entry.measured_ns != 0) out = "pause " + tools::duration(entry.measured_ns);
  if (entry.predicted_ns != 0) {
    out += (out.empty() ? "expected " : ", expected ") + tools::duration(entry.predicted_ns);
  }
  return out;
}

std::string what_text(const JournalEntry& entry) {
  const bool both = !entry.source.empty() && !entry.text.empty();
  return base::visible(entry.source + (both ? ": " : "") + entry.text);
}

std::string event_text(const JournalEntry& entry) {
  std::string out = event_name(entry.event) + versions_text(entry);
  if (!entry.who.empty()) out += " by " + base::visible(entry.who);
  const char* between = ": ";
  for (const std::string& part : {what_text(entry), counts_text(entry.counts), pause_text(entry)}) {
    if (part.empty()) continue;
    out += between + part;
    between = "; ";
  }
  return out;
}

std::string list_text(const std::vector<std::string>& rows) {
  constexpr size_t kRoomForCount = 24;  // ", and 4096 more"
  std::string out;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (i != 0 && out.size() + rows[i].size() + kRoomForCount > online_change::kMaxText) {
      return out + ", and " + std::to_string(rows.size() - i) + " more";
    }
    if (i != 0) out += ", ";
    out += rows[i];
  }
  return out;
}

std::string list_text(const std::vector<vm::Force>& forces) {
  std::vector<std::string> paths;
  for (const vm::Force& force : forces) paths.push_back(force.path);
  return list_text(paths);
}

std::string age_text(int64_t ns) {
  constexpr struct {
    int64_t seconds;
    const char* name;
  } kUnits[] = {{86'400, " d"}, {3'600, " h"}, {60, " min"}};
  const int64_t seconds = ns / 1'000'000'000;
  for (const auto& unit : kUnits) {
    if (seconds >= 2 * unit.seconds) return std::to_string(seconds / unit.seconds) + unit.name;
  }
  return std::to_string(seconds) + " s";
}

std::string more_text(uint64_t count, int64_t span_ns) {
  return "... and " + std::to_string(count) + " more like this in " +
         age_text(std::max<int64_t>(span_ns, 1'000'000'000));
}

std::string log_line(Level level, int64_t time_ns, const std::string& text, bool for_journald) {
  std::string out;
  if (for_journald) {
    out += '<';
    out += static_cast<char>('0' + static_cast<int>(level));
    out += '>';
  } else {
    out += time_text(time_ns);
    out += ' ';
    out += level_name(level);
    out += ' ';
  }
  out += text;
  out += '\n';
  return out;
}

static void event_json(tools::JsonWriter& json, const JournalEntry& entry) {
  const online_change::EventRow& row = event_row(entry.event);
  json.begin_object().field("time", time_text(entry.time_ns)).field("time_ns", entry.time_ns);
  json.field("event", row.name).field("level", level_name(row.level));
  json.field("durable", row.kept != online_change::Kept::kMemory);
  json.field("source", entry.source).field("who", entry.who);
  json.field("from", base::to_hex(entry.from)).field("to", base::to_hex(entry.to));
  json.key("fates").begin_object();
  for (const FateCount& fate : kFates) json.field(fate.name, entry.counts.*fate.count);
  json.end_object().field("predicted_pause_ns", entry.predicted_ns);
  json.field("pause_ns", entry.measured_ns).field("cycle", entry.cycle);
  json.field("text", entry.text).end_object();
}

std::string events_json(const std::vector<JournalEntry>& entries) {
  tools::JsonWriter json;
  json.begin_array();
  for (const JournalEntry& entry : entries) event_json(json, entry);
  json.end_array();
  return json.finish();
}

std::string event_json_line(const JournalEntry& entry) {
  tools::JsonWriter json;
  event_json(json, entry);
  return json.finish();
}

}  // namespace stvm
