// `stc explain test`: how unit tests are written, on one page of 80 columns.
#pragma once

#include <string>

namespace stc {

std::string test_page();

}  // namespace stc
