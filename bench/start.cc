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
  double native_ms = 0;      // machine code of all POUs, in the background
  double first_scan_ms = 0;  // of a process: from its start to its end behind one scan
  double resident_mib = 0;   // of that process, at most
  double data_mib = 0;
};

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

// Before this process grows: see Child::peak_kib.
void measure_process(const std::string& stvm, const std::string& image, Row& row) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const bench::Child child = bench::run_child({stvm, "run", image, "--scans", "1"}, true);
    base::check(child.ok, "stvm runs the image");
    times.push_back(child.wall_ms);
  }
  row.first_scan_ms = bench::fastest(times);
  const bench::Child whole = bench::run_child(
      {stvm, "run", image, "--virtual-time", "--scans", "1", "--tier", "native"}, true);
  row.resident_mib = static_cast<double>(whole.peak_kib) / 1024;
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
      " (goal without adapters: 3). `first scan`: a process of `stvm run` from its start to its "
      "end behind one scan (goal: 10 ms). The fastest of several runs. Verifying and loading: "
      "goal 50 ms per MiB of the image, and linear. Machine code is made behind that by a thread "
      "in the background, while the program is interpreted. Resident: at most, with machine code, "
      "and without what the data memory has; goal 8 MiB for the latter.\n\n"
      "| image | MiB | verify ms | load ms | ms per MiB | first scan ms | machine code ms | "
      "resident MiB | without data |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Row& row : rows) {
    out += "| `" + row.name + "` | " + text_of("%.3f", row.image_mib) + " | " +
           text_of("%.2f", row.verify_ms) + " | " + text_of("%.2f", row.load_ms) + " | " +
           text_of("%.1f", (row.verify_ms + row.load_ms) / row.image_mib) + " | " +
           text_of("%.1f", row.first_scan_ms) + " | " + text_of("%.1f", row.native_ms) + " | " +
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
  std::printf("\n%-12s %9s %9s %8s %8s %10s %9s\n", "image", "MiB", "verify ms", "load ms",
              "ms/MiB", "1st scan", "resident");
  for (const Row& row : rows) {
    std::printf("%-12s %9.3f %9.2f %8.2f %8.1f %7.1f ms %5.1f MiB\n", row.name.c_str(),
                row.image_mib, row.verify_ms, row.load_ms,
                (row.verify_ms + row.load_ms) / row.image_mib, row.first_scan_ms, row.resident_mib);
  }
  if (size != 0) std::printf("stvm, stripped: %.2f MiB\n", static_cast<double>(size) / kMiB);
  std::ofstream(options["--out"] + "/start.md") << page(rows, size);
  std::ofstream(options["--out"] + "/start.json") << json(rows, size);
  return 0;
}
