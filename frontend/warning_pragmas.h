// Where sources silence warnings: {warning off W0003, W0013} until {warning restore W0003}
// or the end of the file; without codes it is about every warning. `disable` is another word for
// `off`, as CODESYS has it; codes of other compilers are passed over.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "base/warning_policy.h"
#include "frontend/compile.h"

namespace frontend {

// Silences what all sources ask for; what the policy had of another state of them goes. Returns
// what is wrong with such pragmas, to be reported.
std::vector<base::Diagnostic> silence_warnings(const base::SourceMap& sources,
                                               const CompileOptions& options,
                                               base::WarningPolicy& policy);

}  // namespace frontend
