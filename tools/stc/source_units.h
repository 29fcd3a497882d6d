// One side of a difference in words (X9): the units of a project, or of the sources that travel
// with an image.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "tools/stc/session.h"
#include "tools/stc/units.h"

namespace stc {

// The units of sources, or of the image when `paths` is one.
base::Result<std::vector<Unit>> source_units(const tools::Options& options,
                                             const std::vector<std::string>& paths,
                                             const Version& version);
// The units of an image. Errors: kFileNotFound when none travel with it, kBadFormat, those of
// load_project().
base::Result<std::vector<Unit>> source_units(const Version& version);

}  // namespace stc
