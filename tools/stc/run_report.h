// The report of a run in each of its forms: what the compiler found, and what refused the run.
#pragma once

#include "base/diagnostics.h"
#include "base/result.h"

namespace stc {

// Text is for people; the others are for programs, and say what refused the run, when that is not
// null, as one more error.
std::string rendered(const base::Diagnostics& diagnostics, const base::SourceMap& sources,
                     base::DiagnosticFormat format, bool colour, const base::Error* refused);

// The text for a run without diagnostics: what tools::set_refusal_form() takes.
std::string refusal_json(const base::Error& error);
std::string refusal_sarif(const base::Error& error);
std::string refusal_github(const base::Error& error);

}  // namespace stc
