// Where images go, and the line that says so.
#pragma once

#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "tools/stc/build.h"

namespace stc {

// DIR/NAME.img when `output` is a folder, or ends with a slash; of several resources DIR/Line.img,
// or plant.Line.img beside plant.img. kFileUnwritable when the folder cannot be made.
base::Result<std::string> image_path(const std::string& output, const std::string& resource,
                                     const std::string& project);
// With a line on stderr if wanted. Errors: kFileUnwritable.
base::Status write_image(const std::string& path, const ir::Image& image, const base::Bytes& bytes,
                         bool with_line);
// All of them, each at its path; none when one would take the place of what was read.
base::Status write_images(const std::vector<ResourceVersion>& versions, const std::string& output,
                          const Project& project, bool with_line);

}  // namespace stc
