// What forcing one variable costs (docs/adr/0026-forced-versions.md): finding who writes it, and
// making versions of those POUs, beside the scans; exchanging the code between two scans.
//
//   bench_force --out FOLDER IMAGE...
//
// Writes force.md, a section of docs/performance.md.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/result.h"
#include "bench/measure.h"
#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "vm/load/writers.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace {

constexpr int kRepeats = 21;

struct Row {
  std::string image;
  std::string what;
  size_t variables = 0;
  size_t pous = 0;  // that write one
  double writers_ms = 0;
  double interpreted_ms = 0;
  double native_ms = 0;
  double exchange_us = 0;
};

struct Written {
  std::string path;
  vm::Variable place;
  bool only = true;  // every store to it can be left out
};

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

ir::VerifiedImage load(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string content = text.str();
  base::Result<ir::VerifiedImage> image = ir::verify(base::Bytes(content.begin(), content.end()));
  base::check(image.ok(), "the image is sound");
  return std::move(*image);
}

// Scalars that code writes, in the order of their paths.
std::vector<Written> written(const ir::Image& image) {
  std::vector<Written> all;
  std::vector<vm::Variable> places;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    if (symbol.constant || symbol.input || !image.types.is_scalar(symbol.type)) return;
    all.push_back({path, {symbol.data, image.layouts[symbol.type].size, symbol.type}});
    places.push_back(all.back().place);
  });
  std::vector<bool> found(all.size());
  for (const vm::Writer& writer : vm::find_writers(image, places)) {
    found[writer.variable] = true;
    all[writer.variable].only &= writer.how == vm::Writer::How::kOnly;
  }
  std::vector<Written> out;
  for (size_t i = 0; i < all.size(); ++i) {
    if (found[i]) out.push_back(all[i]);
  }
  return out;
}

// Seconds of both directions; the variables are free again behind it.
void force_once(vm::Controller& controller, const std::vector<Written>& variables, double& prepare,
                double& exchange) {
  std::vector<vm::NamedValue> values;
  std::vector<std::string> paths;
  for (const Written& one : variables) {
    values.push_back({one.path, *controller.get(one.path)});
    paths.push_back(one.path);
  }
  auto begin = std::chrono::steady_clock::now();
  auto change = controller.prepare_force(values);
  prepare = ms_since(begin);
  base::check(change.ok(), "the variables can be forced");
  begin = std::chrono::steady_clock::now();
  controller.use(**change);
  exchange = ms_since(begin) * 1000;
  auto back = controller.prepare_unforce(paths);
  base::check(back.ok(), "the variables are released");
  controller.use(**back);
}

double prepare_ms(const ir::VerifiedImage& image, vm::Tier tier,
                  const std::vector<Written>& variables, double& exchange_us) {
  vm::VirtualClock clock;
  vm::NullIo io;
  vm::ControllerOptions options;
  options.tier.tier = tier;
  const auto controller = vm::Controller::start(image, options, clock, io);
  base::check(controller.ok(), "the image can be loaded");
  std::vector<double> prepare(kRepeats);
  std::vector<double> exchange(kRepeats);
  for (int i = 0; i < kRepeats; ++i) {
    (*controller)->cycle();
    force_once(**controller, variables, prepare[i], exchange[i]);
  }
  exchange_us = bench::fastest(exchange);
  return bench::fastest(prepare);
}

Row measure(const ir::VerifiedImage& image, std::string name, std::string what,
            const std::vector<Written>& variables) {
  Row row{std::move(name), std::move(what), variables.size()};
  std::vector<vm::Variable> places;
  for (const Written& one : variables) places.push_back(one.place);
  std::vector<double> times;
  std::vector<bool> writes(image.image().pous.size());
  for (int i = 0; i < kRepeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<vm::Writer> writers = vm::find_writers(image.image(), places);
    times.push_back(ms_since(begin));
    for (const vm::Writer& writer : writers) writes[writer.pou] = true;
  }
  row.pous = static_cast<size_t>(std::count(writes.begin(), writes.end(), true));
  row.writers_ms = bench::fastest(times);
  row.interpreted_ms = prepare_ms(image, vm::Tier::kInterpreter, variables, row.exchange_us);
  row.native_ms = prepare_ms(image, vm::Tier::kNative, variables, row.exchange_us);
  return row;
}

// One variable whose stores are left out, and ten whose stores are executed beside the code.
std::vector<Row> measure(const std::string& path) {
  const ir::VerifiedImage image = load(path);
  const std::string name = std::filesystem::path(path).stem().string();
  std::vector<Written> only;
  std::vector<Written> beside;
  for (const Written& one : written(image.image())) (one.only ? only : beside).push_back(one);
  std::vector<Row> rows;
  if (!only.empty()) rows.push_back(measure(image, name, "left out", {only[only.size() / 2]}));
  constexpr size_t kMany = 10;
  if (beside.size() >= kMany) {
    std::vector<Written> some;
    for (size_t i = 0; i < kMany; ++i) some.push_back(beside[i * beside.size() / kMany]);
    rows.push_back(measure(image, name, "executed beside", some));
  }
  return rows;
}

std::string page(const std::vector<Row>& rows) {
  std::string out =
      "## Forcing\n\nWhat it takes to force variables that code writes "
      "([ADR 0026](adr/0026-forced-versions.md)): to find who writes them, to prepare all of it "
      "beside "
      "the scans, interpreted and with machine code, and to exchange the code between two scans. "
      "Stores "
      "to the variable are left out, or executed beside the code where they may lead elsewhere "
      "too. The "
      "fastest of several runs.\n\n"
      "| image | stores | variables | writing POUs | writers ms | prepare ms | with machine code | "
      "exchange us |\n"
      "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
  for (const Row& row : rows) {
    char text[256];
    std::snprintf(text, sizeof text, "| `%s` | %s | %zu | %zu | %.2f | %.2f | %.2f | %.1f |\n",
                  row.image.c_str(), row.what.c_str(), row.variables, row.pous, row.writers_ms,
                  row.interpreted_ms, row.native_ms, row.exchange_us);
    out += text;
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || std::strcmp(argv[1], "--out") != 0) {
    std::fputs("usage: bench_force --out FOLDER IMAGE...\n", stderr);
    return 2;
  }
  bench::pin_to_one_core();
  std::vector<Row> rows;
  for (int i = 3; i < argc; ++i) {
    for (Row& row : measure(argv[i])) rows.push_back(std::move(row));
  }
  const std::string text = page(rows);
  std::fputs(text.c_str(), stdout);
  std::ofstream(std::string(argv[2]) + "/force.md") << text;
  return 0;
}
