#include "tools/stc/coverage_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/common/table.h"

namespace stc {
namespace {

using frontend::Site;
using frontend::SiteKind;

constexpr size_t kind_index(SiteKind kind) { return static_cast<size_t>(kind); }

const char* element_word(SiteKind kind) {
  switch (kind) {
    case SiteKind::kRung:
      return "network ";
    case SiteKind::kStep:
      return "step ";
    default:
      return "transition ";
  }
}

void add_site(CoveredFile& file, std::map<uint32_t, size_t>& decisions, const Site& site,
              uint64_t hits) {
  file.kinds[kind_index(site.kind)].add(hits != 0);
  if (site.kind == SiteKind::kPou) {
    file.pous.push_back({site.line, site.name, hits});
    return;
  }
  file.total.add(hits != 0);
  uint64_t& line = file.lines[site.line];
  if (site.kind == SiteKind::kBranch) {
    const auto [found, added] = decisions.emplace(site.decision, file.decisions.size());
    if (added) file.decisions.push_back({site.line, {}});
    file.decisions[found->second].sides.push_back({site.line, site.name, hits});
    return;
  }
  line = std::max(line, hits);
  if (site.kind == SiteKind::kStatement) return;
  file.elements.push_back({site.line, element_word(site.kind) + site.name, hits});
}

// A line that only decides (ELSIF) ran as often as it decided.
void finish_file(CoveredFile& file) {
  const auto by_line = [](const auto& a, const auto& b) { return a.line < b.line; };
  std::stable_sort(file.decisions.begin(), file.decisions.end(), by_line);
  std::stable_sort(file.pous.begin(), file.pous.end(), by_line);
  std::stable_sort(file.elements.begin(), file.elements.end(), by_line);
  for (const Decision& decision : file.decisions) {
    uint64_t decided = 0;
    for (const Counted& side : decision.sides) decided += side.hits;
    uint64_t& line = file.lines[decision.line];
    line = std::max(line, decided);
  }
  for (const auto& [line, hits] : file.lines) file.covered_lines.add(hits != 0);
  file.sides = file.kinds[kind_index(SiteKind::kBranch)];
}

// The end of a long path says more than its beginning.
std::string end_of_path(const std::string& path) {
  constexpr size_t kWidth = 22;  // what the other columns leave of 80
  return path.size() <= kWidth ? path : ".." + path.substr(path.size() - (kWidth - 2));
}

std::string share_text(const Reached& reached) {
  if (reached.all == 0) return "-";
  return std::to_string(reached.hit) + "/" + std::to_string(reached.all);
}

}  // namespace

double Reached::percent() const {
  return all == 0 ? 100.0 : std::floor(1000.0 * hit / all) / 10.0;
}

bool Decision::is_evaluated() const { return sides_hit() != 0; }

uint32_t Decision::sides_hit() const {
  const auto was_taken = [](const Counted& side) { return side.hits != 0; };
  return static_cast<uint32_t>(std::count_if(sides.begin(), sides.end(), was_taken));
}

CoverageReport coverage_report(const std::vector<Site>& sites, std::span<const uint64_t> hits,
                               const base::SourceMap& sources) {
  std::map<std::string, CoveredFile> files;
  std::map<uint32_t, size_t> decisions;  // a number occurs in one file
  for (size_t i = 0; i < sites.size(); ++i) {
    const Site& site = sites[i];
    CoveredFile& file = files[std::string(sources.file_name(site.file))];
    file.text = sources.text(site.file);
    add_site(file, decisions, site, i < hits.size() ? hits[i] : 0);
  }
  CoverageReport report;
  for (auto& [name, file] : files) {
    file.name = name;
    finish_file(file);
    for (size_t kind = 0; kind < file.kinds.size(); ++kind) {
      report.kinds[kind].add(file.kinds[kind]);
    }
    report.total.add(file.total);
    report.covered_lines.add(file.covered_lines);
    report.files.push_back(std::move(file));
  }
  return report;
}

std::vector<const CoveredFile*> by_missing(const CoverageReport& report) {
  std::vector<const CoveredFile*> files;
  for (const CoveredFile& file : report.files) files.push_back(&file);
  std::stable_sort(files.begin(), files.end(), [](const CoveredFile* a, const CoveredFile* b) {
    return a->total.missing() > b->total.missing();
  });
  return files;
}

std::string percent_text(const Reached& reached) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", reached.percent());
  return text;
}

std::string coverage_text(const CoverageReport& report) {
  tools::Table table({"file", "> statements", "> branches", "> rungs", "> steps", "> transitions",
                      "> reached"});
  const auto row = [&](const std::string& name, const auto& kinds, const Reached& total) {
    std::vector<std::string> cells{name};
    for (const SiteKind kind : {SiteKind::kStatement, SiteKind::kBranch, SiteKind::kRung,
                                SiteKind::kStep, SiteKind::kTransition}) {
      cells.push_back(share_text(kinds[kind_index(kind)]));
    }
    cells.push_back(percent_text(total) + " %");
    table.row(std::move(cells));
  };
  for (const CoveredFile* file : by_missing(report)) {
    row(end_of_path(file->name), file->kinds, file->total);
  }
  if (report.files.size() > 1) row("all files", report.kinds, report.total);
  return table.text();
}

}  // namespace stc
