// The tasks that devices trap when they are lost (`on_loss = "trap TASK"`): asked by the linker, by
// the verifier, and by the devices of a controller.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/bytecode/image.h"

namespace ir {

// The index of the task in the image. Nothing: there is no such task, or none whose scans could
// trap.
std::optional<uint32_t> loss_task(const Image& image, std::string_view name);
// "there is no task ..." of a name that is none; "" else.
std::string bad_loss_task(const Image& image, std::string_view name);
// The first device that names none. Its settings have been checked.
std::optional<DeviceFault> find_task_fault(const Image& image);

}  // namespace ir
