// Coverage as one page without scripts: light and dark, files with the most missing first.
#include <algorithm>

#include "tools/stc/coverage_report.h"
#include "tools/stc/markup.h"

namespace stc {
namespace {

using frontend::SiteKind;

constexpr const char* kPageStyle = R"(
:root { color-scheme: light dark; --page: #fff; --ink: #1b1f24; --soft: #59636e; --rule: #d1d9e0;
  --hit: #dafbe1; --part: #fff3c4; --miss: #ffe1de; --bad: #c4302b; --box: #f6f8fa }
@media (prefers-color-scheme: dark) { :root { --page: #0d1117; --ink: #e6edf3; --soft: #9198a1;
  --rule: #30363d; --hit: #12321c; --part: #3d3000; --miss: #4a1a1a; --bad: #f47067;
  --box: #161b22 } }
body { background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, sans-serif;
  margin: 0 auto; max-width: 72rem; padding: 1rem }
h1 { font-size: 1.4rem; margin: .5rem 0 }
.soft { color: var(--soft) }
.scroll { overflow-x: auto }
table { border-collapse: collapse }
.sums { width: 100%; margin: 1rem 0 }
.sums th, .sums td { border-bottom: 1px solid var(--rule); padding: .3rem .6rem;
  text-align: right; white-space: nowrap }
.sums th:first-child, .sums td:first-child { text-align: left; white-space: normal;
  overflow-wrap: anywhere }
.sums th { color: var(--soft); font-weight: 600 }
a { color: inherit }
meter { width: 6rem; height: .8rem; vertical-align: middle }
details { border: 1px solid var(--rule); border-radius: 6px; margin: .6rem 0 }
summary { background: var(--box); border-radius: 6px; cursor: pointer; padding: .4rem .8rem }
.code { font: 13px/1.45 ui-monospace, monospace; width: 100% }
.code td { padding: 0 .6rem; vertical-align: top; white-space: pre; tab-size: 2 }
.code td:nth-child(-n+2) { color: var(--soft); text-align: right; user-select: none; width: 1% }
.code .hit td:nth-child(2) { background: var(--hit) }
.code .part { background: var(--part) }
.code .miss { background: var(--miss) }
.chip { border: 1px solid var(--bad); border-radius: 4px; color: var(--bad); font-size: 11px;
  margin-left: .8rem; padding: 0 .3rem; user-select: none }
)";

std::string share_cell(const Reached& reached) {
  if (reached.all == 0) return "<td class=\"soft\">&#8211;</td>";
  return "<td>" + std::to_string(reached.hit) + " / " + std::to_string(reached.all) + "</td>";
}

template <class Kinds>
std::string sums_row(const std::string& name, const Kinds& kinds, const Reached& total) {
  std::string out = "<tr><td>" + name + "</td>";
  for (const SiteKind kind : {SiteKind::kStatement, SiteKind::kBranch, SiteKind::kRung,
                              SiteKind::kStep, SiteKind::kTransition}) {
    out += share_cell(kinds[static_cast<size_t>(kind)]);
  }
  const std::string percent = percent_text(total);
  return out + "<td>" + percent + " % <meter min=\"0\" max=\"100\" low=\"50\" high=\"80\" "
         "optimum=\"100\" value=\"" + percent + "\">" + percent + " %</meter></td></tr>\n";
}

// What is missing in a line, in words, by line.
using Missing = std::multimap<uint32_t, std::string>;
Missing missing_of(const CoveredFile& file) {
  Missing missing;
  for (const Decision& decision : file.decisions) {
    if (!decision.is_evaluated()) continue;  // so is its line
    for (const Counted& side : decision.sides) {
      if (side.hits == 0) missing.emplace(side.line, "never " + side.name);
    }
  }
  for (const Counted& element : file.elements) {
    if (element.hits == 0) missing.emplace(element.line, "never " + element.name);
  }
  return missing;
}

std::string covered_row(const CoveredFile& file, const Missing& missing, uint32_t line,
                       std::string_view text) {
  const auto found = file.lines.find(line);
  const auto [first, last] = missing.equal_range(line);
  std::string kind;
  std::string hits;
  if (found != file.lines.end()) {
    kind = found->second == 0 ? "miss" : first == last ? "hit" : "part";
    hits = std::to_string(found->second);
  }
  std::string chips;
  for (auto each = first; each != last; ++each) {
    chips += "<span class=\"chip\">" + markup_text(each->second) + "</span>";
  }
  return "<tr class=\"" + kind + "\"><td>" + std::to_string(line) + "</td><td>" + hits +
         "</td><td>" + markup_text(text) + chips + "</td></tr>\n";
}

std::string covered_text(const CoveredFile& file) {
  const Missing missing = missing_of(file);
  std::string out = "<div class=\"scroll\"><table class=\"code\">\n";
  std::string_view rest = file.text;
  for (uint32_t line = 1; !rest.empty(); ++line) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view text = rest.substr(0, end);
    if (text.ends_with('\r')) text.remove_suffix(1);
    out += covered_row(file, missing, line, text);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out + "</table></div>\n";
}

}  // namespace

std::string coverage_page(const CoverageReport& report, const std::string& project) {
  const std::string title = "Coverage of " + markup_text(project);
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                    "<title>" + title + "</title>\n<style>" + kPageStyle +
                    "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n<p class=\"soft\">" +
                    percent_text(report.total) + " % of " + std::to_string(report.total.all) +
                    " places reached, " + std::to_string(report.total.missing()) +
                    " missing. Files with the most missing come first.</p>\n"
                    "<div class=\"scroll\"><table class=\"sums\">\n<tr><th>file</th>"
                    "<th>statements</th><th>branches</th><th>rungs</th><th>steps</th>"
                    "<th>transitions</th><th>reached</th></tr>\n";
  const std::vector<const CoveredFile*> files = by_missing(report);
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string link = "<a href=\"#f" + std::to_string(i) + "\">" +
                             markup_text(files[i]->name) + "</a>";
    out += sums_row(link, files[i]->kinds, files[i]->total);
  }
  if (files.size() > 1) out += sums_row("<b>all files</b>", report.kinds, report.total);
  out += "</table></div>\n";
  for (size_t i = 0; i < files.size(); ++i) {
    const CoveredFile& file = *files[i];
    out += "<details id=\"f" + std::to_string(i) + "\"" + (file.total.missing() ? " open" : "") +
           "><summary>" + markup_text(file.name) + " <span class=\"soft\">" +
           percent_text(file.total) + " %, " + std::to_string(file.total.missing()) +
           " missing</span></summary>\n" + covered_text(file) + "</details>\n";
  }
  return out + "</body>\n</html>\n";
}

}  // namespace stc
