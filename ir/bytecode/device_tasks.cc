#include "ir/bytecode/device_tasks.h"

namespace ir {

std::optional<uint32_t> loss_task(const Image& image, std::string_view name) {
  for (uint32_t i = 0; i < image.tasks.size(); ++i) {
    const ImageTask& task = image.tasks[i];
    if (same_name(task.name, name) && !task.once && !task.programs.empty()) return i;
  }
  return std::nullopt;
}

std::string bad_loss_task(const Image& image, std::string_view name) {
  if (name.empty() || loss_task(image, name)) return {};
  std::string tasks;
  for (const ImageTask& task : image.tasks) {
    if (loss_task(image, task.name)) tasks += (tasks.empty() ? "`" : ", `") + task.name + "`";
  }
  return "`on_loss` names `" + std::string(name) + "`, which is no task that runs a program; " +
         (tasks.empty() ? "there is none" : "there is " + tasks);
}

std::optional<DeviceFault> find_task_fault(const Image& image) {
  for (size_t i = 0; i < image.devices.size(); ++i) {
    const std::optional<LossPolicy> loss = parse_loss(setting(image.devices[i], "on_loss"));
    if (!loss) continue;
    std::string text = bad_loss_task(image, loss->task);
    if (!text.empty()) return DeviceFault{i, DeviceFault::kDevice, std::move(text)};
  }
  return std::nullopt;
}

}  // namespace ir
