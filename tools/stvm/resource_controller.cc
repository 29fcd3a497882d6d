#include "tools/stvm/resource_controller.h"

#include <algorithm>

#include "base/limits.h"
#include "tools/stvm/record.h"

namespace stvm {
namespace {

using Resource = vm::GlobalExchange::Resource;

// "Plant.Line": CONFIGURATION and RESOURCE.
size_t dot_of(const std::string& name) { return name.rfind('.'); }

bool has_device(const ir::Image& image, const std::string& name) {
  return std::any_of(image.devices.begin(), image.devices.end(),
                     [&](const ir::Device& device) { return device.name == name; });
}

// What `--device` says about devices of other resources is not this one's affair.
base::Result<vm::DeviceIo::Options> own_devices(const ResourceController::Settings& settings,
                                                vm::Clock& clock) {
  auto devices = device_options(settings.options, settings.virtual_time ? &clock : nullptr);
  if (!devices.ok()) return devices;
  devices->log = settings.log;
  devices->events = settings.limits.events;
  std::erase_if(devices->overrides, [&](const vm::DeviceOverride& row) {
    if (has_device(settings.all[settings.number].image.image(), row.device)) return false;
    return std::any_of(settings.all.begin(), settings.all.end(), [&](const Resource& resource) {
      return has_device(resource.image.image(), row.device);
    });
  });
  return devices;
}

}  // namespace

base::Result<std::vector<Resource>> name_resources(std::vector<ir::VerifiedImage> images) {
  std::vector<Resource> out;
  if (images.size() == 1) {
    out.push_back({"", std::move(images.front())});
    return out;
  }
  if (images.size() > base::kMaxResources) {
    return base::Error{base::Refusal::kTooMany,
                       std::to_string(images.size()) + " images; one process runs " +
                           std::to_string(base::kMaxResources) + " resources"};
  }
  for (ir::VerifiedImage& image : images) {
    const std::string& name = image.image().name;
    const size_t dot = dot_of(name);
    const auto wrong = [&](const std::string& why) {
      return base::Error{base::Refusal::kUsage,
                         "the images are not the resources of one "
                         "CONFIGURATION: " +
                             why};
    };
    if (dot == std::string::npos) return wrong("`" + name + "` is a program by itself");
    const Resource next{name.substr(dot + 1), image};
    for (const Resource& other : out) {
      const std::string& first = other.image.image().name;
      if (!ir::same_name(first.substr(0, dot_of(first)), name.substr(0, dot))) {
        return wrong("`" + first + "` and `" + name + "`");
      }
      if (ir::same_name(other.name, next.name)) return wrong("`" + name + "` is there twice");
    }
    out.push_back(next);
  }
  return out;
}

base::Result<std::unique_ptr<vm::GlobalExchange>> make_exchange(
    const std::vector<Resource>& resources) {
  if (resources.size() < 2) return std::unique_ptr<vm::GlobalExchange>();
  return vm::GlobalExchange::make(resources);
}

base::Result<std::unique_ptr<ResourceController>> ResourceController::start(
    const Settings& settings, vm::Clock& clock, base::ByteSpan retained) {
  auto devices = own_devices(settings, clock);
  if (!devices.ok()) return devices.error();
  const Resource& resource = settings.all[settings.number];
  auto out = std::make_unique<ResourceController>(std::move(*devices));
  out->name_ = resource.name;
  vm::IoPort* port = &out->io_;
  if (settings.exchange != nullptr) {
    out->port_ =
        std::make_unique<vm::ResourcePort>(*settings.exchange, settings.number, clock, out->io_);
    port = out->port_.get();
  }
  auto recorder = open_recorder(settings.options, resource.name, resource.image, retained,
                                settings.limits, clock, *port, settings.trial);
  if (!recorder.ok()) return recorder.error();
  out->recorder_ = std::move(*recorder);
  auto controller =
      start_recorded(resource.image, settings.limits, clock, *port, retained, out->recorder_.get());
  if (!controller.ok()) return controller.error();
  out->controller_ = std::move(*controller);
  return out;
}

void ResourceController::cycle() {
  if (recorder_) recorder_->begin();
  controller_->cycle();
  if (recorder_) recorder_->end(*controller_);
}

}  // namespace stvm
