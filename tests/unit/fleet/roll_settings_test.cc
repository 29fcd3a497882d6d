// X6-01: waves as fleet.toml has them, and every kind of mistake with its place.
#include <gtest/gtest.h>

#include "tools/stvm/fleet_plan.h"

namespace fleet_test {
namespace {

std::string five_controllers(const std::string& rest) {
  std::string list;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    list += std::string("[controllers.") + name + "]\nhost = \"" + name + "\"\n";
  }
  return list + rest;  // which begins in line 11
}

base::Result<stvm::RollSettings> settings(const std::string& rest) {
  const std::string text = five_controllers(rest);
  base::Result<std::vector<stvm::FleetMember>> members = stvm::parse_fleet_list("f.toml", text);
  if (!members.ok()) return members.error();
  const base::Result<tools::TomlTable> table = tools::parse_toml("f.toml", text);
  if (!table.ok()) return table.error();
  return stvm::roll_settings("f.toml", *table, *members);
}

std::string waves_of(const stvm::RollSettings& all) {
  std::string out;
  for (const stvm::Wave& wave : all.waves) {
    out += "|";
    for (const size_t member : wave.members) out += static_cast<char>('a' + member);
  }
  return out;
}

TEST(RollSettings, X601_WavesTakeNamesNumbersOrAPart) {
  const auto all = settings(
      "[roll]\nsoak = \"30min\"\nparallel = 3\n[[wave]]\ncontrollers = [\"c\"]\nsoak = \"2h\"\n"
      "[[wave]]\ncount = 1\nmax_failed = 1\n[[wave]]\npercent = 30\naccept = \"at-end\"\n"
      "[[wave]]\npercent = 100\n");
  ASSERT_TRUE(all.ok()) << base::to_string(all.error());
  EXPECT_EQ(waves_of(*all), "|c|a|bd|e");
  EXPECT_EQ(all->waves[0].soak_ms, 7'200'000);
  EXPECT_EQ(all->waves[1].soak_ms, 1'800'000);
  EXPECT_EQ(all->waves[1].max_failed, 1u);
  EXPECT_EQ(all->waves[3].parallel, 3u);
  EXPECT_TRUE(all->waves[2].accept_at_end);
  // Two soaks and ten minutes; of what is accepted at the end those of all that follow.
  EXPECT_EQ(all->waves[1].deadline_ms, 4'200'000);
  EXPECT_EQ(all->waves[2].deadline_ms, 8'400'000);
}

TEST(RollSettings, X601_X603_TheTrialHasItsConditions) {
  const auto all = settings(
      "[roll]\nhealth = [\"Main.n > 1\", \"Main.ok\"]\ngrace = \"5s\"\nhold = \"200ms\"\nwindow = \"30s\"\n"
      "missed = 3\nload = 80\ntraps = false\ndevices = true\nalarms = true\n"
      "lost_after = \"90s\"\non_failure = \"undo-all\"\nnot_undone = \"stop-safe\"\n"
      "deadline = \"1d\"\n[[wave]]\npercent = 100\n");
  ASSERT_TRUE(all.ok()) << base::to_string(all.error());
  const stvm::GuardOrder& guard = all->guard;
  EXPECT_EQ(guard.conditions.size(), 2u);
  EXPECT_EQ(guard.grace_ns, 5'000'000'000);
  EXPECT_EQ(guard.hold_ns, 200'000'000);
  EXPECT_EQ(guard.window_ns, 30'000'000'000);
  EXPECT_EQ(guard.most_missed, 3u);
  EXPECT_EQ(guard.most_load, 80u);
  EXPECT_TRUE(!guard.traps && guard.devices && guard.alarms && guard.stop_safe && all->undo_all);
  EXPECT_EQ(all->lost_after_ms, 90'000);
  EXPECT_EQ(all->waves[0].deadline_ms, 86'400'000);
}

TEST(RollSettings, X601_EveryMistakeHasItsPlace) {
  const std::pair<const char*, const char*> kMistakes[] = {
      {"", "f.toml:1:1: there are no waves"},
      {"[roll]\nsoak = \"1h\"\n", "f.toml:1:1: there are no waves"},
      {"[[wave]]\ncount = 2\n", "f.toml:12:9: controllers are left that are in no wave: c, d, e"},
      {"[[wave]]\ncount = 0\n", "f.toml:12:9: a number from 1"},
      {"[[wave]]\npercent = 101\n", "f.toml:12:11: a number from 1 to 100"},
      {"[[wave]]\nsoak = \"1h\"\n", "f.toml:12:1: the wave has no controllers"},
      {"[[wave]]\ncount = 1\npercent = 3\n", "f.toml:13:1: a wave has one of"},
      {"[[wave]]\nwho = 1\ncount = 5\n", "f.toml:12:1: `who` is not known; a wave has"},
      {"[[wave]]\ncontrollers = [\"a\", \"x\"]\n", "f.toml:12:21: no controller is called `x`"},
      {"[[wave]]\ncontrollers = [\"a\", \"a\"]\n", "f.toml:12:21: `a` is in a wave already"},
      {"[[wave]]\ncontrollers = \"a\"\n", "f.toml:12:15: [\"a\", \"b\"] is wanted"},
      {"[[wave]]\npercent = 100\n[[wave]]\ncount = 1\n", "f.toml:14:9: no controller is left"},
      {"[roll]\nsoak = \"1 hour\"\n[[wave]]\npercent = 100\n", "f.toml:12:8: a time is wanted"},
      {"[roll]\nsoak = 5\n[[wave]]\npercent = 100\n", "f.toml:12:8: a time is wanted"},
      {"[roll]\naccept = \"now\"\n[[wave]]\npercent = 100\n", "f.toml:12:10: \"after-soak\" or"},
      {"[roll]\ntraps = 1\n[[wave]]\npercent = 100\n", "f.toml:12:9: true or false"},
      {"[roll]\nhealthy = 1\n[[wave]]\npercent = 100\n", "f.toml:12:1: `healthy` is not known"},
      {"[roll]\nhealth = [\"a > 1\", \"a >\"]\n[[wave]]\npercent = 100\n",
       "f.toml:12:24: a variable, a number"},
      {"[roll]\nsoak = \"1h\"\ndeadline = \"1h\"\n[[wave]]\npercent = 100\n",
       "f.toml:13:12: the deadline is before the end of the soak"},
      {"[wave]\ncount = 1\n", "f.toml:12:1: waves are written as [[wave]]"},
      {"[[wave]\ncount = 1\n", "f.toml:11:8: expected `]]`"},
  };
  for (const auto& [text, said] : kMistakes) {
    const auto all = settings(text);
    ASSERT_FALSE(all.ok()) << text;
    EXPECT_EQ(all.error().refusal, base::Refusal::kBadProject);
    EXPECT_TRUE(all.error().text.starts_with(said)) << text << all.error().text;
  }
}

// X6-02: a plan is the same after it was written and read; one that is damaged is refused.
TEST(RollSettings, X602_APlanIsReadAsItWasWritten) {
  stvm::RollPlan plan;
  plan.list = five_controllers("[roll]\nhealth = [\"Main.ok\"]\n[[wave]]\npercent = 100\n");
  plan.id = "12345678";
  plan.who = "a \"b\" \\ c";
  plan.why = "one\ntwo\tthree\x01";
  plan.members.resize(5);
  plan.members[3].state = stvm::RollState::kUndoing;
  plan.members[3].text = "R0405: why";
  plan.members[3].from = {1, 2, 0xff};
  plan.members[3].silent_ms = 77;
  plan.phase = stvm::RollPhase::kUndoing;
  const std::string text = stvm::plan_text(plan);
  const auto again = stvm::parse_plan("x.plan", text);
  ASSERT_TRUE(again.ok()) << base::to_string(again.error());
  EXPECT_EQ(stvm::plan_text(*again), text);
  EXPECT_EQ(again->members[3].state, stvm::RollState::kUndoing);
  EXPECT_EQ(again->members[3].from, plan.members[3].from);
  for (size_t cut = 0; cut + 1 < text.size(); cut += 7) {
    EXPECT_FALSE(stvm::parse_plan("x.plan", text.substr(0, cut)).ok()) << cut;
  }
  for (const char* word : {"undoing", "12345678", "percent", "false", "controllers.4"}) {
    std::string other = text;
    const size_t at = other.rfind(word);
    ASSERT_NE(at, std::string::npos) << word;
    if (std::string(word) == "12345678") continue;  // a name like any other
    other[at] = 'X';
    EXPECT_FALSE(stvm::parse_plan("x.plan", other).ok()) << word;
  }
  // Times are counted from 1970.
  for (const std::string line : {"since = 0", "silent = 77", "soak_from = 0", "wave = 0"}) {
    const size_t at = text.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    for (const char* number : {"= -9223372036854775807", "= 9223372036854775807"}) {
      std::string other = text;
      other.replace(at, line.size(), line.substr(0, line.find('=')) + number);
      EXPECT_FALSE(stvm::parse_plan("x.plan", other).ok()) << line << number;
    }
  }
}

}  // namespace
}  // namespace fleet_test
