// Check after all bodies: warns of what is declared and never used, read and never written, or left
// without a result. Reads the declarations, which bodies have marked; writes messages only.
#pragma once

namespace frontend {

class Phase;

void report_unused(const Phase& phase);
// Attributes that mean something to other tools and nothing here (known_attributes.cc).
void report_other_attributes(const Phase& phase);

}  // namespace frontend
