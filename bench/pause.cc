// The pause of an online change against the number of changed values, in programs of 1,000 to
// 1,000,000 variables: in place, by standby, and by the plain method (A18).
//
//   bench_pause --out FILE [--machine TEXT] [--largest N] [--repeats N]
//
// writes FILE.md and FILE.svg. Times are the median of the repeats, on one pinned core. Where
// valgrind is installed, the instructions of the switch are counted too: it runs this program as
// `bench_pause --count CASE WAY`. A time never fails the run; a wrong value does.
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_TOGGLE_COLLECT
#endif

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

#include "base/wrapped.h"
#include "bench/measure.h"
#include "bench/pause_case.h"
#include "bench/plain_method.h"
#include "bench/plot.h"

namespace bench {
namespace {

enum Way { kInPlace, kStandby, kPlain, kWays };
constexpr const char* kWayNames[] = {"in place", "standby", "plain"};
constexpr const char* kColours[] = {"#1b7f3b", "#1f5fbf", "#c0392b"};

struct Options {
  std::string out;
  std::string machine = "not stated";
  uint32_t largest = 1'000'000;
  uint32_t repeats = 3;
};

struct Row {
  Shape shape;
  std::string what;  // for those that are not N and k
  double us[kWays] = {};
  double instructions[kWays] = {};  // negative: not counted
  int64_t predicted_ns[2] = {};
  uint64_t steps = 0;
  uint64_t bytes = 0;
};

online_change::Strategy strategy_of(Way way) {
  return way == kStandby ? online_change::Strategy::kStandby : online_change::Strategy::kInPlace;
}

// There and back, so that it can be repeated.
double plain_us(const PauseCase& one) {
  PauseRig rig(one);
  PlainMethod method(rig.controller(), *ir::verify(online_change::decode(one.package)->image));
  return static_cast<double>(method.make_switch()) / 1000;
}

void measure(const PauseCase& one, const Options& options, Row& row) {
  std::vector<double> us[kWays];
  PauseRig rig(one);
  for (uint32_t i = 0; i < options.repeats; ++i) {
    for (const Way way : {kInPlace, kStandby}) {
      rig.prepare(strategy_of(way));
      row.predicted_ns[way] = rig.predicted_ns();
      us[way].push_back(static_cast<double>(rig.make_switch()) / 1000);
      rig.undo();
    }
    // It takes long beside what is measured.
    if (i == 0 || row.shape.variables <= 100'000) us[kPlain].push_back(plain_us(one));
  }
  for (int way = 0; way < kWays; ++way) row.us[way] = median(us[way]);
  row.steps = one.steps;
  row.bytes = one.boundary_bytes;
}

// --- instructions ---------------------------------------------------------------

void write_case(const std::string& file, const PauseCase& one) {
  std::ofstream out(file, std::ios::binary);
  const uint64_t size = one.image.size();
  out.write(reinterpret_cast<const char*>(&size), sizeof size);
  out.write(reinterpret_cast<const char*>(one.image.data()), static_cast<std::streamsize>(size));
  out.write(reinterpret_cast<const char*>(one.package.data()),
            static_cast<std::streamsize>(one.package.size()));
}

PauseCase read_case(const char* file) {
  std::ifstream in(file, std::ios::binary);
  const std::string all((std::istreambuf_iterator<char>(in)), {});
  uint64_t size = 0;
  std::memcpy(&size, all.data(), sizeof size);
  PauseCase one;
  const auto image = all.begin() + sizeof size;
  one.image.assign(image, image + static_cast<std::ptrdiff_t>(size));
  one.package.assign(image + static_cast<std::ptrdiff_t>(size), all.end());
  return one;
}

template <class Call>
void counted(Call call) {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_TOGGLE_COLLECT;
  call();
  CALLGRIND_TOGGLE_COLLECT;
  CALLGRIND_STOP_INSTRUMENTATION;
}

int count_one(const char* file, Way way) {
  const PauseCase one = read_case(file);
  PauseRig rig(one);
  if (way == kPlain) {
    PlainMethod method(rig.controller(), *ir::verify(online_change::decode(one.package)->image));
    counted([&] { method.make_switch(); });
  } else {
    rig.prepare(strategy_of(way));
    counted([&] { rig.make_switch(); });
  }
  return 0;
}

double instructions_of(const std::string& self, const std::string& file, Way way) {
  const std::string text = output_of(
      {"/usr/bin/env", "valgrind", "--tool=callgrind", "--instr-atstart=no", "--collect-atstart=no",
       "--log-fd=1", "--callgrind-out-file=/dev/null", self, "--count", file, std::to_string(way)});
  const size_t at = text.find("Collected : ");
  return at == std::string::npos ? -1 : std::atof(text.c_str() + at + 12);
}

// --- report ---------------------------------------------------------------------

std::string cell(double value, const char* format = "%.1f") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return value < 0 ? "-" : text;
}

// Measured against predicted, whichever is more.
std::string ratio(const Row& row, int way) {
  const double predicted = static_cast<double>(row.predicted_ns[way]) / 1000;
  return cell(std::max(row.us[way] / predicted, predicted / row.us[way]), "%.2f");
}

std::string name_of(const Row& row) {
  if (!row.what.empty()) return row.what;
  return std::to_string(row.shape.variables) + " | " + std::to_string(row.shape.changed);
}

std::string row_text(const Row& row) {
  std::string text = "| " + name_of(row) + " | ";
  for (int way = 0; way < kWays; ++way) text += cell(row.us[way]) + " | ";
  for (int way = 0; way < kWays; ++way) text += cell(row.instructions[way], "%.0f") + " | ";
  for (int way = 0; way < 2; ++way) {
    text +=
        cell(static_cast<double>(row.predicted_ns[way]) / 1000) + " | " + ratio(row, way) + " | ";
  }
  return text + std::to_string(row.steps) + " | " + std::to_string(row.bytes) + " |\n";
}

constexpr const char* kColumns =
    " in place us | standby us | plain us | in place instr. | standby instr. | plain instr. | "
    "predicted us, in place | ratio | predicted us, standby | ratio | steps | bytes |\n";
constexpr const char* kLine = "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";

std::string paragraph(const std::string& text) {
  std::string lines;
  for (const std::string& line : base::wrapped(text, 99)) lines += line + "\n";
  return lines + "\n";
}

std::string report(const Options& options, const std::vector<Row>& rows,
                   const std::vector<Row>& others, const Row& instances) {
  std::string text = "# The pause of an online change\n\n";
  text += paragraph("Written by `make bench-pause`. Measured on: " + options.machine +
                    ". Median of " + std::to_string(options.repeats) +
                    " switches, one pinned core, caches as the staging of the change left them.");
  text += paragraph(
      "The program has N variables of type INT, each with a name; k of them, evenly spread, become "
      "DINT. The pause is the time from the boundary until version 2 runs. *In place* and "
      "*standby* are the two strategies of `stvm change`; *plain* saves all values, switches and "
      "restores all of them by tables made beforehand, and exists in this measurement only (A18). "
      "Instructions of the switch are counted by callgrind. Times are those of the wall clock: on "
      "a shared machine, rows of many milliseconds hold time of other programs.");
  text += "![pause](pause.svg)\n\n| N | k |" + std::string(kColumns) + "|---" + kLine;
  for (const Row& row : rows) text += row_text(row);
  text += "\nOther changes:\n\n| what |" + std::string(kColumns) + kLine;
  for (const Row& row : others) text += row_text(row);
  text += "\n" + paragraph(
                     "`predicted` is what a change is refused by when it, and half as much again, "
                     "does not fit "
                     "the free time of the tightest task: the model of online_change/plan/pause.h "
                     "at the pace of "
                     "this machine, which is measured when a change is staged first. `ratio` is "
                     "what was measured "
                     "against it, or it against what was measured, whichever is more. By standby "
                     "it is of what "
                     "the last pass found. Below 20 us the first touch of cold caches counts most, "
                     "and no ratio "
                     "is promised: there the two are less than 12 us apart.");
  std::string end = paragraph(
      std::to_string(instances.shape.instances) +
      " instances of a function block gain a variable inside their slack: " +
      cell(instances.us[kInPlace]) + " us in place, " + cell(instances.us[kStandby]) +
      " us by standby, " + cell(instances.us[kPlain]) +
      " us by the plain method. In place their initial values are written before the boundary "
      "(A19).");
  end.pop_back();
  return text + end;
}

std::vector<Curve> curves_of(const std::vector<Row>& rows) {
  std::map<std::pair<int, uint32_t>, Curve> curves;
  uint32_t least = UINT32_MAX, most = 0;
  for (const Row& row : rows) {
    least = std::min(least, row.shape.variables), most = std::max(most, row.shape.variables);
  }
  for (const Row& row : rows) {
    if (row.shape.variables != least && row.shape.variables != most) continue;
    for (int way = 0; way < kWays; ++way) {
      Curve& curve = curves[{way, row.shape.variables}];
      curve.name = std::string(kWayNames[way]) + ", N = " + std::to_string(row.shape.variables);
      curve.colour = kColours[way];
      curve.dashed = row.shape.variables == least;
      curve.points.push_back({row.shape.changed, std::max(row.us[way], 0.01)});
    }
  }
  std::vector<Curve> out;
  for (auto& [key, curve] : curves) out.push_back(std::move(curve));
  return out;
}

Row measure_shape(const Shape& shape, const Options& options, const std::string& self,
                  const std::string& what = {}) {
  Row row;
  row.shape = shape;
  row.what = what;
  const PauseCase one = make_case(shape);
  measure(one, options, row);
  const std::string file = options.out + ".case";
  write_case(file, one);
  for (int way = 0; way < kWays; ++way) {
    row.instructions[way] = instructions_of(self, file, static_cast<Way>(way));
  }
  std::remove(file.c_str());
  std::fputs(row_text(row).c_str(), stdout);
  std::fflush(stdout);
  return row;
}

const std::pair<const char*, Shape> kOthers[] = {
    {"10,000 blocks, a member INT -> DINT", {.variables = 1000, .retyped = 10'000}},
    {"an array of 100,000 INT -> REAL", {.variables = 1000, .elements = 100'000}},
    {"10,000 STRING[20] -> STRING[30]", {.variables = 1000, .strings = 10'000}},
    {"10,000 enumerations, literals reordered", {.variables = 1000, .modes = 10'000}},
    {"an INT -> DINT beside 2 MB that every scan rewrites",
     {.variables = 1000, .changed = 1, .rewritten = 512}},
    {"10,000 references, what they lead to moves", {.variables = 1000, .references = 10'000}},
};

int run(const Options& options, const std::string& self) {
  pin_to_one_core();
  std::vector<Row> rows;
  for (uint32_t variables = 1000; variables <= options.largest; variables *= 10) {
    for (uint32_t changed = 1; changed < variables; changed *= 100) {
      rows.push_back(measure_shape({variables, changed, 0}, options, self));
    }
    rows.push_back(measure_shape({variables, variables, 0}, options, self));
  }
  const Row instances = measure_shape({1000, 0, 10'000}, options, self);
  std::vector<Row> others;
  for (const auto& [what, shape] : kOthers) {
    others.push_back(measure_shape(shape, options, self, what));
  }
  std::ofstream(options.out + ".md") << report(options, rows, others, instances);
  std::ofstream(options.out + ".svg")
      << plot_svg("Pause of a change of k out of N variables", "k, changed values",
                  "pause in microseconds", curves_of(rows));
  return 0;
}

int main_of(int count, char** words) {
  if (count == 4 && std::string(words[1]) == "--count") {
    return count_one(words[2], static_cast<Way>(std::atoi(words[3])));
  }
  Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = words[i];
    if (name == "--out") options.out = words[i + 1];
    if (name == "--machine") options.machine = words[i + 1];
    if (name == "--largest") options.largest = static_cast<uint32_t>(std::atoi(words[i + 1]));
    if (name == "--repeats") options.repeats = static_cast<uint32_t>(std::atoi(words[i + 1]));
  }
  if (options.out.empty() || options.repeats == 0) {
    std::fputs("usage: bench_pause --out FILE [--machine TEXT] [--largest N] [--repeats N]\n",
               stderr);
    return 2;
  }
  return run(options, words[0]);
}

}  // namespace
}  // namespace bench

int main(int count, char** words) { return bench::main_of(count, words); }
