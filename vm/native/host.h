// The back end of the machine that this is compiled for. The others are compiled as well, as all
// of them only write bytes.
#pragma once

#if defined(__aarch64__)
#include "vm/native/arm64/emitter.h"
#else
#include "vm/native/x64/emitter.h"
#endif

namespace vm::native::host {

#if defined(__aarch64__)
using arm64::Assembler;
using arm64::emit_shared;
using arm64::Emitter;
using HostTarget = arm64::Arm64Target;
inline constexpr bool kFollowsHandles = false;  // it leaves them to handlers
#else
using x64::Assembler;
using x64::emit_shared;
using x64::Emitter;
using HostTarget = x64::X64Target;
inline constexpr bool kFollowsHandles = true;
#endif

#if defined(__x86_64__) || defined(__aarch64__)
inline constexpr bool kIsAvailable = true;
#else
inline constexpr bool kIsAvailable = false;
#endif

}  // namespace vm::native::host
