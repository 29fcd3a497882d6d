// stc build --watch: stays, and builds again whenever a source is saved (workspace/).
#pragma once

#include "base/diagnostics.h"
#include "tools/common/options.h"
#include "tools/stc/build.h"

namespace stc {

// Until it is ended by a signal; an exit code only when the first build cannot even begin. Mistakes
// in sources and files that cannot be read are reported, and it goes on; the image is written
// when it is another than the last one.
int watch(const tools::Options& options, Project project, const BuildOptions& build_options,
          base::DiagnosticFormat format);

}  // namespace stc
