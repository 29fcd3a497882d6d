#include "tests/fuzz/versions.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/check.h"
#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "tests/source_path.h"

namespace fuzz {
namespace {

constexpr const char* kFiles[] = {"golden/change/migration.st",
                                  "golden/change/migration_of_structure.st",
                                  "golden/change/references_moved.st",
                                  "golden/change/renamed_steps.st",
                                  "golden/change/undo_restores.st",
                                  "golden/change/renamed_out_of_structure.st",
                                  "golden/change/scalar_conversions.st",
                                  "golden/change/array_by_index.st",
                                  "golden/change/objects.st",
                                  "golden/change/subrange_enum_string.st",
                                  "golden/change/union_structure.st",
                                  "golden/change/bools_become_clean.st",
                                  "golden/change/migration_between_areas.st",
                                  "fuzz/every_table.st"};
static_assert(std::size(kFiles) == kEveryTable + 1);

struct Compiled {
  ir::Program program;
  std::vector<ir::Object> objects;
};

Compiled compiled(const std::string& text) {
  base::SourceMap sources;
  sources.add("fuzz.st", text);
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, {}, diagnostics);
  base::check(program.has_value(), "a version of a golden file compiles");
  Compiled out{std::move(*program), {}};
  for (uint32_t i = 0; i < out.program.pous.size(); ++i) {
    out.objects.push_back(*ir::lower(out.program, ir::PouId(i)));
  }
  return out;
}

base::Result<ir::Image> linked(const Compiled& from, const ir::Image* base) {
  linker::Options options;
  options.base = base;
  return linker::link(from.program, from.objects, options);
}

ir::Device simulated_device(ir::Image& image) {
  image.input_bytes = std::max(image.input_bytes, 4u);
  image.output_bytes = std::max(image.output_bytes, 4u);
  ir::Device device{"panel", "simulated", {{"on_loss", "zero after 5 ms"}}, {}, {}};
  device.map = {{ir::PointTable::kByte, 0, 2, false, {ir::DirectArea::kInput, 8, 8}, false},
                {ir::PointTable::kByte, 4, 2, true, {ir::DirectArea::kOutput, 16, 8}, false}};
  device.quality = {ir::DirectArea::kInput, 0, 1};
  return device;
}

// What comes of the settings of a project, not of sources.
void add_settings(ir::Image& image) {
  image.devices = {simulated_device(image)};
  image.unit_members = {{"Clip", "Numbers"}, {"Sum", "Numbers"}};
  image.safe = {{1, 1, ir::SafeKind::kHoldThenValue, 1, 1000}, {16, 16, ir::SafeKind::kHold, 0, 0}};
  const std::vector<ir::Member>& globals = image.types[image.globals].members;
  for (uint32_t i = 0; i < globals.size(); ++i) {
    if (globals[i].name == "count" || globals[i].name == "place") {
      image.shared.push_back({i, globals[i].name == "count"});
    }
  }
}

ir::VerifiedImage version(const std::string& text, const ir::Image* base, bool settings) {
  ir::Image image = *linked(compiled(text), base);
  if (settings) add_settings(image);
  base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(image));
  base::check(verified.ok(), "a version of a golden file is sound");
  return *verified;
}

struct Texts {
  std::string from, to;
};

Texts texts(size_t number) {
  std::ifstream in(tests::source_path("tests/" + std::string(kFiles[number])));
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const size_t second = text.find("// --- v2");
  base::check(second != std::string::npos, "a golden file of two versions");
  const size_t third = std::min(text.find("// --- v3"), text.find("// > "));
  return {text.substr(0, second), text.substr(second, third - second)};
}

Versions make(size_t number) {
  const Texts text = texts(number);
  const bool settings = number == kEveryTable;
  ir::VerifiedImage from = version(text.from, nullptr, settings);
  ir::VerifiedImage to = version(text.to, &from.image(), settings);
  base::Result<online_change::Package> package =
      online_change::make_package(from.encoded(), to.encoded());
  base::check(package.ok(), "a golden file's change can be made");
  return {from, to, *std::move(package)};
}

}  // namespace

const Versions& versions(uint8_t number) {
  static std::optional<Versions> all[std::size(kFiles)];
  std::optional<Versions>& pair = all[number % std::size(kFiles)];
  if (!pair) pair = make(number % std::size(kFiles));
  return *pair;
}

base::Result<ir::Image> second_on(uint8_t number, const ir::Image& base) {
  static std::optional<Compiled> all[std::size(kFiles)];
  std::optional<Compiled>& second = all[number % std::size(kFiles)];
  if (!second) second = compiled(texts(number % std::size(kFiles)).to);
  return linked(*second, &base);
}

}  // namespace fuzz
