#include "tools/stvm/fleet_waves.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "base/joined.h"
#include "tools/stvm/condition_parse.h"

namespace stvm {
namespace {

using tools::TomlValue;

struct TimeUnit {
  std::string_view name;
  int64_t ms;
};
constexpr TimeUnit kTimeUnits[] = {
    {"ms", 1}, {"s", 1000}, {"min", 60'000}, {"h", 3'600'000}, {"d", 86'400'000}};
constexpr int64_t kLongestMs = 366LL * 86'400'000;
constexpr int64_t kLongestWindowNs = 3'600'000'000'000;
constexpr int64_t kMostParallel = 256;
constexpr int64_t kMostControllers = 100'000;
constexpr int64_t kMsOfAPlan = 600'000;  // for the way between two waves
constexpr int64_t kLongestDeadlineMs = 100 * kLongestMs;  // has room in 64 bits as nanoseconds

class RollReader {
 public:
  RollReader(const std::string& file, const std::vector<FleetMember>& members)
      : file_(file), members_(members), taken_(members.size(), false) {}

  base::Result<RollSettings> run(const tools::TomlTable& table) {
    // Those of [roll] are the defaults of each wave.
    for (const auto& [key, value] : table) {
      if (key.starts_with("roll.")) take_roll(key.substr(5), value);
    }
    std::map<size_t, std::map<std::string, const TomlValue*>> waves;
    for (const auto& [key, value] : table) {
      if (key.starts_with("wave.")) take_wave_key(key, value, waves);
    }
    for (const auto& [number, keys] : waves) {
      if (!failed_) take_wave(keys);
    }
    finish(waves);
    if (failed_) return error_;
    return std::move(out_);
  }

 private:
  void fail(const tools::TomlPlace& place, const std::string& what) {
    if (failed_) return;
    failed_ = true;
    error_ = tools::toml_error(file_, place.line, place.column, what);
  }
  void fail_at_key(const TomlValue& value, const std::string& what) {
    fail({value.line, value.column}, what);
  }

  int64_t number(const TomlValue& value, int64_t least, int64_t most) {
    const int64_t* const given = std::get_if<int64_t>(&value.data);
    if (given != nullptr && *given >= least && *given <= most) return *given;
    fail(value.place, base::joined({"a number from ", std::to_string(least), " to ",
                                    std::to_string(most), " is wanted"}));
    return least;
  }
  int64_t time(const TomlValue& value) {
    const std::string* const text = std::get_if<std::string>(&value.data);
    const int64_t ms = text == nullptr ? -1 : roll_time_ms(*text);
    if (ms >= 0) return ms;
    fail(value.place, "a time is wanted: \"200ms\", \"30s\", \"10min\", \"2h\" or \"1d\"");
    return 0;
  }
  bool flag(const TomlValue& value) {
    const bool* const given = std::get_if<bool>(&value.data);
    if (given == nullptr) fail(value.place, "true or false is wanted");
    return given != nullptr && *given;
  }
  // Is it the second of two words?
  bool word(const TomlValue& value, std::string_view first, std::string_view second) {
    const std::string* const given = std::get_if<std::string>(&value.data);
    if (given != nullptr && (*given == first || *given == second)) return *given == second;
    fail(value.place, base::joined({"\"", first, "\" or \"", second, "\" is wanted"}));
    return false;
  }
  const std::vector<std::string>* texts(const TomlValue& value) {
    const auto* const given = std::get_if<std::vector<std::string>>(&value.data);
    if (given == nullptr) fail(value.place, "[\"a\", \"b\"] is wanted");
    return given;
  }

  void take_health(const TomlValue& value) {
    const std::vector<std::string>* const given = texts(value);
    if (given == nullptr) return;
    for (size_t i = 0; i < given->size() && !failed_; ++i) {
      size_t at = 0;
      base::Status added = add_condition((*given)[i], out_.guard, at);
      if (added.ok()) continue;
      tools::TomlPlace place = value.places[i];
      place.column += static_cast<uint32_t>(at) + 1;  // behind the quote
      fail(place, added.error().text);
    }
  }

  // Settings of waves, which [roll] has for all of them.
  bool take_common(const std::string& name, const TomlValue& value, Wave& wave) {
    if (name == "soak") {
      wave.soak_ms = time(value);
    } else if (name == "max_failed") {
      wave.max_failed = static_cast<uint32_t>(number(value, 0, kMostControllers));
    } else if (name == "parallel") {
      wave.parallel = static_cast<uint32_t>(number(value, 1, kMostParallel));
    } else if (name == "accept") {
      wave.accept_at_end = word(value, "after-soak", "at-end");
    } else if (name == "deadline") {
      wave.deadline_ms = time(value);
      deadline_place_ = value.place;
    } else {
      return false;
    }
    return true;
  }

  void take_roll(const std::string& name, const TomlValue& value) {
    GuardOrder& guard = out_.guard;
    if (take_common(name, value, common_)) return;
    if (name == "health") return take_health(value);
    if (name == "grace") {
      guard.grace_ns = time(value) * 1'000'000;
    } else if (name == "hold") {
      guard.hold_ns = time(value) * 1'000'000;
    } else if (name == "window") {
      guard.window_ns = time(value) * 1'000'000;
      if (guard.window_ns > kLongestWindowNs) fail(value.place, "a window is at most 1h long");
    } else if (name == "missed") {
      guard.most_missed = static_cast<uint64_t>(number(value, 0, INT64_MAX));
    } else if (name == "load") {
      guard.most_load = static_cast<uint64_t>(number(value, 1, 1000));
    } else if (name == "traps") {
      guard.traps = flag(value);
    } else if (name == "devices") {
      guard.devices = flag(value);
    } else if (name == "alarms") {
      guard.alarms = flag(value);
    } else if (name == "lost_after") {
      out_.lost_after_ms = time(value);
    } else if (name == "on_failure") {
      out_.undo_all = word(value, "undo-wave", "undo-all");
    } else if (name == "not_undone") {
      guard.stop_safe = word(value, "keep", "stop-safe");
    } else {
      fail_at_key(value, base::joined({"`", name,
                                       "` is not known; [roll] has health, grace, hold, window, "
                                       "missed, load, traps, devices, alarms, lost_after, "
                                       "on_failure, not_undone, and for all waves soak, deadline, "
                                       "max_failed, parallel and accept"}));
    }
  }

  void take_wave_key(const std::string& key, const TomlValue& value,
                     std::map<size_t, std::map<std::string, const TomlValue*>>& waves) {
    const size_t dot = key.find('.', 5);
    size_t wave = 0;
    const char* const end = key.data() + std::min(dot, key.size());
    const auto read = std::from_chars(key.data() + 5, end, wave);
    if (dot == std::string::npos || read.ptr != end || read.ec != std::errc()) {
      return fail_at_key(value, "waves are written as [[wave]], each with its settings");
    }
    waves[wave][key.substr(dot + 1)] = &value;
  }

  void add_member(Wave& wave, size_t member, const tools::TomlPlace& place) {
    if (taken_[member]) {
      return fail(place, "`" + members_[member].name + "` is in a wave already");
    }
    taken_[member] = true;
    wave.members.push_back(member);
  }
  void add_named(Wave& wave, const TomlValue& value) {
    const std::vector<std::string>* const names = texts(value);
    for (size_t i = 0; names != nullptr && i < names->size() && !failed_; ++i) {
      const auto found = std::find_if(members_.begin(), members_.end(), [&](const auto& member) {
        return member.name == (*names)[i];
      });
      if (found == members_.end()) {
        return fail(value.places[i], "no controller is called `" + (*names)[i] + "`");
      }
      add_member(wave, static_cast<size_t>(found - members_.begin()), value.places[i]);
    }
  }
  void add_next(Wave& wave, size_t count, const tools::TomlPlace& place) {
    for (size_t i = 0; i < members_.size() && wave.members.size() < count; ++i) {
      if (!taken_[i]) add_member(wave, i, place);
    }
  }

  void take_wave(const std::map<std::string, const TomlValue*>& keys) {
    Wave wave = common_;
    const TomlValue* who = nullptr;
    for (const auto& [name, value] : keys) {
      const bool names = name == "controllers" || name == "count" || name == "percent";
      if (names && who != nullptr) {
        return fail_at_key(*value, "a wave has one of controllers, count and percent");
      }
      if (names) who = value;
      if (names || take_common(name, *value, wave)) continue;
      return fail_at_key(*value, "`" + name +
                                     "` is not known; a wave has controllers, count or percent, "
                                     "soak, deadline, max_failed, parallel and accept");
    }
    const TomlValue& first = *keys.begin()->second;
    if (who == nullptr) return fail_at_key(first, "the wave has no controllers, count or percent");
    if (keys.contains("controllers")) {
      add_named(wave, *who);
    } else if (keys.contains("count")) {
      add_next(wave, static_cast<size_t>(number(*who, 1, kMostControllers)), who->place);
    } else {
      const auto percent = static_cast<size_t>(number(*who, 1, 100));
      add_next(wave, (members_.size() * percent + 99) / 100, who->place);
    }
    if (wave.members.empty()) fail(who->place, "no controller is left for this wave");
    if (wave.deadline_ms != 0 && wave.deadline_ms <= wave.soak_ms) {
      fail(deadline_place_, "the deadline is before the end of the soak: nobody could accept");
    }
    last_ = who->place;
    out_.waves.push_back(std::move(wave));
  }

  // Each controller is in one wave; deadlines that nobody gave leave time for two soaks, and those
  // of waves that are accepted at the end for all waves that follow.
  void finish(const std::map<size_t, std::map<std::string, const TomlValue*>>& waves) {
    if (failed_) return;
    if (waves.empty()) return fail({1, 1}, "there are no waves: add [[wave]] tables");
    std::string left;
    for (size_t i = 0; i < members_.size(); ++i) {
      if (!taken_[i]) left += (left.empty() ? "" : ", ") + members_[i].name;
    }
    if (!left.empty()) fail(last_, "controllers are left that are in no wave: " + left);
    int64_t later = 0;
    for (auto wave = out_.waves.rbegin(); wave != out_.waves.rend(); ++wave) {
      const int64_t own = 2 * wave->soak_ms + kMsOfAPlan;
      later = std::min(later + own, kLongestDeadlineMs);
      if (wave->deadline_ms == 0) wave->deadline_ms = wave->accept_at_end ? later : own;
    }
  }

  const std::string& file_;
  const std::vector<FleetMember>& members_;
  std::vector<bool> taken_;
  Wave common_;
  tools::TomlPlace last_{1, 1};
  tools::TomlPlace deadline_place_{1, 1};
  RollSettings out_;
  bool failed_ = false;
  base::Error error_{base::Refusal::kBadProject, {}};
};

}  // namespace

bool is_roll_key(const std::string& key) {
  return key.starts_with("roll.") || key.starts_with("wave.");
}

base::Result<RollSettings> roll_settings(const std::string& file, const tools::TomlTable& table,
                                         const std::vector<FleetMember>& members) {
  return RollReader(file, members).run(table);
}

int64_t roll_time_ms(const std::string& text) {
  int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || value < 0) return -1;
  const std::string_view unit(read.ptr, static_cast<size_t>(end - read.ptr));
  for (const TimeUnit& known : kTimeUnits) {
    if (known.name == unit && value <= kLongestMs / known.ms) return value * known.ms;
  }
  return -1;
}

std::string roll_time_text(int64_t ms) {
  const TimeUnit* best = &kTimeUnits[0];
  for (const TimeUnit& unit : kTimeUnits) {
    if (ms != 0 && ms % unit.ms == 0) best = &unit;
  }
  if (ms == 0) return "0s";
  return std::to_string(ms / best->ms) + std::string(best->name);
}

}  // namespace stvm
