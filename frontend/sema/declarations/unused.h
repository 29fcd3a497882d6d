// Check after all bodies: warns of what is declared and never used, read and never written, or left
// without a result. Reads the declarations, which bodies have marked; writes messages only.
#pragma once

#include "base/source.h"

namespace frontend {

class Phase;
struct PouInfo;

void report_unused(const Phase& phase);
// Attributes that mean something to other tools and nothing here (known_attributes.cc).
void report_other_attributes(const Phase& phase);
// Where `pou` is used: {attribute 'obsolete' := 'text'}.
void report_obsolete(const Phase& phase, const PouInfo& pou, base::SourceSpan span);

}  // namespace frontend
