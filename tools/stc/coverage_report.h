// What the tests of a project reached: the counters of a run put together by file and line, and the
// forms in which people and other programs read it. docs/UNIT-TESTS.md says what is counted.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/source.h"
#include "frontend/coverage.h"

namespace stc {

struct Reached {
  uint32_t hit = 0;
  uint32_t all = 0;

  void add(bool reached) {
    hit += reached;
    ++all;
  }
  void add(const Reached& other) {
    hit += other.hit;
    all += other.all;
  }
  uint32_t missing() const { return all - hit; }
  // In tenths, rounded down: 100.0 only when nothing is missing. Of nothing, 100.
  double percent() const;
};

struct Counted {  // of one site
  uint32_t line = 0;
  std::string name;
  uint64_t hits = 0;
};

struct Decision {
  uint32_t line = 0;
  std::vector<Counted> sides;

  bool is_evaluated() const;
  uint32_t sides_hit() const;
};

struct CoveredFile {
  std::string name;
  std::string_view text;                 // of the SourceMap
  std::map<uint32_t, uint64_t> lines;    // that have code: how often the most frequent of it ran
  std::vector<Decision> decisions;       // in order of their lines
  std::vector<Counted> pous;
  std::vector<Counted> elements;         // rungs, steps and transitions: "step Fill"
  std::array<Reached, frontend::kSiteKinds> kinds;  // by SiteKind
  Reached total;                         // of all kinds but POUs
  Reached covered_lines;
  Reached sides;                         // of decisions; the same as kinds[kBranch]
};

struct CoverageReport {
  std::vector<CoveredFile> files;  // by name
  std::array<Reached, frontend::kSiteKinds> kinds;
  Reached total;
  Reached covered_lines;
};

// `hits` of each site; those after its end are 0. The report refers to `sources`.
CoverageReport coverage_report(const std::vector<frontend::Site>& sites,
                               std::span<const uint64_t> hits, const base::SourceMap& sources);

// A table of at most 80 columns; files with the most missing first.
std::string coverage_text(const CoverageReport& report);
// Tracefile of lcov, as genhtml and editors read it.
std::string lcov_text(const CoverageReport& report);
// Cobertura 04, as Jenkins, GitLab and Azure read it.
std::string cobertura_text(const CoverageReport& report);
// A page of its own, with the sources.
std::string coverage_page(const CoverageReport& report, const std::string& project);

// The files of `report`, those with the most missing first.
std::vector<const CoveredFile*> by_missing(const CoverageReport& report);
// "66.6": never rounded up to 100.
std::string percent_text(const Reached& reached);

}  // namespace stc
