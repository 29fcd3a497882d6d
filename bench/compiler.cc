// The speed of the compiler's phases, and the memory of the whole, on one project.
//
//   bench_compiler --stc PATH --sources FOLDER --out FOLDER --section NAME --title TEXT [--repeats
//   N]
//
// Writes NAME.json and NAME.md, a section of docs/performance.md. Phases are measured in this
// process, each as the fastest of the repeats, as
// other work on the machine only ever adds; the whole build and its memory are a process of
// `stc`.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

#include "base/diagnostics.h"
#include "bench/measure.h"
#include "bench/project_sources.h"
#include "frontend/compile.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/tree.h"
#include "ir/bytecode/verify.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "linker/link.h"
#include "tools/common/heap.h"

namespace {

using Options = std::map<std::string, std::string>;

struct Phase {
  const char* name;
  double goal;  // lines per second; 0: none
  std::vector<double> seconds = {};
};

// In the order of a build. What they are called is also the order of `measure`.
enum PhaseId { kLex, kParse, kCheck, kOptimise, kLower, kLink, kEncode, kVerify, kPhases };

struct Measured {
  Phase phases[kPhases] = {{"lexing", 0},
                           {"lexing and parsing", 10e6},
                           {"checking and IR", 1.5e6},
                           {"optimising", 0},
                           {"bytecode", 0},
                           {"linking", 0},
                           {"encoding", 0},
                           {"verifying", 0}};
  uint64_t lines = 0;
  size_t source_bytes = 0;
  size_t pous = 0;
  size_t instructions = 0;
  size_t image_bytes = 0;
  double build_ms = 0;
  uint64_t peak_kib = 0;
};

// Seconds of processor time that `work` took, added to the phase; what it returns.
template <class Work>
auto timed(Phase& phase, const Work& work) {
  const double begin = bench::cpu_seconds();
  auto result = work();
  phase.seconds.push_back(bench::cpu_seconds() - begin);
  return result;
}

template <class T>
T taken(base::Result<T> result) {
  base::check(result.ok(), result.ok() ? "" : base::to_string(result.error()).c_str());
  return std::move(*result);
}

size_t lex_all(const base::SourceMap& sources) {
  base::Diagnostics diagnostics;
  size_t tokens = 0;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    tokens += frontend::lex(sources, file, diagnostics).tokens.size();
  }
  return tokens;
}

void measure_once(const base::SourceMap& sources, Measured& made) {
  timed(made.phases[kLex], [&] { return lex_all(sources); });
  timed(made.phases[kParse], [&] {
    base::Diagnostics diagnostics;
    frontend::Tree tree;
    frontend::parse_all(sources, {}, tree, diagnostics);
    return diagnostics.error_count();
  });
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program =
      timed(made.phases[kCheck], [&] { return frontend::compile(sources, {}, diagnostics); });
  base::check(program.has_value(), "the project compiles");
  timed(made.phases[kOptimise], [&] {
    const base::Status status = ir::optimise(*program, ir::PassSet::all(), false);
    base::check(status.ok(), "optimised");
    return status.ok();
  });
  const std::vector<ir::Object> objects = timed(made.phases[kLower], [&] {
    std::vector<ir::Object> out;
    for (uint32_t i = 0; i < program->pous.size(); ++i) {
      out.push_back(taken(ir::lower(*program, ir::PouId(i))));
    }
    return out;
  });
  const ir::Image image =
      timed(made.phases[kLink], [&] { return taken(linker::link(*program, objects, {})); });
  const base::Bytes bytes = timed(made.phases[kEncode], [&] { return ir::encode(image); });
  timed(made.phases[kVerify], [&] { return taken(ir::verify(bytes)); });
  made.pous = image.pous.size();
  made.instructions = image.code.size();
  made.image_bytes = bytes.size();
}

// Before this process grows: see Child::peak_kib.
void measure_build(Options& options, int repeats, Measured& made) {
  const std::string image = options["--out"] + "/" + options["--section"] + ".image";
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const bench::Child child =
        bench::run_child({options["--stc"], "build", options["--sources"], "-o", image}, true);
    base::check(child.ok, "stc builds the project");
    times.push_back(child.cpu_ms);
    made.peak_kib = std::max(made.peak_kib, child.peak_kib);
  }
  made.build_ms = bench::fastest(times);
}

std::string text_of(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double lines_per_second(const Measured& made, double seconds) {
  return seconds > 0 ? static_cast<double>(made.lines) / seconds : 0;
}

struct Row {
  std::string name;
  double ms;
  double lines_per_second;
  double goal;
};

std::vector<Row> rows_of(const Measured& made) {
  std::vector<Row> rows;
  for (const Phase& phase : made.phases) {
    double seconds = bench::fastest(phase.seconds);
    // compile() parses first. The least of differences would be too small.
    if (&phase == &made.phases[kCheck]) seconds -= bench::fastest(made.phases[kParse].seconds);
    rows.push_back({phase.name, seconds * 1e3, lines_per_second(made, seconds), phase.goal});
  }
  rows.push_back({"whole build, a process of stc", made.build_ms,
                  lines_per_second(made, made.build_ms / 1e3), 500e3});
  return rows;
}

std::string speed_text(double lines_per_second) {
  return lines_per_second >= 1e6 ? text_of("%.2f M", lines_per_second / 1e6)
                                 : text_of("%.0f k", lines_per_second / 1e3);
}

std::string page(const Measured& made, const std::string& title) {
  std::string out = "## " + title + "\n\n" + std::to_string(made.lines) + " lines (" +
                    text_of("%.1f", static_cast<double>(made.source_bytes) / (1 << 20)) +
                    " MiB), " + std::to_string(made.pous) + " POUs, " +
                    std::to_string(made.instructions) + " instructions, an image of " +
                    text_of("%.1f", static_cast<double>(made.image_bytes) / (1 << 20)) +
                    " MiB; written by bench/project.cc. Processor time on one core, the least of "
                    "several runs.\n\n"
                    "| phase | ms | lines/s | goal |\n| --- | ---: | ---: | ---: |\n";
  for (const Row& row : rows_of(made)) {
    out += "| " + row.name + " | " + text_of("%.1f", row.ms) + " | " +
           speed_text(row.lines_per_second) + " | " + (row.goal > 0 ? speed_text(row.goal) : "") +
           " |\n";
  }
  const double per_line =
      static_cast<double>(made.peak_kib) * 1024 / static_cast<double>(made.lines);
  return out + "\nMemory of the whole build: " +
         text_of("%.0f", static_cast<double>(made.peak_kib) / 1024) + " MiB at most, " +
         text_of("%.0f", per_line) + " bytes per line (goal: 1024).\n";
}

std::string json(const Measured& made) {
  std::string out = "{\"lines\": " + std::to_string(made.lines) +
                    ", \"pous\": " + std::to_string(made.pous) +
                    ", \"image_bytes\": " + std::to_string(made.image_bytes) +
                    ", \"peak_kib\": " + std::to_string(made.peak_kib) + ", \"phases\": [";
  const char* comma = "";
  for (const Row& row : rows_of(made)) {
    out += std::string(comma) + "\n  {\"name\": \"" + row.name +
           "\", \"ms\": " + text_of("%.2f", row.ms) +
           ", \"lines_per_second\": " + text_of("%.0f", row.lines_per_second) + "}";
    comma = ",";
  }
  return out + "\n]}\n";
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  for (const char* name : {"--stc", "--sources", "--out", "--section", "--title"}) {
    if (options[name].empty()) {
      std::fprintf(stderr, "bench_compiler: %s is missing\n", name);
      return 2;
    }
  }
  const int repeats = options["--repeats"].empty() ? 9 : std::atoi(options["--repeats"].c_str());
  bench::pin_to_one_core();
  tools::keep_freed_memory();  // as stc does
  Measured made;
  measure_build(options, repeats, made);
  const base::SourceMap sources = bench::read_sources(options["--sources"], made.lines);
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    made.source_bytes += sources.text(file).size();
  }
  for (int i = 0; i < repeats; ++i) measure_once(sources, made);
  // compile() has parsed again, which is the row above.
  const double parsing = bench::fastest(made.phases[kParse].seconds);
  for (double& seconds : made.phases[kCheck].seconds) seconds -= parsing;
  std::printf("\n%-30s %10s %12s\n", options["--title"].c_str(), "ms", "lines/s");
  for (const Row& row : rows_of(made)) {
    std::printf("%-30s %10.1f %12s\n", row.name.c_str(), row.ms,
                speed_text(row.lines_per_second).c_str());
  }
  std::printf("memory: %.0f MiB\n", static_cast<double>(made.peak_kib) / 1024);
  const std::string path = options["--out"] + "/" + options["--section"];
  std::ofstream(path + ".md") << page(made, options["--title"]);
  std::ofstream(path + ".json") << json(made);
  return 0;
}
