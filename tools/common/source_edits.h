// What a change does to the sources that travel with a program (X1, X9): a row for each file that
// is another, in the report beside what it does to devices and tasks. Of many files the first ones,
// and how many more.
#pragma once

#include "base/bytes.h"
#include "tools/common/fate_report.h"

namespace tools {

// The edits between two images that are sound, encoded.
SystemEdits source_edits(base::ByteSpan old_image, base::ByteSpan new_image);

}  // namespace tools
