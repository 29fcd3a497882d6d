#include <cmath>
#include <set>

#include "tests/unit/stdlib/native_call.h"

namespace stdlib::testing {
namespace {

TEST(NativeTable, EveryRowHasAFunctionAndAKnownSignature) {
  for (uint32_t id = 0; id < native_count(); ++id) {
    const NativeRow& row = native_row(id);
    EXPECT_NE(row.function, nullptr) << row.name;
    EXPECT_FALSE(row.arguments.empty()) << row.name;
    EXPECT_NE(std::string("vbiIUfF").find(row.result), std::string::npos) << row.name;
    for (const char letter : row.arguments) {
      EXPECT_LT(static_cast<uint32_t>(native_scalar(letter)), ir::kScalarCount) << row.name;
    }
  }
}

TEST(NativeTable, NameAndArgumentsAreUnique) {
  std::set<std::string> seen;
  for (uint32_t id = 0; id < native_count(); ++id) {
    const NativeRow& row = native_row(id);
    EXPECT_TRUE(seen.insert(std::string(row.name) + ":" + std::string(row.arguments)).second)
        << row.name;
  }
}

TEST(NativeTable, LettersAreScalars) {
  EXPECT_EQ(native_scalar('b'), ir::Scalar::kBool);
  EXPECT_EQ(native_scalar('i'), ir::Scalar::kI32);
  EXPECT_EQ(native_scalar('I'), ir::Scalar::kI64);
  EXPECT_EQ(native_scalar('U'), ir::Scalar::kU64);
  EXPECT_EQ(native_scalar('f'), ir::Scalar::kF32);
  EXPECT_EQ(native_scalar('F'), ir::Scalar::kF64);
  EXPECT_EQ(native_scalar('S'), ir::Scalar::kStr);
  EXPECT_EQ(native_scalar('W'), ir::Scalar::kWstr);
}

double real_call(NativeId id, std::vector<double> values) {
  std::vector<NativeArg> args;
  for (const double value : values) {
    args.push_back({std::bit_cast<uint64_t>(value), nullptr, 0});
  }
  return std::bit_cast<double>(call(id, args));
}

TEST(NativeMath, KnownValues) {
  EXPECT_DOUBLE_EQ(real_call(NativeId::kSin, {0.5}), 0.479425538604203);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kCos, {0.5}), 0.8775825618903728);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kTan, {0.5}), 0.5463024898437905);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kAsin, {1.0}), 1.5707963267948966);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kAcos, {1.0}), 0.0);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kAtan, {1.0}), 0.7853981633974483);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kLn, {10.0}), 2.302585092994046);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kLog, {1000.0}), 3.0);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kExp, {1.0}), 2.718281828459045);
  EXPECT_DOUBLE_EQ(real_call(NativeId::kExpt, {2.0, 10.0}), 1024.0);
}

TEST(NativeMath, Atan2TakesYFirst) {
  EXPECT_DOUBLE_EQ(real_call(NativeId::kAtan2, {1.0, 0.0}), 1.5707963267948966);
}

TEST(NativeMath, OutsideTheDomainIsNotANumber) {
  EXPECT_TRUE(std::isnan(real_call(NativeId::kLn, {-1.0})));
  EXPECT_TRUE(std::isnan(real_call(NativeId::kAsin, {2.0})));
  EXPECT_TRUE(std::isinf(real_call(NativeId::kLn, {0.0})));
}

}  // namespace
}  // namespace stdlib::testing
