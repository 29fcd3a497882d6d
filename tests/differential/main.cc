// differential FIRST COUNT [--scans N] [--jobs N] [--shrink] [--write DIR]: random programs of
// seeds FIRST.. on every tier, in N processes at a time. With --changes: random changes of them
// while they run. With --forces: variables of them are forced. --shrink makes failing programs
// small and prints each as a golden file; --write puts them into DIR instead. --passes LIST:
// optimised by these, whatever the seed says. --dialect: programs of that dialect, compiled with it. differential --print SEED [--changes]: the program of
// a seed, its second version behind it. With --constructs: no program runs; how many have each
// construct, and an error when one has none. Ends with "N passed, N failed".
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "tests/differential/changes.h"
#include "tests/differential/constructs.h"
#include "tests/differential/edit.h"
#include "tests/differential/forces.h"
#include "tests/differential/generator.h"
#include "tests/differential/golden_text.h"
#include "tests/differential/isolated.h"
#include "tests/differential/shrink.h"

namespace {

using differential::Finding;
using differential::Program;

// Of processor time; sanitizers take ten times as long.
#ifdef STC_SANITIZED_HEAP
constexpr unsigned kSecondsPerProgram = 200;
#else
constexpr unsigned kSecondsPerProgram = 20;
#endif

struct Options {
  std::vector<uint64_t> numbers;
  int scans = 20;
  uint64_t jobs = 1;
  bool print = false;
  bool constructs = false;
  bool changes = false;
  bool forces = false;
  bool shrink = false;
  std::string folder;
  std::string passes;
  std::string dialect = "codesys";
};

Options parse_options(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    bool more = i + 1 < argc;
    if (word == "--print") {
      out.print = true;
    } else if (word == "--constructs") {
      out.constructs = true;
    } else if (word == "--changes") {
      out.changes = true;
    } else if (word == "--forces") {
      out.forces = true;
    } else if (word == "--shrink") {
      out.shrink = true;
    } else if (word == "--write" && more) {
      out.shrink = true;
      out.folder = argv[++i];
    } else if (word == "--passes" && more) {
      out.passes = argv[++i];
    } else if (word == "--dialect" && more) {
      out.dialect = argv[++i];
    } else if (word == "--scans" && more) {
      out.scans = std::atoi(argv[++i]);
    } else if (word == "--jobs" && more) {
      out.jobs = std::max(1, std::min(64, std::atoi(argv[++i])));
    } else {
      out.numbers.push_back(std::strtoull(argv[i], nullptr, 10));
    }
  }
  return out;
}

// One seed, as a program or as a pair of versions.
class Case {
 public:
  Case(uint64_t seed, const Options& options)
      : seed_(seed),
        options_(options),
        script_(differential::change_script(seed)),
        build_{options.passes.empty() ? differential::random_passes(seed) : options.passes,
               options.dialect},
        first_(differential::random_program(seed, !options.changes, build_.is_iec())),
        second_(options.changes ? differential::edited(first_, seed) : Program()) {}

  Finding examine() const { return examine(first_, second_); }

  std::string small_text(const Finding& finding) {
    auto same = [&](const Finding& now) { return now.key == finding.key; };
    for (int round = 0; round < (options_.changes ? 2 : 1); ++round) {
      first_ = differential::shrink(
          first_, [&](const Program& candidate) { return same(examine(candidate, second_)); });
      if (!options_.changes) break;
      second_ = differential::shrink(
          second_, [&](const Program& candidate) { return same(examine(first_, candidate)); });
    }
    Finding now = examine();
    std::string first = differential::print(first_);
    return options_.changes ? differential::change_text(first, differential::print(second_), seed_,
                                                        now, script_, build_)
                            : differential::run_text(first, seed_, now, options_.scans, build_);
  }

  void print() const {
    std::fputs(differential::print(first_).c_str(), stdout);
    if (!options_.changes) return;
    std::printf("// --- v2\n%s", differential::print(second_).c_str());
  }

 private:
  Finding examine(const Program& first, const Program& second) const {
    std::string source = differential::print(first);
    std::string next = differential::print(second);
    return differential::isolated(
        [&] {
          if (options_.forces) {
            return differential::examine_forces(source, seed_, options_.scans, build_);
          }
          return options_.changes ? differential::examine_change(source, next, script_, build_)
                                  : differential::examine(source, options_.scans, build_);
        },
        kSecondsPerProgram);
  }

  uint64_t seed_;
  const Options& options_;
  differential::ChangeScript script_;
  differential::Build build_;
  Program first_;
  Program second_;
};

void report_small(Case& one, uint64_t seed, const Finding& finding, const Options& options) {
  std::string text = one.small_text(finding);
  if (options.folder.empty()) {
    std::fputs(text.c_str(), stdout);
    return;
  }
  std::string path = options.folder + "/random_" + std::to_string(seed) + ".st";
  if (std::FILE* file = std::fopen(path.c_str(), "w")) {
    std::fputs(text.c_str(), file);
    std::fclose(file);
  } else {
    std::fprintf(stderr, "cannot write %s\n", path.c_str());
  }
}

struct Tally {
  uint64_t failed = 0;
  uint64_t trapped = 0;
  uint64_t at_once = 0;  // of them in the first scan
  uint64_t skipped = 0;
};

void run_seed(uint64_t seed, const Options& options, Tally& tally) {
  Case one(seed, options);
  Finding finding = one.examine();
  if (!finding.trap.empty()) ++tally.trapped;
  if (!finding.trap.empty() && finding.scan <= 1) ++tally.at_once;
  if (finding.key == "skipped") ++tally.skipped;
  if (!finding.failed) return;
  ++tally.failed;
  std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed),
              finding.text.substr(0, 400).c_str());
  if (options.shrink) report_small(one, seed, finding, options);
  std::fflush(stdout);
}

// Every `step`-th seed, in a process of its own; its tally comes through the pipe.
bool start_worker(uint64_t first, uint64_t end, uint64_t step, const Options& options, int pipe) {
  pid_t child = ::fork();
  if (child != 0) return child > 0;
  Tally tally;
  for (uint64_t seed = first; seed < end; seed += step) run_seed(seed, options, tally);
  bool told = ::write(pipe, &tally, sizeof tally) == sizeof tally;
  _exit(told ? 0 : 1);
}

std::optional<Tally> run_workers(uint64_t first, uint64_t end, const Options& options) {
  int ends[2];
  if (::pipe(ends) != 0) return std::nullopt;
  std::fflush(stdout);
  for (uint64_t job = 0; job < options.jobs; ++job) {
    if (!start_worker(first + job, end, options.jobs, options, ends[1])) return std::nullopt;
  }
  ::close(ends[1]);
  Tally sum;
  for (uint64_t job = 0; job < options.jobs; ++job) {
    Tally one;
    if (::read(ends[0], &one, sizeof one) != sizeof one) return std::nullopt;
    sum.failed += one.failed;
    sum.trapped += one.trapped;
    sum.at_once += one.at_once;
    sum.skipped += one.skipped;
  }
  ::close(ends[0]);
  while (::wait(nullptr) > 0) continue;
  return sum;
}

// Does every construct occur in the programs of these seeds?
int run_constructs(const Options& options) {
  std::vector<differential::ConstructCount> counts = differential::no_constructs();
  for (uint64_t i = 0; i < options.numbers[1]; ++i) {
    Program program = differential::random_program(options.numbers[0] + i, true, options.dialect == "iec");
    differential::count_constructs(differential::print(program), counts);
  }
  size_t missing = 0;
  for (const differential::ConstructCount& one : counts) {
    std::printf("%8llu %s\n", static_cast<unsigned long long>(one.programs), one.name);
    if (one.programs == 0) ++missing;
  }
  std::printf("%zu passed, %zu failed\n", counts.size() - missing, missing);
  return missing == 0 ? 0 : 1;
}

int run(const Options& options) {
  uint64_t first = options.numbers[0];
  uint64_t count = options.numbers[1];
  auto start = std::chrono::steady_clock::now();
  std::optional<Tally> sum = run_workers(first, first + count, options);
  if (!sum) {
    std::fprintf(stderr, "a process was lost\n");
    return 1;
  }
  const Tally& tally = *sum;
  double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.changes) {
    std::printf("%llu of %llu pairs were no change that can be made",
                static_cast<unsigned long long>(tally.skipped),
                static_cast<unsigned long long>(count));
  } else {
    std::printf("%llu programs ended in a trap, the same on every tier, %llu in the first scan",
                static_cast<unsigned long long>(tally.trapped),
                static_cast<unsigned long long>(tally.at_once));
  }
  std::printf("; %.1f programs per second\n", static_cast<double>(count) / seconds);
  std::printf("%llu passed, %llu failed\n",
              static_cast<unsigned long long>(count - tally.failed - tally.skipped),
              static_cast<unsigned long long>(tally.failed));
  // Pairs that are mostly skipped would test nothing.
  bool enough = tally.skipped * 2 < count;
  return tally.failed == 0 && enough ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options = parse_options(argc, argv);
  if (options.print && options.numbers.size() == 1) {
    Case(options.numbers[0], options).print();
    return 0;
  }
  if (options.numbers.size() != 2) {
    std::fprintf(
        stderr,
        "usage: differential FIRST COUNT [--scans N] [--jobs N] [--changes | --forces] [--shrink] "
        "[--passes LIST] [--dialect iec|codesys|twincat] "
        "[--write DIR] | --constructs | --print SEED [--changes]\n");
    return 2;
  }
  return options.constructs ? run_constructs(options) : run(options);
}
