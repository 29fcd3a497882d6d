// differential FIRST COUNT [SCANS]: random programs FIRST.. on every tier; states and traps must
// agree. differential --print SEED: the program. Ends with "N passed, N failed".
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "tests/differential/generator.h"
#include "tests/golden/runner/engine.h"

namespace {

struct Run {
  std::vector<std::string> states;
  std::string trap;
};

base::Result<Run> run_on(golden::Tier tier, const golden::Program& program, int scans) {
  auto engine = golden::make_engine(tier, program);
  if (!engine.ok()) return engine.error();
  Run out;
  for (int i = 0; i < scans && out.trap.empty(); ++i) {
    base::Result<std::string> trap = (*engine)->scan();
    if (!trap.ok()) return trap.error();
    out.trap = *trap;
    out.states.push_back((*engine)->state());
  }
  return out;
}

// First line in which two states differ: "scan 3: Main.x=1 | Main.x=2".
std::string difference(const Run& a, const Run& b) {
  for (size_t scan = 0; scan < std::min(a.states.size(), b.states.size()); ++scan) {
    std::istringstream left(a.states[scan]);
    std::istringstream right(b.states[scan]);
    for (std::string l, r; std::getline(left, l) && std::getline(right, r);) {
      if (l != r) return "scan " + std::to_string(scan + 1) + ": " + l + " | " + r;
    }
  }
  if (a.trap != b.trap) return "trap `" + a.trap + "` | `" + b.trap + "`";
  return a.states.size() == b.states.size() ? "" : "other number of scans";
}

enum class Verdict { kSame, kTrapped, kFailed };

Verdict test_seed(uint64_t seed, int scans) {
  golden::TestFile test;
  test.name = "seed" + std::to_string(seed) + ".st";
  test.versions.push_back(differential::random_program(seed));
  golden::Outcome outcome;
  base::Result<golden::Program> program = golden::compile(test, 0, outcome);
  if (!program.ok()) {
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed),
                base::to_string(program.error()).substr(0, 600).c_str());
    return Verdict::kFailed;
  }
  Run oracle;
  for (golden::Tier tier : golden::kTiers) {
    base::Result<Run> run = run_on(tier, *program, scans);
    std::string wrong = !run.ok()                          ? base::to_string(run.error())
                        : tier == golden::Tier::kEvaluator ? ""
                                                           : difference(oracle, *run);
    if (!wrong.empty()) {
      std::printf("seed %llu, %s: %s\n", static_cast<unsigned long long>(seed),
                  golden::tier_name(tier), wrong.c_str());
      return Verdict::kFailed;
    }
    if (tier == golden::Tier::kEvaluator) oracle = std::move(*run);
  }
  return oracle.trap.empty() ? Verdict::kSame : Verdict::kTrapped;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--print") == 0) {
    std::fputs(differential::random_program(std::strtoull(argv[2], nullptr, 10)).c_str(), stdout);
    return 0;
  }
  if (argc < 3) {
    std::fprintf(stderr, "usage: differential FIRST COUNT [SCANS] | --print SEED\n");
    return 2;
  }
  uint64_t first = std::strtoull(argv[1], nullptr, 10);
  uint64_t count = std::strtoull(argv[2], nullptr, 10);
  int scans = argc > 3 ? std::atoi(argv[3]) : 20;
  uint64_t failed = 0;
  uint64_t trapped = 0;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    Verdict verdict = test_seed(seed, scans);
    failed += verdict == Verdict::kFailed;
    trapped += verdict == Verdict::kTrapped;
  }
  std::printf("%llu programs ended in a trap, the same on every tier\n",
              static_cast<unsigned long long>(trapped));
  std::printf("%llu passed, %llu failed\n", static_cast<unsigned long long>(count - failed),
              static_cast<unsigned long long>(failed));
  return failed == 0 && count > 0 ? 0 : 1;
}
