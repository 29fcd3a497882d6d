// A small hand-made image that uses every table, for tests of what reads images. Tests
// change one thing in it and look at what follows.
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace sample {

using ir::Base;
using ir::Class;
using ir::Opcode;
using ir::Unit;

struct Operand {
  Base base = Base::kFrame;
  uint32_t offset = 0;
};
inline Operand F(uint32_t offset) { return {Base::kFrame, offset}; }
inline Operand S(uint32_t offset) { return {Base::kSelf, offset}; }
inline Operand G(uint32_t offset) { return {Base::kGlobal, offset}; }
inline Operand C(uint32_t offset) { return {Base::kConst, offset}; }

using Code = std::vector<Unit>;
Code op(Opcode opcode, Operand a = {}, Operand b = {}, Operand c = {});
Code wide(Opcode opcode, Operand a, Operand bc);  // b and c are one 32-bit place
Code jump(Opcode opcode, int32_t units, Operand a = {});
Code ext(Opcode opcode, Operand a, Operand b, Operand c, uint32_t x, uint32_t y);
Code operator+(Code left, const Code& right);

// Numbers and offsets of the sample. Program Main (instance 1) calls function Add (POU 0)
// and its function blocks of type Counter (POU 1).
inline constexpr uint32_t kAddPou = 0;
inline constexpr uint32_t kCounterPou = 1;
inline constexpr uint32_t kMainPou = 2;
inline constexpr uint32_t kMainInstance = 1;
inline constexpr uint32_t kGlobalsData = 64;
inline constexpr uint32_t kMainData = 256;

// Globals, absolute: count DINT, in BOOL %IX0.0, out BOOL %QX0.0, limit INT CONSTANT, shared
// Counter.
inline constexpr uint32_t kCount = kGlobalsData + 0;
inline constexpr uint32_t kIn = kGlobalsData + 4;
inline constexpr uint32_t kOut = kGlobalsData + 5;
inline constexpr uint32_t kLimit = kGlobalsData + 6;
inline constexpr uint32_t kShared = kGlobalsData + 8;
// Main, from its area on.
inline constexpr uint32_t kX = 0;         // INT
inline constexpr uint32_t kY = 2;         // INT
inline constexpr uint32_t kFlag = 4;      // BOOL
inline constexpr uint32_t kReal = 8;      // REAL
inline constexpr uint32_t kText = 12;     // STRING[10]
inline constexpr uint32_t kNumbers = 24;  // ARRAY[1..4] OF INT
inline constexpr uint32_t kPair = 32;     // Pair: a INT, t STRING[5]
inline constexpr uint32_t kFb = 40;       // Counter
inline constexpr uint32_t kFbs = 44;      // ARRAY[0..1] OF Counter
inline constexpr uint32_t kLong = 56;     // LINT
inline constexpr uint32_t kLreal = 64;    // LREAL
inline constexpr uint32_t kWtext = 72;    // WSTRING[3]
inline constexpr uint32_t kLevel = 80;    // INT(0..100)
inline constexpr uint32_t kWord = 84;     // UDINT
// Counter: run BOOL, n INT, io in-out INT.
inline constexpr uint32_t kRun = 0;
inline constexpr uint32_t kN = 2;
inline constexpr uint32_t kIo = 4;
// Frame of Main; the next one begins at kNext.
inline constexpr uint32_t kB0 = 0;
inline constexpr uint32_t kW0 = 2;
inline constexpr uint32_t kD0 = 4;
inline constexpr uint32_t kQ0 = 8;
inline constexpr uint32_t kF0 = 16;
inline constexpr uint32_t kLf0 = 24;
inline constexpr uint32_t kAddrInt = 32;
inline constexpr uint32_t kAddrPair = 36;
inline constexpr uint32_t kAddrNumbers = 40;
inline constexpr uint32_t kAddrCounter = 44;
inline constexpr uint32_t kStr0 = 48;
inline constexpr uint32_t kWstr0 = 56;
inline constexpr uint32_t kPair0 = 64;  // aggregate
inline constexpr uint32_t kAddrInt2 = 72;
inline constexpr uint32_t kAddrSlot = 76;  // element of fbs
inline constexpr uint32_t kStr1 = 80;
inline constexpr uint32_t kNext = 88;
// Frame of Add: a INT, b INT, result INT.
inline constexpr uint32_t kArgA = kNext + 0;
inline constexpr uint32_t kArgB = kNext + 2;
inline constexpr uint32_t kResult = kNext + 4;
// Slot numbers of Main, for merges.
inline constexpr uint16_t kSlotB0 = 0;
inline constexpr uint16_t kSlotW0 = 1;
inline constexpr uint16_t kSlotAddrInt = 6;
// Constant pool.
inline constexpr uint32_t kOne16 = 0;
inline constexpr uint32_t kFour16 = 2;
inline constexpr uint32_t kTrue = 4;
inline constexpr uint32_t kNotBool = 5;  // 7
inline constexpr uint32_t kZero16 = 6;
inline constexpr uint32_t kOne32 = 8;
inline constexpr uint32_t kHello = 12;      // 'hello', 6 bytes
inline constexpr uint32_t kPairValue = 24;  // Pair(7, 'ab')
inline constexpr uint32_t kNoEnd = 32;      // 8 bytes 'x' without an end
inline constexpr uint32_t kBig64 = 40;      // most negative LINT
inline constexpr uint32_t kMinusOne64 = 48;
inline constexpr uint32_t kHalf = 56;  // LREAL 2.5
inline constexpr uint32_t kHuge = 64;  // LREAL 1.0E+300

struct Types {
  ir::TypeId counter, pair, main, numbers, counters, text, wtext, text5, level;
};

// The sample with Main's code and merges as given; a RET is needed in `code`.
ir::Image image(Code code, std::vector<ir::Merge> merges = {});
// Main does a bit of everything: calls, loops, strings, function blocks.
ir::Image busy_image();
Code busy_code(std::vector<ir::Merge>& merges);
Types types_of(const ir::Image& image);
uint32_t native(const char* name);
// Replaces the code of one POU.
void set_code(ir::Image& image, uint32_t pou, const Code& code, std::vector<ir::Merge> merges = {});

}  // namespace sample
