// What the stamp of an instance says (Section::kStamp, docs/adr/0006-objects.md). Start code reads
// and writes it; a controller marks instances that leave before it runs start code for them.
#pragma once

#include <cstdint>
#include <string_view>

namespace ir {

// The program that start code is: nobody declared it, and it has no variables.
inline constexpr std::string_view kStartProgram = "__START";

inline constexpr uint32_t kNewStamp = 0;          // FB_Init has to run
inline constexpr uint32_t kLeavingStamp = 1;      // FB_Exit has to run
inline constexpr uint32_t kLeftStamp = 2;         // it has
inline constexpr uint32_t kFirstShapeStamp = 16;  // and above: the layout that it was made for
// An instance that a change found without a stamp: made, for some other layout.
inline constexpr uint32_t kOldStamp = 0xffffffff;

}  // namespace ir
