// What a change does beside values and code: to devices, tasks, programs, charts, addresses,
// attributes of variables and safe outputs. In the report beside fates and code (X1, change cases
// 64 to 66). Map entries of devices that go leave their outputs at zero (docs/IO.md).
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

struct SystemEdit {
  // "variable", "resource", "task", "program", "output", "device", "chart", "unit"
  std::string kind;
  std::string name;
  std::string what;  // "T#10ms -> T#20ms", "new", "removed", "%QX0.0 -> %QX7.7"
};
// Variables and programs that both versions have; addresses, tasks and devices also when only one
// has them. What was renamed has one name in both (ir/bytecode/renames.h).
std::vector<SystemEdit> system_edits(const ir::Image& old_image, const ir::Image& new_image);

// By name, in order of what is said of each.
std::vector<SystemEdit> device_edits(const ir::Image& old_image, const ir::Image& new_image);

// The edits of charts that both versions have under one name: "Filling -> Full removed", "(A, B) ->
// C new".
std::vector<SystemEdit> chart_edits(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
