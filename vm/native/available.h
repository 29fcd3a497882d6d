// Alone, for whoever asks no more of the native tier.
#pragma once

namespace vm::native {

// Has this machine a native tier?
bool is_available();

}  // namespace vm::native
