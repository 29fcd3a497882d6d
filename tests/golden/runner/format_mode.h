// Mode format: the text that `stc fmt` would write.
#pragma once

#include "tests/golden/runner/modes.h"

namespace golden {

void produce_format(const TestFile& test, Actual& actual);

}  // namespace golden
