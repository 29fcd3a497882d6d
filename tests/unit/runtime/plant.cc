#include "tests/unit/runtime/plant.h"

#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "linker/link.h"

namespace runtime_test {
namespace {

base::Result<ir::VerifiedImage> image_of(const ir::Program& program, const ir::Image* base,
                                         const std::vector<ir::SafeOutput>& safe) {
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program.pous.size(); ++i) {
    base::Result<ir::Object> object = ir::lower(program, ir::PouId(i));
    if (!object.ok()) return object.error();
    objects.push_back(std::move(*object));
  }
  linker::Options options;
  options.base = base;
  options.safe = safe;
  base::Result<ir::Image> image = linker::link(program, objects, options);
  if (!image.ok()) return image.error();
  return ir::verify(ir::encode(*image));
}

}  // namespace

std::optional<ir::VerifiedImage> build(const std::string& source, const ir::Image* base,
                                       const std::vector<ir::SafeOutput>& safe) {
  base::SourceMap sources;
  sources.add("plant.st", source);
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, {}, diagnostics);
  if (!program) {
    ADD_FAILURE() << base::render(diagnostics, sources, base::DiagnosticFormat::kText, false);
    return std::nullopt;
  }
  base::Result<ir::VerifiedImage> image = image_of(*program, base, safe);
  if (!image.ok()) {
    ADD_FAILURE() << base::to_string(image.error());
    return std::nullopt;
  }
  return *image;
}

Plant::Plant(const std::string& source, vm::ControllerOptions options, int64_t ns_per_safe_point,
             const std::vector<ir::SafeOutput>& safe)
    : clock(ns_per_safe_point) {
  std::optional<ir::VerifiedImage> image = build(source, nullptr, safe);
  if (!image) return;
  auto started = vm::Controller::start(*image, options, clock, io);
  if (!started.ok()) {
    ADD_FAILURE() << base::to_string(started.error());
    return;
  }
  controller = std::move(*started);
}

void Plant::cycles(int count) {
  for (int i = 0; i < count; ++i) controller->cycle();
}

std::string Plant::get(const std::string& path) const {
  base::Result<std::string> value = controller->get(path);
  return value.ok() ? *value : base::to_string(value.error());
}

vm::TaskStatus Plant::task(const std::string& name) const {
  for (const vm::TaskStatus& row : controller->tasks()) {
    if (ir::same_name(row.name, name)) return row;
  }
  ADD_FAILURE() << "no task " << name;
  return {};
}

}  // namespace runtime_test
