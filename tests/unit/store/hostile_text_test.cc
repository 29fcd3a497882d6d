// A report of an image that somebody sent: its names move no cursor.
#include <gtest/gtest.h>

#include "tools/common/fate_report.h"
#include "tools/common/json.h"
#include "tools/stvm/json_value.h"

namespace tools {
namespace {

TEST(HostileText, AFateReportShowsControlCharacters) {
  online_change::Plan plan;
  online_change::FateRow row;
  row.fate = online_change::Fate::kDropped;
  row.path = "P.x\x1b[2J";
  row.old_type = "T\x9b";
  plan.fates = {row};
  online_change::PouEdit edit;
  edit.pou = "Q\x1b]0;";
  const std::string report = fate_report(plan, {}, {edit}, {{"device", "rack\x07", "new"}});
  EXPECT_EQ(report.find_first_of("\x1b\x07\x9b"), std::string::npos) << report;
  for (const char* shown : {"P.x\\x1b[2J", "T\\x9b", "Q\\x1b]0;", "rack\\x07"}) {
    EXPECT_NE(report.find(shown), std::string::npos) << shown << " in " << report;
  }
  EXPECT_NE(report.find("\npredicted pause"), std::string::npos);
}

TEST(HostileText, AValueThatEndsInTheMiddleBecomesWholeJson) {
  const auto json = [](const char* type, const char* literal) {
    JsonWriter out;
    stvm::typed_value(out, type, literal);
    return out.finish();
  };
  EXPECT_EQ(json("ARRAY[0..1] OF INT", "[["), "{\"type\":\"ARRAY[0..1] OF INT\",\"value\":[[]]}\n");
  EXPECT_EQ(json("S", "(a := 'x"), "{\"type\":\"S\",\"value\":{\"a\":\"x\"}}\n");
  EXPECT_EQ(json("S", "(a := (b"), "{\"type\":\"S\",\"value\":{\"a\":{\"b\":\"\"}}}\n");
  EXPECT_EQ(json("STRING", "['$"), "{\"type\":\"STRING\",\"value\":[\"\\u0000\"]}\n");
}

}  // namespace
}  // namespace tools
