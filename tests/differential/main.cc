// differential FIRST COUNT [--scans N] [--shrink] [--write DIR]: random programs of seeds FIRST..
// on every tier. With --changes: random changes of them while they run. --shrink makes failing
// programs small and prints each as a golden file; --write puts them into DIR instead.
// differential --print SEED [--changes]: the program of a seed, its second version behind it.
// Ends with "N passed, N failed".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/differential/changes.h"
#include "tests/differential/edit.h"
#include "tests/differential/generator.h"
#include "tests/differential/golden_text.h"
#include "tests/differential/isolated.h"
#include "tests/differential/shrink.h"

namespace {

using differential::Finding;
using differential::Program;

constexpr unsigned kSecondsPerProgram = 20;

struct Options {
  std::vector<uint64_t> numbers;
  int scans = 20;
  bool print = false;
  bool changes = false;
  bool shrink = false;
  std::string folder;
};

Options parse_options(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    bool more = i + 1 < argc;
    if (word == "--print") {
      out.print = true;
    } else if (word == "--changes") {
      out.changes = true;
    } else if (word == "--shrink") {
      out.shrink = true;
    } else if (word == "--write" && more) {
      out.shrink = true;
      out.folder = argv[++i];
    } else if (word == "--scans" && more) {
      out.scans = std::atoi(argv[++i]);
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
        first_(differential::random_program(seed)),
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
    return options_.changes
               ? differential::change_text(first, differential::print(second_), seed_, now, script_)
               : differential::run_text(first, seed_, now, options_.scans);
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
          return options_.changes ? differential::examine_change(source, next, script_)
                                  : differential::examine(source, options_.scans);
        },
        kSecondsPerProgram);
  }

  uint64_t seed_;
  const Options& options_;
  differential::ChangeScript script_;
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
  uint64_t skipped = 0;
};

void run_seed(uint64_t seed, const Options& options, Tally& tally) {
  Case one(seed, options);
  Finding finding = one.examine();
  if (!finding.trap.empty()) ++tally.trapped;
  if (finding.key == "skipped") ++tally.skipped;
  if (!finding.failed) return;
  ++tally.failed;
  std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed),
              finding.text.substr(0, 400).c_str());
  if (options.shrink) report_small(one, seed, finding, options);
  std::fflush(stdout);
}

int run(const Options& options) {
  uint64_t first = options.numbers[0];
  uint64_t count = options.numbers[1];
  Tally tally;
  auto start = std::chrono::steady_clock::now();
  for (uint64_t seed = first; seed < first + count; ++seed) run_seed(seed, options, tally);
  double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.changes) {
    std::printf("%llu of %llu pairs were no change that can be made",
                static_cast<unsigned long long>(tally.skipped),
                static_cast<unsigned long long>(count));
  } else {
    std::printf("%llu programs ended in a trap, the same on every tier",
                static_cast<unsigned long long>(tally.trapped));
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
    std::fprintf(stderr,
                 "usage: differential FIRST COUNT [--scans N] [--changes] [--shrink] "
                 "[--write DIR] | --print SEED [--changes]\n");
    return 2;
  }
  return run(options);
}
