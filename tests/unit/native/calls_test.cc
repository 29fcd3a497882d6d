// Functions that machine code calls with arguments in registers: these arrive whatever registers
// they lay in, and what lives across the call is the same behind it.
#include <array>

#include "tests/unit/native/native_functions.h"

namespace vm::native {
namespace {

std::array<uint64_t, 4> got;

// Loses every register that it may.
uint64_t record(uint8_t*, uint64_t a, uint64_t b, uint64_t c, uint64_t d, uint64_t) {
  got = {a, b, c, d};
#if defined(__x86_64__)
  asm volatile(
      "mov $-1, %%rcx\n mov $-1, %%rdx\n mov $-1, %%rsi\n mov $-1, %%rdi\n mov $-1, %%r8\n"
      "mov $-1, %%r9\n mov $-1, %%r10\n mov $-1, %%r11\n xorps %%xmm0, %%xmm0\n"
      "xorps %%xmm1, %%xmm1\n xorps %%xmm2, %%xmm2\n xorps %%xmm3, %%xmm3\n"
      "xorps %%xmm8, %%xmm8\n xorps %%xmm14, %%xmm14\n" ::
          : "rcx", "rdx", "rsi", "rdi", "r8", "r9", "r10", "r11", "xmm0", "xmm1", "xmm2", "xmm3",
            "xmm8", "xmm14");
#elif defined(__aarch64__)
  asm volatile(
      "mov x1, #-1\n mov x2, #-1\n mov x3, #-1\n mov x4, #-1\n mov x5, #-1\n mov x6, #-1\n"
      "mov x7, #-1\n mov x8, #-1\n mov x9, #-1\n mov x10, #-1\n mov x11, #-1\n mov x12, #-1\n"
      "mov x13, #-1\n mov x14, #-1\n mov x15, #-1\n mov x16, #-1\n mov x17, #-1\n"
      "fmov d0, xzr\n fmov d1, xzr\n fmov d7, xzr\n fmov d16, xzr\n fmov d31, xzr\n" ::
          : "x1", "x2", "x3", "x4", "x5", "x6", "x7", "x8", "x9", "x10", "x11", "x12", "x13", "x14",
            "x15", "x16", "x17", "d0", "d1", "d7", "d16", "d31");
#endif
  return a + 2 * b + 3 * c + 4 * d;
}

constexpr int64_t kResult = 256;
constexpr uint32_t kCount = 12;  // integers, and as many numbers

// Loads everything, calls with four of the integers, and stores it all.
uint32_t add_call(NativeFunctions& functions, const std::array<uint32_t, 4>& arguments,
                  uint32_t integers) {
  FunctionMaker f;
  std::vector<Val> values;
  for (uint32_t i = 0; i < integers; ++i) values.push_back(f.load(8 * i, 8));
  std::vector<Val> floats;
  for (uint32_t i = 0; i < kCount; ++i) floats.push_back(f.load(8 * (kCount + i), 8, true));
  Node call;
  call.op = Op::kNative;
  call.width = 8;
  call.imm = reinterpret_cast<uintptr_t>(&record);
  for (uint32_t i = 0; i < 4; ++i) {
    const bool is_constant = arguments[i] >= integers;
    call.in[i] = is_constant ? f.constant(arguments[i], 8) : values[arguments[i]];
  }
  const Val result = f.append(call, 8);
  f.store(kResult, result, 8);
  for (uint32_t i = 0; i < integers; ++i) f.store(kResult + 8 + 8 * i, values[i], 8);
  for (uint32_t i = 0; i < kCount; ++i) f.store(kResult + 8 + 8 * (kCount + i), floats[i], 8);
  f.end();
  return functions.add(f.function());
}

TEST(NativeCalls, ArgumentsArriveAndEverythingElseLivesOn) {
  NativeFunctions functions;
  struct Case {
    std::array<uint32_t, 4> arguments;
    uint32_t integers;
    uint32_t function;
  };
  std::vector<Case> cases;
  // Of few values all lie in registers, of many some do not; the last ones are constants.
  for (const uint32_t integers : {2u, 4u, 6u, 9u, 12u}) {
    for (uint32_t shift = 0; shift < 12; ++shift) {
      for (const uint32_t step : {0u, 1u, 5u, 7u}) {
        std::array<uint32_t, 4> arguments;
        for (uint32_t i = 0; i < 4; ++i) arguments[i] = (shift + i * step) % 12;
        cases.push_back({arguments, integers, add_call(functions, arguments, integers)});
      }
    }
  }
  functions.finish();
  for (const Case& c : cases) {
    std::array<uint64_t, 64> frame{};
    for (uint32_t i = 0; i < 2 * kCount; ++i) frame[i] = 0x0123456789abcdef * (i + 1);
    functions.run(c.function, frame.data());
    std::array<uint64_t, 4> wanted;
    for (uint32_t i = 0; i < 4; ++i) {
      wanted[i] = c.arguments[i] < c.integers ? frame[c.arguments[i]] : c.arguments[i];
    }
    ASSERT_EQ(got, wanted);
    ASSERT_EQ(frame[kResult / 8], wanted[0] + 2 * wanted[1] + 3 * wanted[2] + 4 * wanted[3]);
    for (uint32_t i = 0; i < 2 * kCount; ++i) {
      if (i >= c.integers && i < kCount) continue;
      ASSERT_EQ(frame[kResult / 8 + 1 + i], frame[i]) << i << " of " << c.integers;
    }
  }
}

}  // namespace
}  // namespace vm::native
