// What the comparison of scan times found, as a table for the terminal, as JSON, as a chart,
// and as a section of docs/performance.md.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bench/compare.h"

namespace bench {

// Rows as they come; at most 80 columns with two tiers.
void print_head(const std::vector<size_t>& tiers, uint32_t repeats, int core);
void print_row(const std::vector<size_t>& tiers, const Result& result);
void print_means(const std::vector<size_t>& tiers, const std::vector<Result>& results);

// Why a program is slower than the goal, by "TIER PROGRAM": written by hand, see lost.txt.
using Reasons = std::map<std::string, std::string>;
Reasons read_reasons(const std::string& path);

std::string scan_json(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                      uint32_t repeats);
std::string scan_chart(const std::vector<size_t>& tiers, const std::vector<Result>& results);
std::string scan_page(const std::vector<size_t>& tiers, const std::vector<Result>& results,
                      uint32_t repeats, const Reasons& reasons);

}  // namespace bench
