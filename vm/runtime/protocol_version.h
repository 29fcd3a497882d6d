// Alone, for whoever reads no message (protocol.h).
#pragma once

#include <cstdint>

namespace vm {

// Another one with each other layout of a message (tests/unit/store/protocol_layout_test.cc).
inline constexpr uint8_t kProtocolVersion = 14;

}  // namespace vm
