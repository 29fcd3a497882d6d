// Size and start of stvm: its program, its memory, the time to the first scan, and how long the
// images of a small and a large project take to verify and load.
//
//   bench_start --stvm PATH --strip PATH --out FOLDER IMAGE...
//
// Writes start.json and start.md, a section of docs/performance.md.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "base/result.h"
#include "bench/measure.h"
#include "ir/bytecode/verify.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace {

constexpr int kRepeats = 11;
constexpr double kMiB = 1 << 20;

struct Row {
  std::string name;
  double image_mib = 0;
  double verify_ms = 0;
  double load_ms = 0;
  double native_ms = 0;        // machine code of all POUs, in the background
  double first_scan_ms = 0;    // of a process: from its start to its end after one scan
  double first_native_ms = 0;  // the same with all machine code made before
  double interpreted_mib = 0;  // resident in a process without machine code, at most
  double resident_mib = 0;     // in one that makes all of it, at most
  double data_mib = 0;
};

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

struct Processes {
  double fastest_ms = 0;
  double peak_mib = 0;
};

Processes run_first_scan(const std::string& stvm, const std::string& image,
                         const std::vector<std::string>& options) {
  std::vector<std::string> command = {stvm, "run", image, "--scans", "1"};
  command.insert(command.end(), options.begin(), options.end());
  Processes out;
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const bench::Child child = bench::run_child(command, true);
    base::check(child.ok, "stvm runs the image");
    times.push_back(child.wall_ms);
    out.peak_mib = std::max(out.peak_mib, static_cast<double>(child.peak_kib) / 1024);
  }
  out.fastest_ms = bench::fastest(times);
  return out;
}

// Before this process grows: see Child::peak_kib.
void measure_process(const std::string& stvm, const std::string& image, Row& row) {
  row.first_scan_ms = run_first_scan(stvm, image, {}).fastest_ms;
  const Processes native = run_first_scan(stvm, image, {"--virtual-time", "--tier", "native"});
  row.first_native_ms = native.fastest_ms;
  row.resident_mib = native.peak_mib;
  row.interpreted_mib =
      run_first_scan(stvm, image, {"--virtual-time", "--tier", "interp"}).peak_mib;
}

double load_per_mib(const Row& row) { return (row.verify_ms + row.load_ms) / row.image_mib; }
double native_per_mib(const Row& row) {
  return (row.verify_ms + row.load_ms + row.native_ms) / row.image_mib;
}

void measure_load(const std::string& path, Row& row) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string content = text.str();
  const base::Bytes bytes(content.begin(), content.end());
  row.image_mib = static_cast<double>(bytes.size()) / kMiB;
  std::vector<double> verify_times;
  std::vector<double> load_times;
  std::vector<double> native_times;
  vm::ControllerOptions beside;
  beside.tier.making = vm::Making::kBeside;
  for (int i = 0; i < kRepeats; ++i) {
    auto begin = std::chrono::steady_clock::now();
    const base::Result<ir::VerifiedImage> image = ir::verify(bytes);
    verify_times.push_back(ms_since(begin));
    base::check(image.ok(), "the image is sound");
    vm::VirtualClock clock;
    vm::NullIo io;
    begin = std::chrono::steady_clock::now();
    const auto controller = vm::Controller::start(*image, beside, clock, io);
    load_times.push_back(ms_since(begin));
    base::check(controller.ok(), "the image can be loaded");
    while ((*controller)->pous_to_make() != 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    native_times.push_back(ms_since(begin) - load_times.back());
    row.data_mib = image->image().data_capacity / kMiB;
  }
  row.verify_ms = bench::fastest(verify_times);
  row.load_ms = bench::fastest(load_times);
  row.native_ms = bench::fastest(native_times);
}

// Bytes of the program without symbols; 0 when `strip` is missing.
uint64_t stripped_size(const std::string& strip, const std::string& program,
                       const std::string& folder) {
  const std::string copy = folder + "/stvm.stripped";
  if (strip.empty() || !bench::run_child({strip, "-o", copy, program}, true).ok) return 0;
  return std::filesystem::file_size(copy);
}

std::string text_of(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string page(const std::vector<Row>& rows, uint64_t size) {
  std::string out =
      "## Size and start\n\n`stvm` without symbols, with all adapters: " +
      (size == 0 ? std::string("not measured (strip is missing)")
                 : text_of("%.2f MiB", static_cast<double>(size) / kMiB)) +
      " (goal without adapters: 3). The fastest of several runs, on one core.\n\n"
      "Time. Verifying and loading: goal 50 ms per MiB of the image, and linear. `first scan`: a "
      "process of `stvm run` from its start to its end after one scan (goal: 10 ms); machine "
      "code is made after that by a thread in the background, while the program is interpreted. "
      "`with it`: verifying, loading and all machine code, per MiB; `first native scan`: of "
      "`stvm run --tier native`, which makes all of it before its first scan.\n\n"
      "| image | MiB | verify ms | load ms | ms per MiB | first scan ms | machine code ms | "
      "with it, ms per MiB | first native scan ms |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Row& row : rows) {
    out += "| `" + row.name + "` | " + text_of("%.3f", row.image_mib) + " | " +
           text_of("%.2f", row.verify_ms) + " | " + text_of("%.2f", row.load_ms) + " | " +
           text_of("%.1f", load_per_mib(row)) + " | " + text_of("%.1f", row.first_scan_ms) + " | " +
           text_of("%.1f", row.native_ms) + " | " + text_of("%.1f", native_per_mib(row)) + " | " +
           text_of("%.1f", row.first_native_ms) + " |\n";
  }
  out +=
      "\nResident memory at most, until after the first scan, in MiB. `without data`: without "
      "what the data memory has (goal 8); the image itself, which a controller keeps to give it "
      "away and to compare, is a part of it.\n\n"
      "| image | data | image | interpreted | without data | with machine code | without data |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Row& row : rows) {
    out += "| `" + row.name + "` | " + text_of("%.2f", row.data_mib) + " | " +
           text_of("%.2f", row.image_mib) + " | " + text_of("%.1f", row.interpreted_mib) + " | " +
           text_of("%.1f", row.interpreted_mib - row.data_mib) + " | " +
           text_of("%.1f", row.resident_mib) + " | " +
           text_of("%.1f", row.resident_mib - row.data_mib) + " |\n";
  }
  return out;
}

std::string json(const std::vector<Row>& rows, uint64_t size) {
  std::string out = "{\"stvm_bytes\": " + std::to_string(size) + ", \"images\": [";
  const char* comma = "";
  for (const Row& row : rows) {
    out += std::string(comma) + "\n  {\"name\": \"" + row.name +
           "\", \"image_mib\": " + text_of("%.4f", row.image_mib) +
           ", \"verify_ms\": " + text_of("%.3f", row.verify_ms) +
           ", \"load_ms\": " + text_of("%.3f", row.load_ms) +
           ", \"native_ms\": " + text_of("%.3f", row.native_ms) +
           ", \"first_scan_ms\": " + text_of("%.2f", row.first_scan_ms) +
           ", \"first_native_ms\": " + text_of("%.2f", row.first_native_ms) +
           ", \"interpreted_mib\": " + text_of("%.2f", row.interpreted_mib) +
           ", \"resident_mib\": " + text_of("%.2f", row.resident_mib) +
           ", \"data_mib\": " + text_of("%.3f", row.data_mib) + "}";
    comma = ",";
  }
  return out + "\n]}\n";
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> options;
  int next = 1;
  for (; next + 1 < argc && argv[next][0] == '-'; next += 2) options[argv[next]] = argv[next + 1];
  if (options["--stvm"].empty() || options["--out"].empty() || next >= argc) {
    std::fputs("usage: bench_start --stvm PATH [--strip PATH] --out FOLDER IMAGE...\n", stderr);
    return 2;
  }
  bench::pin_to_one_core();
  const uint64_t size = stripped_size(options["--strip"], options["--stvm"], options["--out"]);
  const std::vector<std::string> images(argv + next, argv + argc);
  std::vector<Row> rows(images.size());
  for (size_t i = 0; i < images.size(); ++i) {
    rows[i].name = std::filesystem::path(images[i]).stem().string();
    measure_process(options["--stvm"], images[i], rows[i]);
  }
  for (size_t i = 0; i < images.size(); ++i) measure_load(images[i], rows[i]);
  std::printf("\n%-12s %9s %9s %8s %8s %10s %8s %8s %9s\n", "image", "MiB", "verify ms", "load ms",
              "ms/MiB", "1st scan", "code ms", "ms/MiB", "resident");
  for (const Row& row : rows) {
    std::printf("%-12s %9.3f %9.2f %8.2f %8.1f %7.1f ms %8.1f %8.1f %5.1f MiB\n", row.name.c_str(),
                row.image_mib, row.verify_ms, row.load_ms, load_per_mib(row), row.first_scan_ms,
                row.native_ms, native_per_mib(row), row.resident_mib);
  }
  if (size != 0) std::printf("stvm, stripped: %.2f MiB\n", static_cast<double>(size) / kMiB);
  std::ofstream(options["--out"] + "/start.md") << page(rows, size);
  std::ofstream(options["--out"] + "/start.json") << json(rows, size);
  return 0;
}
