// stvm doctor: what this machine allows a controller, and what it would have to be told.
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tools/common/exit.h"
#include "tools/common/fate_report.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/histogram.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kDoctorOptions[] = {
    {"--period", "US", "period of the sleeps that are measured, in microseconds (default 1000)"},
    {"--seconds", "N", "how long to measure (default 2)"},
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kDoctorCommand{
    "doctor",       "", "Tells what this machine allows a controller in real time.",
    kDoctorOptions, 0,  0};

struct Finding {
  enum class Kind : uint8_t { kGood, kNote, kPoor };
  Kind kind = Kind::kGood;
  std::string what;
  std::string value;
  std::string advice;  // empty when there is nothing to do
};

const char* kind_text(Finding::Kind kind) {
  constexpr const char* kTexts[] = {"good", "note", "POOR"};
  return kTexts[static_cast<size_t>(kind)];
}

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

Finding kernel() {
  if (first_line("/sys/kernel/realtime") == "1") {
    return {Finding::Kind::kGood, "kernel", "PREEMPT_RT", ""};
  }
  return {Finding::Kind::kNote, "kernel", "not PREEMPT_RT",
          "delays of some 100 us can happen; install a kernel with PREEMPT_RT for periods of 1 ms"};
}

Finding fifo() {
  sched_param before{};
  const int policy = sched_getscheduler(0);
  sched_getparam(0, &before);
  sched_param wanted{};
  wanted.sched_priority = 50;
  const bool allowed = sched_setscheduler(0, SCHED_FIFO, &wanted) == 0;
  if (allowed) sched_setscheduler(0, policy, &before);
  if (allowed) return {Finding::Kind::kGood, "SCHED_FIFO", "allowed", ""};
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  return {Finding::Kind::kNote, "SCHED_FIFO",
          "refused (limit " + std::to_string(limit.rlim_cur) + ")",
          "raise `ulimit -r` or LimitRTPRIO for `stvm serve --fifo`"};
}

Finding locked_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool enough =
      limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= (rlim_t{256} << 20) || geteuid() == 0;
  if (enough) return {Finding::Kind::kGood, "locked memory", "allowed", ""};
  return {Finding::Kind::kNote, "locked memory",
          std::to_string(limit.rlim_cur >> 10) + " KiB at most",
          "raise `ulimit -l` or LimitMEMLOCK for `stvm serve --lock-memory`"};
}

Finding processors() {
  const unsigned count = std::max(1u, std::thread::hardware_concurrency());
  const std::string isolated = first_line("/sys/devices/system/cpu/isolated");
  const std::string value =
      std::to_string(count) + (isolated.empty() ? "" : ", isolated " + isolated);
  if (!isolated.empty()) {
    return {Finding::Kind::kGood, "processors", value, "`stvm serve --cpu` takes one of those"};
  }
  if (count > 1) {
    return {Finding::Kind::kNote, "processors", value,
            "boot with isolcpus=N to keep one for `stvm serve --cpu N`"};
  }
  return {Finding::Kind::kPoor, "processors", value,
          "devices and the control channel share it with the scans"};
}

Finding frequency() {
  const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (governor.empty()) return {Finding::Kind::kGood, "frequency", "fixed or unknown", ""};
  if (governor == "performance") return {Finding::Kind::kGood, "frequency", governor, ""};
  return {Finding::Kind::kNote, "frequency", governor,
          "run times vary; `cpupower frequency-set -g performance` keeps them"};
}

Finding clock_source() {
  const std::string source =
      first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  const bool slow = source == "hpet" || source == "acpi_pm";
  if (!slow) return {Finding::Kind::kGood, "clock", source.empty() ? "unknown" : source, ""};
  return {Finding::Kind::kPoor, "clock", source, "reading it takes about a microsecond; use tsc"};
}

// Looks at the groups that this process is in, from its own upwards.
Finding quota() {
  std::string group = first_line("/proc/self/cgroup");
  const size_t colon = group.rfind(':');
  group = colon == std::string::npos ? "" : group.substr(colon + 1);
  for (;;) {
    const std::string limit = first_line("/sys/fs/cgroup" + group + "/cpu.max");
    if (!limit.empty() && !limit.starts_with("max")) {
      return {Finding::Kind::kPoor, "CPU quota", limit,
              "the kernel stops the process when it is used up; take the limit away"};
    }
    const size_t slash = group.rfind('/');
    if (slash == std::string::npos) break;
    group.resize(slash);
  }
  return {Finding::Kind::kGood, "CPU quota", "none", ""};
}

// Absolute sleeps, as the control cycle does them.
Finding sleeps(int64_t period_ns, int64_t duration_ns) {
  vm::RealClock clock;
  vm::Histogram late;
  for (int64_t due = period_ns; due < duration_ns; due += period_ns) {
    clock.wait_until(due);
    late.add(clock.now_ns() - due);
  }
  const std::string value = "average " + tools::duration(late.average()) + ", 99 % " +
                            tools::duration(late.quantile(0.99)) + ", longest " +
                            tools::duration(late.max());
  const std::string what = "wakes late by";
  if (late.max() < period_ns / 10) return {Finding::Kind::kGood, what, value, ""};
  if (late.max() < period_ns) {
    return {Finding::Kind::kNote, what, value, "scans of this period start with that jitter"};
  }
  return {Finding::Kind::kPoor, what, value,
          "scans of " + tools::duration(period_ns) + " would be missed; take a longer period"};
}

void print_text(const std::vector<Finding>& findings) {
  for (const Finding& row : findings) {
    std::printf("%s  %-14s %s\n", kind_text(row.kind), row.what.c_str(), row.value.c_str());
    if (!row.advice.empty()) std::printf("      %-14s %s\n", "", row.advice.c_str());
  }
}

void print_json(const std::vector<Finding>& findings) {
  tools::JsonWriter json;
  json.begin_object().key("findings").begin_array();
  for (const Finding& row : findings) {
    json.begin_object().field("kind", kind_text(row.kind)).field("what", row.what);
    json.field("value", row.value).field("advice", row.advice).end_object();
  }
  json.end_array().end_object();
  std::fputs(json.finish().c_str(), stdout);
}

base::Result<int> examine(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<uint64_t> period_us = options.number("--period", 1000);
  if (!period_us.ok()) return period_us.error();
  base::Result<uint64_t> seconds = options.number("--seconds", 2);
  if (!seconds.ok()) return seconds.error();
  if (*period_us == 0 || *period_us > 10'000'000 || *seconds == 0 || *seconds > 86'400) {
    return base::Error{base::Refusal::kUsage, "--period is 1 to 10000000 us, --seconds 1 to 86400"};
  }
  std::vector<Finding> findings = {kernel(),    fifo(),         locked_memory(), processors(),
                                   frequency(), clock_source(), quota()};
  findings.push_back(sleeps(static_cast<int64_t>(*period_us) * 1000,
                            static_cast<int64_t>(*seconds) * 1'000'000'000));
  (json ? print_json : print_text)(findings);
  const bool poor = std::any_of(findings.begin(), findings.end(), [](const Finding& row) {
    return row.kind == Finding::Kind::kPoor;
  });
  return poor ? tools::kFindings : tools::kOk;
}

int run_doctor(const tools::Options& options) {
  base::Result<int> code = examine(options);
  return code.ok() ? *code : refuse(code.error());
}

}  // namespace

const Entry kDoctor{&kDoctorCommand, run_doctor};

}  // namespace stvm
