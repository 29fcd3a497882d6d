#include "tools/stvm/top_page.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "tools/common/fate_report.h"

namespace stvm {
namespace {

constexpr const char* kBold = "\x1b[1m";
constexpr const char* kRed = "\x1b[31m";
constexpr const char* kYellow = "\x1b[33m";
constexpr const char* kReverse = "\x1b[7m";
constexpr const char* kPlain = "\x1b[0m";

std::string count_text(uint64_t value) {
  std::string digits = std::to_string(value);
  for (size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, " ");
  return digits;
}

// Hours and minutes; seconds below an hour.
std::string uptime_text(int64_t ns) {
  const int64_t seconds = ns / 1'000'000'000;
  char text[48];
  if (seconds < 3600) {
    std::snprintf(text, sizeof text, "%lldm %02llds", static_cast<long long>(seconds / 60),
                  static_cast<long long>(seconds % 60));
  } else {
    std::snprintf(
        text, sizeof text, "%lldd %02lldh %02lldm", static_cast<long long>(seconds / 86400),
        static_cast<long long>(seconds / 3600 % 24), static_cast<long long>(seconds / 60 % 60));
  }
  return text;
}

// What a task did between two reports.
struct Rate {
  double scans_per_s = 0;
  double load = 0;  // share of the time
};

class Page {
 public:
  Page(const vm::StatusReport& before, const vm::StatusReport& now, const TopView& view)
      : before_(before), now_(now), view_(view) {}

  std::string text() {
    head();
    tasks();
    devices();
    changes();
    alarms();
    return std::move(out_);
  }

 private:
  size_t left() const { return view_.height > lines_ ? view_.height - lines_ : 0; }

  void line(std::string text, const char* style = nullptr) {
    if (left() == 0) return;
    if (text.size() > view_.width) text = text.substr(0, view_.width - 2) + "..";
    if (style == kReverse) text.resize(view_.width, ' ');
    const bool styled = view_.color && style != nullptr;
    out_ += (styled ? style : "") + text + (styled ? kPlain : "") + "\n";
    ++lines_;
  }

  void head() {
    const bool trial = now_.edits != 0;
    std::string first = now_.name + ": " + (now_.faulted ? "FAULT" : "running") +
                        (trial ? ", on trial" : "") + "  " + base::short_hex(now_.running);
    const std::string up = "up " + uptime_text(now_.uptime_ns);
    if (first.size() + up.size() + 2 < view_.width) {
      first.resize(view_.width - up.size(), ' ');
      first += up;
    }
    line(first, now_.faulted ? kRed : kBold);
    uint64_t missed = 0;
    double load = 0;
    for (const vm::TaskStatus& task : now_.tasks) {
      missed += task.missed;
      load += rate_of(task).load;
    }
    char text[160];
    std::snprintf(text, sizeof text, "cycle %s  %s done  load %.1f %% %s  missed %s  forces %s",
                  tools::duration(now_.base_period_ns).c_str(), count_text(now_.cycles).c_str(),
                  load * 100, bar(load, view_.width > 100 ? 30 : 10).c_str(),
                  count_text(missed).c_str(), count_text(now_.forces).c_str());
    line(text, missed != 0 ? kYellow : nullptr);
    line("memory free " + count_text(now_.memory.free) + " of " + count_text(now_.memory.capacity) +
         " bytes, largest piece " + count_text(now_.memory.largest_free));
    line("");
  }

  static std::string bar(double share, size_t width) {
    const auto full =
        static_cast<size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(width) + 0.5);
    return "[" + std::string(full, '#') + std::string(width - full, '.') + "]";
  }

  Rate rate_of(const vm::TaskStatus& task) const {
    const auto elapsed = static_cast<double>(now_.uptime_ns - before_.uptime_ns);
    for (const vm::TaskStatus& old : before_.tasks) {
      if (old.name != task.name || elapsed <= 0 || task.scans < old.scans) continue;
      return {static_cast<double>(task.scans - old.scans) / elapsed * 1e9,
              static_cast<double>(task.run.total - old.run.total) / elapsed};
    }
    return {};
  }

  void tasks() {
    const bool wide = view_.width >= 110;
    const int name_width = wide ? 32 : 13;
    char text[256];
    std::snprintf(text, sizeof text, "%-*s %7s %4s %7s %5s %7s %7s %7s %6s", name_width, "TASK",
                  "PERIOD", "PRIO", "SCANS/S", "LOAD%", "AVERAGE", "P99", "LONGEST", "MISSED");
    line(text + std::string(wide ? "  DELAY P99" : ""), kReverse);
    // Devices, change and an alarm shall be seen too.
    const size_t others = 4 + (now_.devices.empty() ? 0 : now_.devices.size() + 2);
    const size_t room = std::max<size_t>(left() > others ? left() - others : 0, 3);
    size_t shown = 0;
    for (const vm::TaskStatus& task : now_.tasks) {
      if (task.once) continue;
      if (++shown == room && now_.tasks.size() > room) {
        line("... and " + std::to_string(now_.tasks.size() - shown + 1) + " more");
        break;
      }
      task_line(task, name_width, wide);
    }
    line("");
  }

  void task_line(const vm::TaskStatus& task, int name_width, bool wide) {
    const Rate rate = rate_of(task);
    const std::string period = task.freewheeling     ? "free"
                               : task.period_ns == 0 ? "event"
                                                     : tools::duration(task.period_ns);
    char text[256];
    std::snprintf(text, sizeof text, "%-*.*s %7s %4u %7.1f %5.1f %7s %7s %7s %6s", name_width,
                  name_width, task.name.c_str(), period.c_str(), task.priority, rate.scans_per_s,
                  rate.load * 100, tools::duration(task.run.average).c_str(),
                  tools::duration(task.run.p99).c_str(), tools::duration(task.run.max).c_str(),
                  short_count(task.missed).c_str());
    std::string row = text;
    if (wide) {
      std::snprintf(text, sizeof text, "  %9s  ", tools::duration(task.delay.p99).c_str());
      row += text + bar(rate.load, 20);
    }
    const char* style = task.stopped ? kRed : task.missed != 0 ? kYellow : nullptr;
    line(row + (task.stopped ? " STOPPED" : ""), style);
  }

  // At most six columns.
  static std::string short_count(uint64_t value) {
    if (value < 1'000'000) return std::to_string(value);
    if (value < 10'000'000'000) return std::to_string(value / 1'000'000) + "M";
    return std::to_string(value / 1'000'000'000) + "G";
  }

  void devices() {
    if (now_.devices.empty()) return;
    char text[256];
    std::snprintf(text, sizeof text, "%-16s %-18s %-8s %10s %8s %8s", "DEVICE", "DRIVER", "STATE",
                  "EXCH/S", "ERRORS", "AGE");
    line(text, kReverse);
    for (const vm::DeviceStatus& device : now_.devices) device_line(device);
    line("");
  }

  void device_line(const vm::DeviceStatus& device) {
    const auto elapsed = static_cast<double>(now_.uptime_ns - before_.uptime_ns);
    double rate = 0;
    for (const vm::DeviceStatus& old : before_.devices) {
      if (old.name != device.name || elapsed <= 0 || device.exchanges < old.exchanges) continue;
      rate = static_cast<double>(device.exchanges - old.exchanges) / elapsed * 1e9;
    }
    const std::string age = device.age_ns < 0 ? "never" : tools::duration(device.age_ns);
    char text[256];
    std::snprintf(text, sizeof text, "%-16.16s %-18.18s %-8s %10.1f %8llu %8s", device.name.c_str(),
                  device.driver.c_str(), device.state.c_str(), rate,
                  static_cast<unsigned long long>(device.errors), age.c_str());
    const bool lost = device.state == "lost";
    const std::string error = device.error.empty() ? "" : "  " + device.error;
    line(text + error, lost ? kRed : nullptr);
  }

  void changes() {
    std::string text = "change " + now_.change + ", edition " + std::to_string(now_.edition) +
                       ", boots next " +
                       base::short_hex(now_.last_edit_boots ? now_.running : now_.boots_next);
    if (now_.edits != 0) {
      text += ", undo brings " + base::short_hex(now_.previous);
    }
    line(text, now_.edits != 0 ? kYellow : nullptr);
  }

  void alarms() {
    const size_t total = now_.alarms.size() + now_.traps.size();
    if (total == 0) return line("no alarms, no traps");
    for (const std::string& alarm : now_.alarms) line("alarm: " + alarm, kRed);
    // The newest first: the page may end before the oldest.
    for (auto trap = now_.traps.rbegin(); trap != now_.traps.rend(); ++trap) {
      line("trap in cycle " + count_text(trap->cycle) + ": " + trap->task + ": " + trap->text.pou +
               ":" + std::to_string(trap->text.line) + " " + trap->text.text,
           kRed);
    }
  }

  const vm::StatusReport& before_;
  const vm::StatusReport& now_;
  TopView view_;
  std::string out_;
  size_t lines_ = 0;
};

}  // namespace

std::string top_page(const vm::StatusReport& before, const vm::StatusReport& now,
                     const TopView& view) {
  return Page(before, now, view).text();
}

}  // namespace stvm
