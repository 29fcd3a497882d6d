// A Function as text.
#pragma once

#include <string>

#include "vm/native/lir.h"

namespace vm::native {

std::string print(const Function& function);

}  // namespace vm::native
