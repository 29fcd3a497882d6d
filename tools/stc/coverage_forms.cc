// Coverage for other programs: lcov and Cobertura.
#include <cstdio>

#include "tools/stc/coverage_report.h"
#include "tools/stc/markup.h"

namespace stc {
namespace {

std::string decimal(uint64_t value) { return std::to_string(value); }

// "0.5000": of nothing, 1.
std::string rate(const Reached& reached) {
  char text[16];
  const double value = reached.all == 0 ? 1.0 : static_cast<double>(reached.hit) / reached.all;
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

std::string folder_of(const std::string& name) {
  const size_t slash = name.rfind('/');
  return slash == std::string::npos ? "." : name.substr(0, slash);
}

// Both rates, and the counts that they are of where these belong.
std::string rates(const CoveredFile& file) {
  return " line-rate=\"" + rate(file.covered_lines) + "\" branch-rate=\"" + rate(file.sides) +
         "\" complexity=\"0\"";
}

// The decisions of a line are one there: their sides together.
std::string cobertura_line(const CoveredFile& file, size_t& next, uint32_t line, uint64_t hits) {
  Reached sides;
  std::string conditions;
  for (uint32_t number_of = 0; next < file.decisions.size() && file.decisions[next].line == line;
       ++next, ++number_of) {
    const Decision& decision = file.decisions[next];
    const Reached own{decision.sides_hit(), static_cast<uint32_t>(decision.sides.size())};
    sides.add(own);
    conditions += "              <condition number=\"" + decimal(number_of) +
                  "\" type=\"jump\" coverage=\"" + decimal(100 * own.hit / own.all) + "%\"/>\n";
  }
  std::string out = "            <line number=\"" + decimal(line) + "\" hits=\"" + decimal(hits) +
                    "\" branch=\"" + (sides.all == 0 ? "false" : "true") + "\"";
  if (sides.all == 0) return out + "/>\n";
  return out + " condition-coverage=\"" + decimal(100 * sides.hit / sides.all) + "% (" +
         decimal(sides.hit) + "/" + decimal(sides.all) + ")\">\n            <conditions>\n" +
         conditions + "            </conditions>\n            </line>\n";
}

}  // namespace

std::string lcov_text(const CoverageReport& report) {
  std::string out;
  for (const CoveredFile& file : report.files) {
    out += "TN:\nSF:" + file.name + "\n";
    uint32_t called = 0;
    for (const Counted& pou : file.pous) out += "FN:" + decimal(pou.line) + "," + pou.name + "\n";
    for (const Counted& pou : file.pous) {
      out += "FNDA:" + decimal(pou.hits) + "," + pou.name + "\n";
      called += pou.hits != 0;
    }
    out += "FNF:" + decimal(file.pous.size()) + "\nFNH:" + decimal(called) + "\n";
    for (uint32_t i = 0; i < file.decisions.size(); ++i) {
      const Decision& decision = file.decisions[i];
      for (uint32_t side = 0; side < decision.sides.size(); ++side) {
        out += "BRDA:" + decimal(decision.line) + "," + decimal(i) + "," + decimal(side) + ",";
        out += decision.is_evaluated() ? decimal(decision.sides[side].hits) : "-";
        out += "\n";
      }
    }
    out += "BRF:" + decimal(file.sides.all) + "\nBRH:" + decimal(file.sides.hit) + "\n";
    for (const auto& [line, hits] : file.lines) {
      out += "DA:" + decimal(line) + "," + decimal(hits) + "\n";
    }
    out += "LF:" + decimal(file.covered_lines.all) + "\nLH:" + decimal(file.covered_lines.hit) +
           "\nend_of_record\n";
  }
  return out;
}

std::string cobertura_text(const CoverageReport& report) {
  const Reached& sides = report.kinds[static_cast<size_t>(frontend::SiteKind::kBranch)];
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE coverage SYSTEM "
      "\"http://cobertura.sourceforge.net/xml/coverage-04.dtd\">\n<coverage line-rate=\"" +
      rate(report.covered_lines) + "\" branch-rate=\"" + rate(sides) + "\" lines-covered=\"" +
      decimal(report.covered_lines.hit) + "\" lines-valid=\"" + decimal(report.covered_lines.all) +
      "\" branches-covered=\"" + decimal(sides.hit) + "\" branches-valid=\"" + decimal(sides.all) +
      "\" complexity=\"0\" version=\"1\" timestamp=\"0\">\n"
      "  <sources>\n    <source>.</source>\n  </sources>\n  <packages>\n";
  for (const CoveredFile& file : report.files) {
    const std::string name = markup_text(file.name);
    out += "    <package name=\"" + markup_text(folder_of(file.name)) + "\"" + rates(file) +
           ">\n      <classes>\n        <class name=\"" + name + "\" filename=\"" + name + "\"" +
           rates(file) + ">\n          <methods/>\n          <lines>\n";
    size_t next = 0;
    for (const auto& [line, hits] : file.lines) out += cobertura_line(file, next, line, hits);
    out += "          </lines>\n        </class>\n      </classes>\n    </package>\n";
  }
  return out + "  </packages>\n</coverage>\n";
}

}  // namespace stc
