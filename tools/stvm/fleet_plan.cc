#include "tools/stvm/fleet_plan.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <limits>

#include "base/joined.h"
#include "tools/common/files.h"

namespace stvm {
namespace {

constexpr std::array<std::string_view, 13> kStateNames = {
    "waiting", "starting", "on trial", "accepting", "accepted", "had it", "refused",
    "failed",  "lost",     "undoing",  "undone",    "stays",    "skipped"};
constexpr std::array<std::string_view, 6> kPhaseNames = {"running", "undoing",  "done",
                                                         "failed",  "aborting", "aborted"};

// Writes lines of a table.
class PlanWriter {
 public:
  void table(const std::string& name) { text_ += base::joined({"\n[", name, "]\n"}); }
  void text(const char* key, const std::string& value) { line(key, tools::toml_quoted(value)); }
  void name(const char* key, std::string_view value) { text(key, std::string(value)); }
  void number(const char* key, int64_t value) { line(key, std::to_string(value)); }
  void flag(const char* key, bool value) { line(key, value ? "true" : "false"); }
  void digest(const char* key, const base::Digest& value) { text(key, base::to_hex(value)); }
  std::string take() { return std::move(text_); }

 private:
  void line(const char* key, const std::string& value) {
    text_ += base::joined({key, " = ", value, "\n"});
  }
  std::string text_ = "# A roll-out: `stvm fleet watch`, `resume` and `abort` take this file.\n";
};

// Milliseconds since 1970 that have room in 64 bits as nanoseconds: the year 2255.
constexpr int64_t kLatestMs = 9'000'000'000'000;

// Reads them; one that is missing, of another type, or negative fails.
class PlanReader {
 public:
  explicit PlanReader(const tools::TomlTable& table) : table_(table) {}
  void table(const std::string& name) { prefix_ = name + "."; }
  void text(const char* key, std::string& value) { take(key, value); }
  void time(const char* key, int64_t& value) {
    take(key, value);
    if (value < 0 || value > kLatestMs) fail(key);
  }
  template <class T>
  void number(const char* key, T& value) {
    int64_t wide = 0;
    take(key, wide);
    if (wide < 0 || static_cast<uint64_t>(wide) > std::numeric_limits<T>::max()) return fail(key);
    value = static_cast<T>(wide);
  }
  void flag(const char* key, bool& value) { take(key, value); }
  void digest(const char* key, base::Digest& value) {
    std::string hex;
    take(key, hex);
    const auto digit = [](char c) { return c >= 'a' ? c - 'a' + 10 : c - '0'; };
    if (hex.size() != 2 * value.size() ||
        hex.find_first_not_of("0123456789abcdef") != std::string::npos) {
      return fail(key);
    }
    for (size_t i = 0; i < value.size(); ++i) {
      value[i] = static_cast<uint8_t>(digit(hex[2 * i]) * 16 + digit(hex[2 * i + 1]));
    }
  }
  template <class E, size_t N>
  void name(const char* key, E& value, const std::array<std::string_view, N>& names) {
    std::string text;
    take(key, text);
    for (size_t i = 0; i < N; ++i) {
      if (names[i] == text) {
        value = static_cast<E>(i);
        return;
      }
    }
    fail(key);
  }
  bool has(const char* key) const { return table_.contains(prefix_ + key); }
  const std::string& missing() const { return missing_; }

 private:
  void fail(const char* key) {
    if (missing_.empty()) missing_ = prefix_ + key;
  }
  template <class T>
  void take(const char* key, T& value) {
    const auto found = table_.find(prefix_ + key);
    const T* const given = found == table_.end() ? nullptr : std::get_if<T>(&found->second.data);
    if (given == nullptr) return fail(key);
    value = *given;
  }

  const tools::TomlTable& table_;
  std::string prefix_;
  std::string missing_;
};

void write_member(PlanWriter& writer, const RollMember& row) {
  writer.text("place", row.member.place);
  writer.name("state", roll_state_name(row.state));
  writer.number("since", row.since_ms);
  writer.flag("was_accepted", row.was_accepted);
  writer.number("silent", row.silent_ms);
  writer.text("edit", row.edit);
  writer.text("text", row.text);
  writer.digest("from", row.from);
  writer.digest("to", row.to);
}

void read_member(PlanReader& reader, RollMember& row) {
  reader.text("place", row.member.place);
  reader.name("state", row.state, kStateNames);
  reader.time("since", row.since_ms);
  reader.flag("was_accepted", row.was_accepted);
  reader.time("silent", row.silent_ms);
  reader.text("edit", row.edit);
  reader.text("text", row.text);
  reader.digest("from", row.from);
  reader.digest("to", row.to);
}

std::string table_of_member(size_t number) { return "controllers." + std::to_string(number + 1); }

// Controllers and waves, of the text of fleet.toml.
base::Status read_list(const std::string& file, RollPlan& plan) {
  base::Result<std::vector<FleetMember>> members = parse_fleet_list(file, plan.list);
  if (!members.ok()) return members.error();
  const base::Result<tools::TomlTable> table = tools::parse_toml(file, plan.list);
  if (!table.ok()) return table.error();
  base::Result<RollSettings> settings = roll_settings(file, *table, *members);
  if (!settings.ok()) return settings.error();
  plan.settings = std::move(*settings);
  for (size_t i = 0; i < members->size(); ++i) {
    for (size_t before = 0; before < i; ++before) {
      if ((*members)[before].name != (*members)[i].name) continue;
      return base::Error{base::Refusal::kUsage,
                         "fleet: two controllers are called `" + (*members)[i].name + "`"};
    }
  }
  plan.members.clear();
  for (FleetMember& member : *members) {
    plan.members.emplace_back();
    plan.members.back().member = std::move(member);
  }
  return base::Ok{};
}

// A folder is meant wherever the plan is gone on with.
std::string whole_place(const FleetMember& member) {
  if (!is_at_folder(member)) return member.place;
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(member.place, error);
  return error ? member.place : whole.string();
}

}  // namespace

std::string_view roll_state_name(RollState state) {
  return kStateNames[static_cast<size_t>(state)];
}

std::string_view roll_phase_name(RollPhase phase) {
  return kPhaseNames[static_cast<size_t>(phase)];
}

bool is_over(RollPhase phase) {
  return phase == RollPhase::kDone || phase == RollPhase::kFailed || phase == RollPhase::kAborted;
}

size_t RollPlan::wave_of(size_t member) const {
  for (size_t i = 0; i < settings.waves.size(); ++i) {
    for (const size_t one : settings.waves[i].members) {
      if (one == member) return i;
    }
  }
  return settings.waves.size();
}

std::string plan_text(const RollPlan& plan) {
  PlanWriter writer;
  writer.table("plan");
  writer.text("id", plan.id);
  writer.text("who", plan.who);
  writer.text("file", plan.file);
  writer.digest("digest", plan.digest);
  writer.text("list", plan.list);
  writer.number("stage_flags", plan.stage_flags);
  writer.number("switch_flags", plan.switch_flags);
  writer.flag("matching", plan.matching);
  writer.flag("confirm_each", plan.confirm_each);
  writer.name("phase", roll_phase_name(plan.phase));
  writer.number("wave", static_cast<int64_t>(plan.wave));
  writer.number("soak_from", plan.soak_from_ms);
  writer.text("why", plan.why);
  for (size_t i = 0; i < plan.members.size(); ++i) {
    writer.table(table_of_member(i));
    write_member(writer, plan.members[i]);
  }
  return writer.take();
}

base::Result<RollPlan> parse_plan(const std::string& path, const std::string& text) {
  const base::Result<tools::TomlTable> table = tools::parse_toml(path, text);
  if (!table.ok()) return table.error();
  RollPlan plan;
  PlanReader reader(*table);
  reader.table("plan");
  reader.text("id", plan.id);
  reader.text("who", plan.who);
  reader.text("file", plan.file);
  reader.digest("digest", plan.digest);
  reader.text("list", plan.list);
  reader.number("stage_flags", plan.stage_flags);
  reader.number("switch_flags", plan.switch_flags);
  reader.flag("matching", plan.matching);
  reader.flag("confirm_each", plan.confirm_each);
  reader.name("phase", plan.phase, kPhaseNames);
  reader.number("wave", plan.wave);
  reader.time("soak_from", plan.soak_from_ms);
  reader.text("why", plan.why);
  const auto bad = [&](const std::string& what) {
    return base::Error{base::Refusal::kBadProject,
                       path + " is no plan of a roll-out: " + what + " is missing or damaged"};
  };
  if (!reader.missing().empty()) return bad(reader.missing());
  if (base::Status listed = read_list(path + " (fleet.toml)", plan); !listed.ok()) {
    return listed.error();
  }
  for (size_t i = 0; i < plan.members.size(); ++i) {
    reader.table(table_of_member(i));
    read_member(reader, plan.members[i]);
  }
  reader.table(table_of_member(plan.members.size()));
  if (!reader.missing().empty()) return bad(reader.missing());
  if (reader.has("state")) return bad("the list of controllers");
  if (plan.wave >= plan.settings.waves.size()) return bad("plan.wave");
  return plan;
}

base::Result<RollPlan> read_plan(const std::string& path) {
  base::Result<std::string> text = tools::read_text(path);
  if (!text.ok()) return text.error();
  return parse_plan(path, *text);
}

base::Status write_plan(const std::string& path, const RollPlan& plan) {
  const std::string text = plan_text(plan);
  base::Status written = tools::write_file(
      path, base::ByteSpan(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  if (!written.ok()) return written;
  // Its name is in the folder, too.
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = fd >= 0 && ::fsync(fd) == 0;
  if (fd >= 0) ::close(fd);
  if (synced) return base::Ok{};
  return base::Error{base::Refusal::kFileUnwritable, path + ": its folder cannot be synced"};
}

base::Result<RollPlan> new_plan(const std::string& list_file) {
  RollPlan plan;
  base::Result<std::string> text = tools::read_text(list_file);
  if (!text.ok()) return text.error();
  plan.list = std::move(*text);
  if (base::Status listed = read_list(list_file, plan); !listed.ok()) return listed.error();
  for (RollMember& row : plan.members) row.member.place = whole_place(row.member);
  return plan;
}

}  // namespace stvm
