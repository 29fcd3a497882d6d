// Compares scan times: images on stvm against the same programs in C (compare.h).
//
//   bench_run --stvm PATH --images FOLDER [--tier interp|native|all] [--only NAME]
//             [--repeats N] [--lost FILE] [--check yes] [--out FOLDER]
//
// Into --out: bench.json, performance.svg and scan.md, a section of the page. --check: only
// the states are compared. Exit code 1 when any differs, never because of a time.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "bench/compare.h"
#include "bench/measure.h"
#include "bench/scan_report.h"

namespace {

struct Options {
  bench::CompareOptions compare;
  std::string only;
  std::string lost;
  std::string out;
};

bool known_tier(const std::string& name) {
  return name == "all" || std::any_of(std::begin(bench::kTiers), std::end(bench::kTiers),
                                      [&](const bench::Tier& tier) { return name == tier.name; });
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    const std::string value = argv[i + 1];
    if (name == "--stvm") {
      options.compare.stvm = value;
    } else if (name == "--images") {
      options.compare.images = value;
    } else if (name == "--tier" && known_tier(value)) {
      options.compare.tier = value;
    } else if (name == "--repeats") {
      options.compare.repeats = static_cast<uint32_t>(std::max(5, std::atoi(value.c_str())));
    } else if (name == "--check") {
      options.compare.repeats = 0;
    } else if (name == "--only") {
      options.only = value;
    } else if (name == "--lost") {
      options.lost = value;
    } else if (name == "--out") {
      options.out = value;
    } else {
      return false;
    }
  }
  return argc % 2 == 1 && !options.compare.stvm.empty() && !options.compare.images.empty();
}

// Empty behind a message that says why.
std::vector<bench::Program> chosen_programs(const Options& options) {
  std::vector<bench::Program> chosen;
  for (const bench::Program& program : bench::programs()) {
    if (options.only.empty() || options.only == program.name) chosen.push_back(program);
  }
  if (chosen.empty()) std::fprintf(stderr, "no program is called %s\n", options.only.c_str());
  const std::vector<std::string> missing = bench::missing_images(options.compare, chosen);
  if (missing.empty()) return chosen;
  for (const std::string& name : missing) {
    std::fprintf(stderr, "%s/%s.image is missing\n", options.compare.images.c_str(), name.c_str());
  }
  std::fputs("`cmake --build build/release --target bench_images` makes the images\n", stderr);
  return {};
}

int run(const Options& options) {
  const std::vector<bench::Program> programs = chosen_programs(options);
  if (programs.empty()) return 1;
  const uint32_t repeats = options.compare.repeats;
  const int core = bench::pin_to_one_core();
  const std::vector<size_t> tiers = bench::present_tiers(options.compare, programs.front());
  if (repeats > 0) bench::print_head(tiers, repeats, core);
  std::vector<bench::Result> results;
  for (const bench::Program& program : programs) {
    results.push_back(bench::compare(options.compare, tiers, program));
    if (repeats > 0) bench::print_row(tiers, results.back());
  }
  const auto differing = std::count_if(results.begin(), results.end(),
                                       [](const bench::Result& r) { return !r.same_state; });
  if (repeats == 0) {
    std::printf("%zu programs on %zu tiers, %td differ from C\n", results.size(), tiers.size(),
                differing);
  } else {
    bench::print_means(tiers, results);
  }
  if (!options.out.empty() && repeats > 0) {
    const bench::Reasons reasons = bench::read_reasons(options.lost);
    std::ofstream(options.out + "/bench.json") << bench::scan_json(tiers, results, repeats);
    std::ofstream(options.out + "/performance.svg") << bench::scan_chart(tiers, results);
    std::ofstream(options.out + "/scan.md") << bench::scan_page(tiers, results, repeats, reasons);
  }
  return differing == 0 && !tiers.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fputs(
        "usage: bench_run --stvm PATH --images FOLDER [--tier interp|native|all] [--only NAME] "
        "[--repeats N] [--lost FILE] [--check yes] [--out FOLDER]\n",
        stderr);
    return 2;
  }
  return run(options);
}
