// Compares scan times: images on stvm against the same programs in C.
//
//   bench_run --stvm PATH --images FOLDER [--json FILE] [--repeats N] [--only NAME] [--tiers a,b]
//
// A tier other than `stvm` is passed on as --tier; without --tiers, stvm chooses.
//
// The two sides run in turn, on one core; each figure is the median of the
// repeats. First both run 4096 scans from power-up and must have the same
// checksum of their state, or the program counts as failed: then it would not
// be the same work. Exit code 1 when any failed, never because of a time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "bench/measure.h"

extern "C" {
#define PROGRAM(name, scans)        \
  void name##_scan(int64_t now_ns); \
  uint32_t name##_checksum();
#include "bench/programs.def"
#undef PROGRAM
}

namespace bench {
namespace {

constexpr int64_t kPeriodNs = 10'000'000;
constexpr uint32_t kCheckedScans = 4096;
constexpr const char* kDefaultTier = "stvm";

struct Program {
  const char* name;
  uint32_t scans;
  void (*scan)(int64_t);
  uint32_t (*checksum)();
};

const Program kPrograms[] = {
#define PROGRAM(name, scans) {#name, scans, &name##_scan, &name##_checksum},
#include "bench/programs.def"
#undef PROGRAM
};

struct Options {
  std::string stvm;
  std::string images;
  std::string json;
  std::string only;
  std::vector<std::string> tiers = {kDefaultTier};
  uint32_t repeats = 7;
};

struct TierResult {
  std::string tier;
  double ns = 0;
  double ratio = 0;
  bool ran = false;  // this stvm has the tier
};

struct Result {
  const Program* program;
  double c_ns = 0;
  std::vector<TierResult> tiers;
  bool same_state = false;
};

// Nanoseconds of one scan in C: the median over short runs of scans, so that a
// scan in which the system did something else does not count, as on the other
// side. Simulated time goes on from measurement to measurement.
double c_scans(const Program& program, uint32_t scans, int64_t& now_ns) {
  constexpr uint32_t kRun = 16;
  std::vector<double> times;
  for (uint32_t done = 0; done < scans; done += kRun) {
    const auto start = std::chrono::steady_clock::now();
    for (uint32_t i = 0; i < kRun; ++i) {
      program.scan(now_ns);
      now_ns += kPeriodNs;
    }
    const std::chrono::duration<double, std::nano> elapsed =
        std::chrono::steady_clock::now() - start;
    times.push_back(elapsed.count() / kRun);
  }
  return median(times);
}

std::string image_of(const Options& options, const Program& program) {
  return options.images + "/" + program.name + ".image";
}

// The number behind the last '=' or ':' of what `--print` shows.
uint32_t printed_number(const std::string& text) {
  const size_t at = text.find_last_of("=:");
  return at == std::string::npos
             ? 0
             : static_cast<uint32_t>(std::strtoul(text.c_str() + at + 1, nullptr, 10));
}

std::vector<std::string> with_tier(std::vector<std::string> command, const std::string& tier) {
  if (tier != kDefaultTier) {
    command.insert(command.end(), {"--tier", tier});
  }
  return command;
}

uint32_t vm_checksum(const Options& options, const Program& program, const std::string& tier) {
  return printed_number(output_of(
      with_tier({options.stvm, "run", image_of(options, program), "--virtual-time", "--scans",
                 std::to_string(kCheckedScans), "--print", std::string(program.name) + ".Checksum"},
                tier)));
}

double vm_ns(const Options& options, const Program& program, const std::string& tier) {
  return json_number(output_of(with_tier({options.stvm, "bench", image_of(options, program),
                                          "--program", program.name, "--scans",
                                          std::to_string(program.scans), "--format", "json"},
                                         tier)),
                     "median_ns");
}

bool check_state(const Options& options, Result& result, int64_t& now_ns) {
  c_scans(*result.program, kCheckedScans, now_ns);
  const uint32_t expected = result.program->checksum();
  bool same = expected != 0;
  bool compared = false;
  for (TierResult& tier : result.tiers) {
    tier.ran = vm_ns(options, *result.program, tier.tier) > 0;
    if (!tier.ran) {
      continue;
    }
    compared = true;
    const uint32_t found = vm_checksum(options, *result.program, tier.tier);
    if (found != expected) {
      std::fprintf(stderr, "%s: checksum %u on tier %s, %u in C\n", result.program->name, found,
                   tier.tier.c_str(), expected);
      same = false;
    }
  }
  return same && compared;
}

Result measure(const Options& options, const Program& program) {
  Result result;
  result.program = &program;
  for (const std::string& tier : options.tiers) {
    result.tiers.push_back({tier});
  }
  int64_t now_ns = 0;
  result.same_state = check_state(options, result, now_ns);
  std::vector<double> c_times;
  std::vector<std::vector<double>> vm_times(result.tiers.size());
  for (uint32_t repeat = 0; repeat < options.repeats; ++repeat) {
    c_times.push_back(c_scans(program, program.scans, now_ns));
    for (size_t t = 0; t < result.tiers.size(); ++t) {
      if (result.tiers[t].ran) {
        vm_times[t].push_back(vm_ns(options, program, result.tiers[t].tier));
      }
    }
  }
  result.c_ns = median(c_times);
  for (size_t t = 0; t < result.tiers.size(); ++t) {
    result.tiers[t].ns = median(vm_times[t]);
    result.tiers[t].ratio = result.tiers[t].ns / result.c_ns;
  }
  return result;
}

void print_head(const Options& options, int core) {
  std::printf("ns per scan, median of %u alternating repeats, core %d\n\n%-12s %10s",
              options.repeats, core, "program", "C");
  for (const std::string& tier : options.tiers) {
    std::printf(" %10s %7s", tier.c_str(), "ratio");
  }
  std::printf("  state\n");
}

void print_row(const Result& result) {
  std::printf("%-12s %10.0f", result.program->name, result.c_ns);
  for (const TierResult& tier : result.tiers) {
    if (tier.ran) {
      std::printf(" %10.0f %7.2f", tier.ns, tier.ratio);
    } else {
      std::printf(" %10s %7s", "-", "-");
    }
  }
  std::printf("  %s\n", result.same_state ? "same" : "DIFFERS");
  std::fflush(stdout);
}

// 0 when no program ran on that tier.
double geometric_mean(const std::vector<Result>& results, size_t tier) {
  double logarithms = 0;
  int count = 0;
  for (const Result& result : results) {
    if (result.tiers[tier].ran) {
      logarithms += std::log(result.tiers[tier].ratio);
      ++count;
    }
  }
  return count == 0 ? 0 : std::exp(logarithms / count);
}

void write_json(const Options& options, const std::vector<Result>& results) {
  std::ofstream out(options.json);
  out << "{\"repeats\": " << options.repeats << ", \"programs\": [";
  const char* comma = "";
  for (const Result& result : results) {
    out << comma << "\n  {\"name\": \"" << result.program->name << "\", \"c_ns\": " << result.c_ns
        << ", \"same_state\": " << (result.same_state ? "true" : "false");
    for (const TierResult& tier : result.tiers) {
      if (tier.ran) {
        out << ", \"" << tier.tier << "_ns\": " << tier.ns << ", \"" << tier.tier
            << "_ratio\": " << tier.ratio;
      }
    }
    out << "}";
    comma = ",";
  }
  out << "\n], \"geometric_mean\": {";
  for (size_t t = 0; t < options.tiers.size(); ++t) {
    out << (t == 0 ? "" : ", ") << "\"" << options.tiers[t] << "\": " << geometric_mean(results, t);
  }
  out << "}}\n";
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (size_t from = 0; from <= list.size();) {
    const size_t to = std::min(list.find(',', from), list.size());
    parts.push_back(list.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    const std::string value = argv[i + 1];
    if (name == "--stvm") {
      options.stvm = value;
    } else if (name == "--images") {
      options.images = value;
    } else if (name == "--json") {
      options.json = value;
    } else if (name == "--only") {
      options.only = value;
    } else if (name == "--tiers") {
      options.tiers = split(value);
    } else if (name == "--repeats") {
      options.repeats = static_cast<uint32_t>(std::max(5, std::atoi(value.c_str())));
    } else {
      return false;
    }
  }
  return argc % 2 == 1 && !options.stvm.empty() && !options.images.empty();
}

int compare_all(const Options& options) {
  print_head(options, pin_to_one_core());
  std::vector<Result> results;
  for (const Program& program : kPrograms) {
    if (options.only.empty() || options.only == program.name) {
      results.push_back(measure(options, program));
      print_row(results.back());
    }
  }
  std::printf("%-12s %10s", "geom. mean", "");
  for (size_t t = 0; t < options.tiers.size(); ++t) {
    std::printf(" %10s %7.2f", "", geometric_mean(results, t));
  }
  std::printf("\n");
  if (!options.json.empty()) {
    write_json(options, results);
  }
  return std::all_of(results.begin(), results.end(), [](const Result& r) { return r.same_state; })
             ? 0
             : 1;
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  bench::Options options;
  if (!bench::parse(argc, argv, options)) {
    std::fputs(
        "usage: bench_run --stvm PATH --images FOLDER [--json FILE] [--repeats N] [--only NAME] "
        "[--tiers interp,native]\n",
        stderr);
    return 2;
  }
  return bench::compare_all(options);
}
