// A report of an image that somebody sent: its names move no cursor.
#include <gtest/gtest.h>

#include "tools/common/fate_report.h"

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

}  // namespace
}  // namespace tools
