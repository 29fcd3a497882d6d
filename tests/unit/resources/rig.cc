#include "tests/unit/resources/rig.h"

#include "frontend/compile.h"
#include "ir/bytecode/symbols.h"
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "online_change/package/package.h"

namespace resources_test {

std::vector<ir::VerifiedImage> build(const std::string& source,
                                     const std::vector<const ir::Image*>& bases) {
  base::SourceMap sources;
  sources.add("plant.st", source);
  base::Diagnostics diagnostics;
  auto compiled = frontend::compile_resources(sources, {}, diagnostics);
  std::vector<ir::VerifiedImage> images;
  if (!compiled) {
    ADD_FAILURE() << base::render(diagnostics, sources, base::DiagnosticFormat::kText, false);
    return images;
  }
  for (const frontend::ResourceProgram& made : compiled->programs) {
    std::vector<ir::Object> objects;
    for (uint32_t i = 0; i < made.program.pous.size(); ++i) {
      if (made.other_code[i]) continue;
      objects.push_back(*ir::lower(made.program, ir::PouId(i)));
    }
    linker::Options options;
    if (images.size() < bases.size()) options.base = bases[images.size()];
    base::Result<ir::Image> image = linker::link(made.program, objects, options);
    base::check(image.ok(), "it links");
    base::Result<ir::VerifiedImage> verified = ir::verify(ir::encode(*image));
    if (!verified.ok()) base::check(false, base::to_string(verified.error()).c_str());
    images.push_back(*verified);
  }
  return images;
}

Rig::Rig(const std::string& source, int64_t ns_per_safe_point, vm::ControllerOptions options) {
  const std::vector<ir::VerifiedImage> images = build(source);
  if (images.empty()) error = "it does not compile";
  std::vector<vm::GlobalExchange::Resource> all;
  for (const ir::VerifiedImage& image : images) {
    const std::string& name = image.image().name;
    all.push_back({name.substr(name.rfind('.') + 1), image});
  }
  auto made = vm::GlobalExchange::make(all);
  if (!made.ok()) {
    error = base::to_string(made.error());
    return;
  }
  exchange = std::move(*made);
  if (ns_per_safe_point != 0) options.fuel_slice = 1;
  for (size_t i = 0; i < images.size(); ++i) {
    resources.push_back(std::make_unique<Resource>(ns_per_safe_point));
    Resource& one = *resources.back();
    one.port = std::make_unique<vm::ResourcePort>(*exchange, i, one.clock, one.io);
    auto controller = vm::Controller::start(images[i], options, one.clock, *one.port);
    if (!controller.ok()) {
      error = base::to_string(controller.error());
      return;
    }
    one.controller = std::move(*controller);
    one.change = std::make_unique<online_change::Change>(*one.controller);
  }
}

void Rig::run_to(int64_t ms, const std::function<void(size_t)>& behind_cycle) {
  while (true) {
    size_t next = resources.size();
    int64_t when = ms * kMs;
    for (size_t i = 0; i < resources.size(); ++i) {
      const vm::Controller& one = *resources[i]->controller;
      const bool sooner =
          next == resources.size() ? one.next_cycle_ns() <= when : one.next_cycle_ns() < when;
      if (one.faulted() || !sooner) continue;
      next = i;
      when = one.next_cycle_ns();
    }
    if (next == resources.size()) return;
    resources[next]->controller->cycle();
    if (behind_cycle) behind_cycle(next);
  }
}

std::string Rig::get(size_t resource, const std::string& path) const {
  base::Result<std::string> value = resources[resource]->controller->get(path);
  return value.ok() ? *value : base::to_string(value.error());
}

std::vector<vm::DeviceStatus> Rig::status(size_t resource) const {
  return resources[resource]->port->status();
}

std::string Rig::complaint(size_t resource) const {
  std::string all;
  for (const vm::DeviceStatus& row : status(resource)) all += row.error;
  return all;
}

base::Status Rig::change(size_t resource, const std::string& source, bool allow_loss) {
  Resource& one = *resources[resource];
  std::vector<const ir::Image*> bases;
  for (const auto& other : resources) bases.push_back(&other->controller->image());
  const std::vector<ir::VerifiedImage> next = build(source, bases);
  auto package =
      online_change::make_package(one.controller->verified().encoded(), next[resource].encoded());
  if (!package.ok()) return package.error();
  base::Status staged =
      one.change->stage(online_change::encode(*package), online_change::Strategy::kInPlace);
  if (!staged.ok()) {
    one.change->cancel();
    return staged;
  }
  base::Status armed = one.change->arm(allow_loss);
  if (!armed.ok()) return armed;
  auto report = one.change->switch_now();
  return report.ok() ? base::Status(base::Ok{}) : report.error();
}

void Rig::undo(size_t resource) {
  auto report = resources[resource]->change->undo(online_change::Exits::kRun,
                                                online_change::Losses::kAllowed);
  EXPECT_TRUE(report.ok()) << base::to_string(report.error());
  resources[resource]->change->collect();
}

void Rig::accept(size_t resource) {
  EXPECT_TRUE(resources[resource]->change->accept().ok());
  resources[resource]->change->collect();
}

}  // namespace resources_test
