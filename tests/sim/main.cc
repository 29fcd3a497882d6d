// sim FIRST COUNT [--steps N | --hours N] [--jobs N] [--trace]: runs of seeds FIRST.. in a simulated
// plant, each in a process of its own: N steps, or N hours of the plant's time. A seed that breaks a
// law is printed, and the same seed breaks it again. Ends with counts.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/sim/violation.h"
#include "tests/sim/world.h"

namespace {

// Of processor time: a machine that is busy is no finding.
constexpr unsigned kSecondsPerSeed = 300;

struct Options {
  uint64_t first = 1;
  uint64_t count = 1;
  int steps = 60;
  int hours = 0;  // 0: steps
  uint64_t jobs = 1;
  bool trace = false;
};

Options parse(int argc, char** argv) {
  Options out;
  std::vector<uint64_t> numbers;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--trace") {
      out.trace = true;
    } else if (word == "--steps" && i + 1 < argc) {
      out.steps = std::atoi(argv[++i]);
    } else if (word == "--hours" && i + 1 < argc) {
      out.hours = std::atoi(argv[++i]);
    } else if (word == "--jobs" && i + 1 < argc) {
      out.jobs = static_cast<uint64_t>(std::max(1, std::atoi(argv[++i])));
    } else {
      numbers.push_back(std::strtoull(argv[i], nullptr, 10));
    }
  }
  if (!numbers.empty()) out.first = numbers[0];
  if (numbers.size() > 1) out.count = numbers[1];
  return out;
}

struct Sum {
  sim::Tally tally;
  uint64_t seeds = 0;
  uint64_t skipped = 0;
  uint64_t failed = 0;

  void add(const Sum& other) {
    tally.steps += other.tally.steps;
    tally.boundaries += other.tally.boundaries;
    tally.switches += other.tally.switches;
    tally.refusals += other.tally.refusals;
    tally.faults += other.tally.faults;
    tally.cuts += other.tally.cuts;
    tally.plant_ns += other.tally.plant_ns;
    seeds += other.seeds;
    skipped += other.skipped;
    failed += other.failed;
  }
};

Sum run_seed(uint64_t seed, const Options& options) {
  Sum out;
  sim::World world(seed, options.trace);
  const auto hourly = [seed](int hour, uint64_t most) {
    std::printf("seed %llu, hour %d: %.1f MB of the heap at most\n",
                static_cast<unsigned long long>(seed), hour, static_cast<double>(most) / 1e6);
    std::fflush(stdout);
  };
  try {
    const bool ran =
        options.hours != 0 ? world.endure(options.hours, hourly) : world.run(options.steps);
    ++(ran ? out.seeds : out.skipped);
  } catch (const sim::Violation& violation) {
    out.failed = 1;
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), violation.what());
  }
  out.tally = world.tally();
  return out;
}

constexpr int kMostSkipped = 20;

// In a process of its own, so that a crash is a finding too.
Sum isolated(uint64_t seed, const Options& options) {
  Sum out;
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    if (options.hours == 0) {
      const rlimit most{kSecondsPerSeed, kSecondsPerSeed};
      ::setrlimit(RLIMIT_CPU, &most);
    }
    Sum one = run_seed(seed, options);
    std::fflush(stdout);
    const bool told = ::write(ends[1], &one, sizeof one) == sizeof one;
    _exit(told ? 0 : 1);
  }
  ::close(ends[1]);
  if (::read(ends[0], &out, sizeof out) != sizeof out) {
    out = {};
    out.failed = 1;
    std::printf("seed %llu: crashed, or took more than %u s of processor time\n",
                static_cast<unsigned long long>(seed), kSecondsPerSeed);
  }
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return out;
}

Sum run_share(uint64_t number, const Options& options) {
  Sum out;
  for (uint64_t i = number; i < options.count; i += options.jobs) {
    uint64_t seed = options.first + i;
    Sum one = isolated(seed, options);
    // Another compiler makes another program of a seed. Hours are of a plant that can run.
    for (int more = 0; options.hours != 0 && one.skipped != 0 && more < kMostSkipped; ++more) {
      out.add(one);
      seed += options.count;
      one = isolated(seed, options);
    }
    out.add(one);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  int ends[2];
  if (::pipe(ends) != 0) return 1;
  for (uint64_t job = 0; job < options.jobs; ++job) {
    if (::fork() != 0) continue;
    Sum one = run_share(job, options);
    std::fflush(stdout);
    _exit(::write(ends[1], &one, sizeof one) == sizeof one ? 0 : 1);
  }
  ::close(ends[1]);
  Sum sum;
  for (Sum one; ::read(ends[0], &one, sizeof one) == sizeof one;) sum.add(one);
  while (::wait(nullptr) > 0) continue;
  auto number = [](uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf(
      "%llu seeds, %llu skipped, %llu failed: %llu steps, %llu boundaries, %llu switches, "
      "%llu refusals, %llu faults, %llu power cuts, %.1f h of the plant\n",
      number(sum.seeds), number(sum.skipped), number(sum.failed), number(sum.tally.steps),
      number(sum.tally.boundaries), number(sum.tally.switches), number(sum.tally.refusals),
      number(sum.tally.faults), number(sum.tally.cuts),
      static_cast<double>(sum.tally.plant_ns) / 3.6e12);
  return sum.failed != 0 || sum.seeds == 0 ? 1 : 0;
}
