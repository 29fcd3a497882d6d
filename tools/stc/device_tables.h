// The tables [devices.NAME] of stc.toml (docs/IO.md): read, checked, and resolved to bits of the
// process image. Every mistake is kBadMapping with the line and column of what is wrong.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/devices.h"
#include "tools/common/project_file.h"

namespace stc {

struct ProjectDevice {
  ir::Device device;
  std::string resource;  // which has it; "": not said
  std::string where;     // "stc.toml:3:1"
};

// Sorted by name. Other keys of the file are left alone.
base::Result<std::vector<ProjectDevice>> read_devices(const tools::ProjectFile& file);

// The devices of one of the resources `all`; of a project with one resource at most (`all` is
// empty), all devices. kBadMapping for a device that does not say which resource has it.
base::Result<std::vector<ir::Device>> devices_of(const std::vector<ProjectDevice>& devices,
                                                 const std::string& resource,
                                                 const std::vector<std::string>& all);

}  // namespace stc
