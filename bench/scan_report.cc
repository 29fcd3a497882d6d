#include "bench/scan_report.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "bench/bars.h"

namespace bench {
namespace {

std::string number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Below ten nanoseconds a decimal says something.
std::string ns_text(double ns) { return number(ns, ns < 10 ? "%.1f" : "%.0f"); }

std::vector<std::string> groups_of(const std::vector<Result>& results) {
  std::vector<std::string> groups;
  for (const Result& result : results) {
    if (groups.empty() || groups.back() != result.program->group) {
      groups.push_back(result.program->group);
    }
  }
  return groups;
}

std::string mean_row(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                     const std::string& group) {
  std::string row = "| geometric mean" + (group.empty() ? "" : ", " + group) + " | ";
  for (size_t tier : tiers) {
    row += "| | **" + number(geometric_mean(results, tier, group), "%.2f") + "** ";
  }
  return row + "| |\n";
}

// What is aimed at on one program.
double limit(const Tier& tier, const Program& program) {
  return tier.against_peers && program.peers != 0 ? std::min(tier.goal, program.peers) : tier.goal;
}

std::string peer_of(const Tier& tier, const Result& result) {
  const double peers = result.program->peers;
  const bool behind =
      tier.against_peers && peers != 0 && result.tiers[&tier - kTiers].ratio > peers;
  return behind ? " (peer " + number(peers, "%.2f") + ")" : "";
}

std::string reasons_of(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                       const Reasons& reasons) {
  std::string page;
  for (size_t tier : tiers) {
    const std::string name = kTiers[tier].name;
    page += "\n### " + name + ", above " + number(kTiers[tier].goal, "%g") +
            (kTiers[tier].against_peers ? " or above a peer" : "") + "\n\n";
    std::string rows;
    for (const Result& result : results) {
      if (!result.tiers[tier].ran ||
          result.tiers[tier].ratio <= limit(kTiers[tier], *result.program)) {
        continue;
      }
      const auto reason = reasons.find(name + " " + result.program->name);
      rows += "- `" + std::string(result.program->name) + "` " +
              number(result.tiers[tier].ratio, "%.1f") + peer_of(kTiers[tier], result) + ": " +
              (reason == reasons.end() ? "not looked into yet" : reason->second) + "\n";
    }
    page += rows.empty() ? "No program.\n" : rows;
  }
  return page;
}

}  // namespace

void print_head(const std::vector<size_t>& tiers, uint32_t repeats, int core) {
  std::printf("ns per scan, median of %u alternating repeats, core %d\n\n%-19s %9s", repeats, core,
              "program", "C");
  for (size_t tier : tiers) std::printf(" %9s %7s", kTiers[tier].name, "ratio");
  std::printf("  state\n");
}

void print_row(const std::vector<size_t>& tiers, const Result& result) {
  std::printf("%-19s %9s", result.program->name, ns_text(result.c_ns).c_str());
  for (size_t tier : tiers) {
    const TierResult& found = result.tiers[tier];
    std::printf(" %9s %7s", found.ran ? ns_text(found.ns).c_str() : "-",
                found.ran ? number(found.ratio, "%.2f").c_str() : "-");
  }
  std::printf("  %s\n", result.same_state ? "same" : "DIFFERS");
  std::fflush(stdout);
}

void print_means(const std::vector<size_t>& tiers, const std::vector<Result>& results) {
  std::printf("\ngeometric means\n");
  std::vector<std::string> groups = groups_of(results);
  if (groups.size() > 1) groups.push_back("");
  for (const std::string& group : groups) {
    std::printf("%-19s %9s", group.empty() ? "all" : group.c_str(), "");
    for (size_t tier : tiers) {
      std::printf(" %9s %7.2f", "", geometric_mean(results, tier, group));
    }
    std::printf("\n");
  }
  std::printf("%-19s %9s", "goal", "");
  for (size_t tier : tiers) std::printf(" %9s %7.2f", "", kTiers[tier].goal);
  std::printf("\n");
}

Reasons read_reasons(const std::string& path) {
  Reasons reasons;
  std::ifstream in(path);
  std::string* current = nullptr;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == ' ' && current != nullptr) {
      *current += line.substr(line.find_first_not_of(' ') - 1);
      continue;
    }
    const size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    current = &(reasons[line.substr(0, colon)] = line.substr(colon + 2));
  }
  return reasons;
}

std::string scan_json(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                      uint32_t repeats) {
  std::string json = "{\"repeats\": " + std::to_string(repeats) + ", \"programs\": [";
  const char* comma = "";
  for (const Result& result : results) {
    json += std::string(comma) + "\n  {\"name\": \"" + result.program->name + "\", \"group\": \"" +
            result.program->group +
            "\", \"same_state\": " + (result.same_state ? "true" : "false") +
            ", \"c_ns\": " + number(result.c_ns, "%.2f");
    for (size_t tier : tiers) {
      const TierResult& found = result.tiers[tier];
      const std::string key = std::string(", \"") + kTiers[tier].name;
      if (!found.ran) continue;
      json += key + "_ns\": " + number(found.ns, "%.2f") + key +
              "_ratio\": " + number(found.ratio, "%.3f");
    }
    json += "}";
    comma = ",";
  }
  json += "\n], \"geometric_means\": {";
  comma = "";
  for (size_t tier : tiers) {
    json += std::string(comma) + "\"" + kTiers[tier].name +
            "\": {\"goal\": " + number(kTiers[tier].goal, "%g") +
            ", \"all\": " + number(geometric_mean(results, tier, ""), "%.3f");
    for (const std::string& group : groups_of(results)) {
      json += ", \"" + group + "\": " + number(geometric_mean(results, tier, group), "%.3f");
    }
    json += "}";
    comma = ", ";
  }
  return json + "}}\n";
}

std::string scan_chart(const std::vector<size_t>& tiers, const std::vector<Result>& results) {
  Bars bars;
  bars.title = "Time of a scan, as a multiple of C compiled with gcc -O2 (shorter is faster)";
  for (size_t tier : tiers) bars.series.push_back({kTiers[tier].name, kTiers[tier].goal});
  const auto add = [&](const std::string& name, const auto& value_of) {
    Bars::Row row{name, {}};
    for (size_t tier : tiers) row.values.push_back(value_of(tier));
    bars.rows.push_back(row);
  };
  std::string group;
  for (const Result& result : results) {
    if (!group.empty() && group != result.program->group) bars.rows.push_back({});
    group = result.program->group;
    add(result.program->name, [&](size_t tier) { return result.tiers[tier].ratio; });
  }
  bars.rows.push_back({});
  for (const std::string& name : groups_of(results)) {
    add("mean of " + name, [&](size_t tier) { return geometric_mean(results, tier, name); });
  }
  return bars_svg(bars);
}

std::string scan_page(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                      uint32_t repeats, const Reasons& reasons) {
  std::string page =
      "## Scan time\n\nNanoseconds of one scan, median of " + std::to_string(repeats) +
      " repeats, the sides in turn on one pinned core. `ratio`: to C. What the "
      "programs do: bench/README.md. `peers`: the ratio of the better one of two other "
      "compilers to C, of other sources (bench/programs.def).\n\n![Ratios per "
      "program](performance.svg)\n\n"
      "| program | C |";
  std::string rule = "| --- | ---: |";
  for (size_t tier : tiers) {
    page += std::string(" ") + kTiers[tier].name + " | ratio |";
    rule += " ---: | ---: |";
  }
  page += " peers |\n" + rule + " ---: |\n";
  for (const Result& result : results) {
    page += "| `" + std::string(result.program->name) + "` | " + ns_text(result.c_ns) + " |";
    for (size_t tier : tiers) {
      const TierResult& found = result.tiers[tier];
      page += found.ran ? " " + ns_text(found.ns) + " | " + number(found.ratio, "%.2f") + " |"
                        : std::string(" - | - |");
    }
    const double peers = result.program->peers;
    page += (peers == 0 ? "" : " " + number(peers, "%.2f")) + " |\n";
  }
  for (const std::string& group : groups_of(results)) page += mean_row(tiers, results, group);
  page += mean_row(tiers, results, "");
  page += "\nGoals for the geometric mean:";
  const char* comma = " ";
  for (const Tier& tier : kTiers) {
    page += comma + std::string(tier.name) + " " + number(tier.goal, "%g");
    comma = ", ";
  }
  page +=
      "; native on every program at least as fast as `peers`.\n\n## What was lost where\n\n"
      "Every program above the goal, and where its time goes.\n";
  return page + reasons_of(tiers, results, reasons);
}

}  // namespace bench
