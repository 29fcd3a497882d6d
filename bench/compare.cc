#include "bench/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "bench/measure.h"

extern "C" {
#define PROGRAM(name, source, group, scans, peers) \
  void name##_scan(int64_t now_ns);                \
  uint32_t name##_checksum();
#include "bench/programs.def"
#undef PROGRAM
}

namespace bench {
namespace {

constexpr int64_t kPeriodNs = 10'000'000;
constexpr uint32_t kCheckedScans = 1024;  // the first in which every checksum is made
constexpr uint32_t kSamples = 500;        // of one measurement; each is a run of scans

uint32_t scans_per_sample(const Program& program) { return std::max(1u, program.scans / kSamples); }

// Nanoseconds of one scan in C: the median over short runs of scans, so that a run in
// which the system did something else does not count; `stvm bench` does the same.
// Simulated time goes on from measurement to measurement.
double c_scans(const Program& program, uint32_t scans, int64_t& now_ns) {
  using Clock = std::chrono::steady_clock;
  const uint32_t run = scans_per_sample(program);
  std::vector<double> times;
  for (uint32_t done = 0; done + run <= scans; done += run) {
    const auto start = Clock::now();
    for (uint32_t i = 0; i < run; ++i) {
      program.scan(now_ns);
      now_ns += kPeriodNs;
    }
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    times.push_back(elapsed.count() / run);
  }
  return median(times);
}

std::string image_of(const CompareOptions& options, const Program& program) {
  return options.images + "/" + program.name + ".image";
}

// An stvm that knows no --tier has the first tier alone.
bool knows_tiers(const CompareOptions& options) {
  return output_of({options.stvm, "bench", "--help"}).find("--tier") != std::string::npos;
}

std::vector<std::string> on_tier(std::vector<std::string> command, const CompareOptions& options,
                                 size_t tier) {
  if (tier != 0 || knows_tiers(options)) {
    command.insert(command.end(), {"--tier", kTiers[tier].name});
  }
  return command;
}

// The number behind the last '=' of what `--print` shows.
uint32_t printed_number(const std::string& text) {
  const size_t at = text.find_last_of('=');
  return at == std::string::npos
             ? 0
             : static_cast<uint32_t>(std::strtoul(text.c_str() + at + 1, nullptr, 10));
}

uint32_t vm_checksum(const CompareOptions& options, const Program& program, size_t tier) {
  return printed_number(output_of(
      on_tier({options.stvm, "run", image_of(options, program), "--virtual-time", "--scans",
               std::to_string(kCheckedScans), "--print", std::string(program.source) + ".Checksum"},
              options, tier)));
}

std::string vm_bench(const CompareOptions& options, const Program& program, size_t tier,
                     uint32_t scans) {
  return output_of(
      on_tier({options.stvm, "bench", image_of(options, program), "--program", program.source,
               "--scans", std::to_string(scans), "--batch",
               std::to_string(std::min(scans, scans_per_sample(program))), "--format", "json"},
              options, tier));
}

bool check_state(const CompareOptions& options, const std::vector<size_t>& tiers,
                 const Program& program, int64_t& now_ns) {
  for (uint32_t i = 0; i < kCheckedScans; ++i, now_ns += kPeriodNs) program.scan(now_ns);
  const uint32_t expected = program.checksum();
  bool same = expected != 0;
  for (size_t tier : tiers) {
    const uint32_t found = vm_checksum(options, program, tier);
    if (found == expected) continue;
    std::fprintf(stderr, "%s: checksum %u on tier %s, %u in C\n", program.name, found,
                 kTiers[tier].name, expected);
    same = false;
  }
  return same;
}

}  // namespace

const std::vector<Program>& programs() {
  static const std::vector<Program> kPrograms = {
#define PROGRAM(name, source, group, scans, peers) \
  {#name, #source, #group, scans, peers, &name##_scan, &name##_checksum},
#include "bench/programs.def"
#undef PROGRAM
  };
  return kPrograms;
}

std::vector<std::string> missing_images(const CompareOptions& options,
                                        const std::vector<Program>& programs) {
  std::vector<std::string> missing;
  for (const Program& program : programs) {
    if (!std::filesystem::exists(image_of(options, program))) missing.emplace_back(program.name);
  }
  return missing;
}

std::vector<size_t> present_tiers(const CompareOptions& options, const Program& program) {
  std::vector<size_t> present;
  for (size_t tier = 0; tier < kTierCount; ++tier) {
    const std::string name = kTiers[tier].name;
    if (options.tier != "all" && options.tier != name) continue;
    // An stvm that falls back to another tier says so in its answer.
    const std::string answer =
        tier == 0 || knows_tiers(options) ? vm_bench(options, program, tier, 10) : "";
    if (answer.find("\"tier\":\"" + name + "\"") != std::string::npos) {
      present.push_back(tier);
    } else {
      std::printf("tier %s is left out: this stvm does not have it on this machine\n",
                  name.c_str());
    }
  }
  return present;
}

Result compare(const CompareOptions& options, const std::vector<size_t>& tiers,
               const Program& program) {
  Result result;
  result.program = &program;
  int64_t now_ns = 0;
  result.same_state = check_state(options, tiers, program, now_ns);
  std::vector<double> c_times;
  std::vector<double> vm_times[kTierCount];
  for (uint32_t repeat = 0; repeat < options.repeats; ++repeat) {
    c_times.push_back(c_scans(program, program.scans, now_ns));
    for (size_t tier : tiers) {
      const std::string answer = vm_bench(options, program, tier, program.scans);
      vm_times[tier].push_back(json_number(answer, "median_ns"));
    }
  }
  result.c_ns = median(c_times);
  for (size_t tier : tiers) {
    const double ns = median(vm_times[tier]);
    const bool ran = ns > 0 && result.c_ns > 0;
    result.tiers[tier] = {ran, ns, ran ? ns / result.c_ns : 0};
  }
  return result;
}

double geometric_mean(const std::vector<Result>& results, size_t tier, const std::string& group) {
  double logarithms = 0;
  int count = 0;
  for (const Result& result : results) {
    if (!result.tiers[tier].ran || (!group.empty() && group != result.program->group)) continue;
    logarithms += std::log(result.tiers[tier].ratio);
    ++count;
  }
  return count == 0 ? 0 : std::exp(logarithms / count);
}

}  // namespace bench
