// C5, case 45, "0 releases missed": every golden of online change with all its tasks at 1 ms, in
// virtual time, which passes for what a switch or an undo does (Clock::worked). In place, by
// standby, and with a change after every scan besides. What would not fit is refused before.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/golden/runner/machine_engine.h"
#include "tests/golden/runner/script.h"
#include "tests/source_path.h"

namespace golden {
namespace {

constexpr int64_t kPeriodNs = 1'000'000;

struct Tally {
  size_t changes = 0;
  size_t too_long = 0;
};

std::vector<Program> versions_at_1_ms(const TestFile& test) {
  std::vector<Program> versions;
  for (size_t i = 0; i < test.versions.size(); ++i) {
    Outcome outcome;
    base::Result<Program> program = compile(test, i, outcome);
    if (!program.ok()) return {};
    for (ir::Task& task : program->program.tasks) {
      if (task.period_ns != 0) task.period_ns = kPeriodNs;
    }
    versions.push_back(std::move(*program));
  }
  return versions;
}

void run_file(const std::string& path, Tier tier, Tally& tally) {
  base::Result<TestFile> test = read_test(path);
  ASSERT_TRUE(test.ok()) << path;
  if (test->mode != "change") return;
  const std::vector<Program> versions = versions_at_1_ms(*test);
  if (versions.empty()) return;
  base::Result<std::unique_ptr<Engine>> engine = make_machine_engine(tier, versions[0]);
  ASSERT_TRUE(engine.ok()) << path << ": " << base::to_string(engine.error());
  base::Result<Transcript> transcript = run_script(*test, versions, **engine);
  ASSERT_TRUE(transcript.ok()) << path << ": " << base::to_string(transcript.error());
  for (int i = 0; i < 2; ++i) (void)(*engine)->scan().ok();  // a late release shows itself
  EXPECT_EQ((*engine)->missed(), 0u) << path << ", " << tier_name(tier);
  for (size_t i = 0; i < test->steps.size(); ++i) {
    if (test->steps[i].command.rfind("change", 0) != 0) continue;
    const std::vector<std::string>& lines = transcript->outputs[i];
    const bool refused = !lines.empty() && lines[0].rfind("refused", 0) == 0;
    if (!refused) ++tally.changes;
    if (refused && lines[0].find("R0304") != std::string::npos) ++tally.too_long;
  }
}

TEST(Releases, C5_A16_case45_NoneIsMissedInTheWholeCorpusAt1ms) {
  for (const Tier tier : {Tier::kInterpreter, Tier::kIdentity, Tier::kMoveAll, Tier::kStandby}) {
    Tally tally;
    for (const char* folder : {"change", "sfc"}) {
      const std::string path = tests::source_path("tests/golden/") + folder;
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.path().extension() == ".st") run_file(entry.path().string(), tier, tally);
      }
    }
    EXPECT_GT(tally.changes, 50u);
    EXPECT_EQ(tally.too_long, 0u) << "none of the corpus is as large as that";
  }
}

}  // namespace
}  // namespace golden
