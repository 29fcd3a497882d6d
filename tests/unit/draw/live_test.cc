// What values of a running program say about expressions: the truth, or nothing.
#include <gtest/gtest.h>

#include "frontend/draw/live.h"

namespace frontend::draw {
namespace {

Live sample() {
  Live live("Line.Pump");
  live.set("Line.Pump.on", "TRUE");
  live.set("Line.Pump.off", "FALSE");
  live.set("Line.Pump.level", "12");
  live.set("Line.Pump.speed", "-2.5");
  live.set("Line.Pump.t.Q", "TRUE");
  live.set("Line.Pump.word.3", "TRUE");
  live.set("Line.Pump.list[2]", "7");
  live.set("Line.Pump.time", "T#5s");
  live.set("Everywhere", "TRUE");
  live.set("on", "FALSE");
  return live;
}

TEST(Live, TellsTheTruth) {
  Live live = sample();
  for (const char* expression : {"on",
                                 "ON",
                                 "NOT off",
                                 "on AND Everywhere",
                                 "on & NOT off",
                                 "off OR on",
                                 "on XOR off",
                                 "level = 12",
                                 "level > 11.5",
                                 "level <> 3",
                                 "speed < 0",
                                 "-2.5 = speed",
                                 "speed >= -3",
                                 "t.Q",
                                 "word.3",
                                 "list[2] = 7",
                                 "(off OR on) AND NOT (level <= 3)",
                                 "on = TRUE",
                                 "off <> TRUE",
                                 "unknown OR on",
                                 "1_000 > level"}) {
    EXPECT_EQ(live.truth(expression), Truth::kTrue) << expression;
  }
  for (const char* expression : {"off", "NOT on", "on AND off", "unknown AND off", "level < 12",
                                 "off = TRUE", "list[2] <> 7"}) {
    EXPECT_EQ(live.truth(expression), Truth::kFalse) << expression;
  }
}

TEST(Live, NeverGuesses) {
  Live live = sample();
  for (const char* expression :
       {"unknown", "on AND unknown", "off OR unknown", "on XOR unknown", "F(on)", "level + 1 > 3",
        "level", "time > T#3s", "list[level] = 7", "p^", "on off", "(on", "", "level = on",
        "'a' = 'a'", "level > 3 AND", "INT#12 = level", "16#C = level"}) {
    EXPECT_EQ(live.truth(expression), Truth::kUnknown) << expression;
  }
  EXPECT_EQ(live.truth(std::string(5000, '(') + "on" + std::string(5000, ')')), Truth::kUnknown);
}

TEST(Live, ShowsValuesThatColourCannot) {
  Live live = sample();
  EXPECT_EQ(live.shown("level"), "12");
  EXPECT_EQ(live.shown("on"), "");
  EXPECT_EQ(live.shown("unknown"), "");
  EXPECT_EQ(live.shown("level > limit AND level < speed"), "level=12 speed=-2.5");
}

}  // namespace
}  // namespace frontend::draw
