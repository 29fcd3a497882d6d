// The files of simulated devices: values, times, and whatever else a file may hold.
#include <gtest/gtest.h>

#include <random>

#include "vm/io/csv_inputs.h"

namespace vm {
namespace {

constexpr const char* kText =
    "# plant\n\ntime_ms,%IX0.0,%IW2,%ID4,%IL1,lost\r\n"
    "0,FALSE,-7,16#FFFFFFFF,-1,\n"
    "0.5,TRUE,,,,TRUE\n"
    "2,0,65535,-2147483648,18446744073709551615,FALSE";

TEST(CsvInputs, RowsHoldFromTheirTimeOn) {
  base::Result<CsvInputs> csv = CsvInputs::parse("in.csv", kText);
  ASSERT_TRUE(csv.ok()) << csv.error().text;
  EXPECT_EQ(csv->columns().size(), 4u);
  csv->advance(0);
  EXPECT_EQ(csv->value(0), 0u);
  EXPECT_EQ(csv->value(1), 0xfff9u);
  EXPECT_EQ(csv->value(2), 0xffffffffu);
  EXPECT_EQ(csv->value(3), UINT64_MAX);
  csv->advance(499'999);
  EXPECT_FALSE(csv->lost());
  csv->advance(500'000);
  EXPECT_TRUE(csv->lost());
  EXPECT_EQ(csv->value(0), 1u);
  EXPECT_EQ(csv->value(1), 0xfff9u);  // an empty cell
  csv->advance(INT64_MAX);
  EXPECT_FALSE(csv->lost());
  EXPECT_EQ(csv->value(1), 65535u);
  EXPECT_EQ(csv->value(2), 0x80000000u);
}

TEST(CsvInputs, ValuesThatDoNotFitAreRefused) {
  for (const char* row :
       {"0,-32769", "0,65536", "0,16#10000", "0,1.5", "0,x", "0,TRUE", "0,16#", "0,--1", "1e3,0",
        ".5,0", "0.1234567,0", "9999999999999999,0", "-0.5,0"}) {
    EXPECT_FALSE(CsvInputs::parse("f", std::string("time_ms,%IW2\n") + row).ok()) << row;
  }
  for (const char* header : {"", "time_ms", "time_ms,", "time_ms,%IW2,", "time_ms,%MW2",
                             "time_ms,lost,lost\n0,TRUE,TRUE",
                             "time_ms,%IX0.0,lost,lost\n0,1,1,1"}) {
    EXPECT_FALSE(CsvInputs::parse("f", header).ok()) << header;
  }
}

TEST(CsvInputs, SurvivesMutation) {
  std::mt19937 random(5);
  const std::string text = kText;
  int good = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string mutant = text;
    for (int i = 0; i < 3; ++i) mutant[random() % mutant.size()] = static_cast<char>(random());
    if (random() % 4 == 0) mutant.resize(random() % mutant.size());
    base::Result<CsvInputs> csv = CsvInputs::parse("f", mutant);
    if (!csv.ok()) continue;
    ++good;
    csv->advance(INT64_MAX);
    for (size_t i = 0; i < csv->columns().size(); ++i) (void)csv->value(i);
  }
  EXPECT_GT(good, 0);
}

}  // namespace
}  // namespace vm
