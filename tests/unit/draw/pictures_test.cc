// Pictures, byte for byte, and what must hold for any of them. `STC_UPDATE_PICTURES=1 test_draw`
// writes the expected files anew: look at what it wrote.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "frontend/draw/picture.h"
#include "frontend/parse/parse.h"
#include "tests/source_path.h"

namespace frontend::draw {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

std::string picture(const std::string& source, const Live* live, bool notes = true,
                    double width = 0) {
  base::SourceMap sources;
  sources.add("a.st", source);
  base::Diagnostics diagnostics;
  Tree tree;
  parse(sources, 0, tree, diagnostics);
  for (const base::Diagnostic& one : diagnostics.all()) ADD_FAILURE() << one.text;
  if (!tree.charts.empty()) return draw_chart(tree, sources, tree.charts[0], "Title", live);
  if (tree.diagrams.empty()) return "nothing";
  const Notes known = notes_of(tree, sources, tree.pous[0], nullptr);
  return draw_body(tree.diagrams[0], "Title", {live, notes ? &known : nullptr, width});
}

std::string ladder(const std::string& rows) {
  return "PROGRAM p\nLADDER\n" + rows + "END_LADDER\nEND_PROGRAM\n";
}

// Every element is closed, and attributes have quotes: enough for what is written here.
void expect_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  for (size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    size_t end = svg.find('>', at);
    ASSERT_NE(end, std::string::npos);
    std::string tag = svg.substr(at + 1, end - at - 1);
    EXPECT_EQ(std::count(tag.begin(), tag.end(), '"') % 2, 0) << tag;
    std::string name = tag.substr(0, tag.find_first_of(" />", 1));
    if (tag.front() == '/') {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ('/' + open.back(), tag);
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
}

Live values() {
  Live live("p");
  for (auto [path, value] :
       std::initializer_list<std::pair<const char*, const char*>>{{"p.Start", "FALSE"},
                                                                  {"p.Run", "TRUE"},
                                                                  {"p.Stop", "FALSE"},
                                                                  {"p.Count", "FALSE"},
                                                                  {"p.CTU1.Q", "TRUE"},
                                                                  {"p.CTU1.CV", "12"},
                                                                  {"p.Level", "12"},
                                                                  {"p.a", "TRUE"},
                                                                  {"p.b", "FALSE"},
                                                                  {"p.Heat.X", "TRUE"},
                                                                  {"p.Stir.X", "TRUE"},
                                                                  {"p.Idle.X", "FALSE"},
                                                                  {"p.Heat.T", "T#3s"},
                                                                  {"p.Temperature", "60.5"},
                                                                  {"p.delay.Q", "TRUE"},
                                                                  {"Full", "TRUE"},
                                                                  {"p.Door", "FALSE"},
                                                                  {"p.Manual", "FALSE"},
                                                                  {"p.Force", "FALSE"}}) {
    live.set(path, value);
  }
  return live;
}

TEST(Pictures, AreAsTheyWere) {
  fs::path folder = tests::source_path("tests/unit/draw/pictures");
  Live live = values();
  uint32_t seen = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".st") continue;
    for (bool shown : {false, true}) {
      const double width = entry.path().stem() == "wide" ? 420 : 0;
      std::string svg = picture(read_file(entry.path()), shown ? &live : nullptr, true, width);
      fs::path expected = entry.path();
      expected.replace_extension(shown ? ".live.svg" : ".svg");
      if (std::getenv("STC_UPDATE_PICTURES") != nullptr) std::ofstream(expected) << svg;
      EXPECT_EQ(svg, read_file(expected)) << expected;
      expect_well_formed(svg);
      ++seen;
    }
  }
  EXPECT_GE(seen, 14u);
}

TEST(Pictures, NeedNothingFromElsewhere) {
  std::string svg =
      picture(read_file(tests::source_path("tests/unit/draw/pictures/boxes.st")), nullptr);
  EXPECT_EQ(svg.find("href"), std::string::npos);
  EXPECT_EQ(svg.find("url("), std::string::npos);
  EXPECT_EQ(svg.find("@import"), std::string::npos);
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(svg.find("http", svg.find('>')), std::string::npos) << "behind the name of the format";
  EXPECT_NE(svg.find("viewBox"), std::string::npos);
  EXPECT_NE(svg.find("prefers-color-scheme:dark"), std::string::npos);
}

TEST(Pictures, TextIsEscaped) {
  std::string svg =
      picture(ladder("(* </text><script>\"&\x01 *)\n|--[ a < b ]--( x )--|\n"), nullptr);
  EXPECT_NE(svg.find("&lt;/text&gt;&lt;script&gt;&quot;&amp; "), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  expect_well_formed(svg);
  // Latin-1 becomes UTF-8.
  svg = picture(ladder("|--[ T\xFCr ]--( x )--|\n"), nullptr);
  EXPECT_NE(svg.find("T\xC3\xBCr"), std::string::npos);
}

size_t count(const std::string& svg, const char* what) {
  size_t found = 0;
  for (size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
  return found;
}

TEST(Pictures, ABridgeHasRailsAndDotsWhereWiresMeet) {
  std::string svg = picture(ladder("|-[a]-+-[y]-------+-(x)\n"
                                   "      +-[a]-+     |\n"
                                   "|-[b]-------+-[x]-+\n"),
                            nullptr);
  EXPECT_EQ(count(svg, "class=\"r\""), 2u) << "rails";
  EXPECT_EQ(count(svg, "<circle class=\"d\""), 3u) << "one branch that parts, two that meet";
  EXPECT_EQ(svg.find("TRUE"), std::string::npos) << "power is a wire";
  expect_well_formed(svg);
}

TEST(Pictures, LongRungsGoOnBelowWhereTheSameNumberStands) {
  const std::string rung = ladder("|--[ a ]--[ b ]--[ c ]--[ d ]--[ e ]--( x )--|\n");
  const std::string whole = picture(rung, nullptr);
  EXPECT_EQ(count(whole, "class=\"tn\""), 0u);
  const std::string wrapped = picture(rung, nullptr, true, 200);
  EXPECT_EQ(count(wrapped, ">1</text>"), 3u) << "of the network, of the arrow and where it goes on";
  EXPECT_EQ(count(wrapped, ">2</text>"), 2u);
  EXPECT_EQ(count(wrapped, "class=\"r\""), 2u) << "rails at its begin and its end";
  // Each strip has one column at least.
  EXPECT_EQ(count(picture(rung, nullptr, true, 1), "<path class=\"d\""), 2 * 5u);
  expect_well_formed(wrapped);
}

TEST(Pictures, OperandsHaveTheirAddressAndComment) {
  const std::string source =
      "PROGRAM p\nVAR\n  a AT %IX0.3 : BOOL;  // left\n  x : BOOL;\nEND_VAR\nLADDER\n"
      "|--[ a ]--( x )--|\nEND_LADDER\nEND_PROGRAM\n";
  const std::string svg = picture(source, nullptr);
  EXPECT_NE(svg.find(">%IX0.3</text>"), std::string::npos);
  EXPECT_NE(svg.find(">left</text>"), std::string::npos);
  EXPECT_EQ(count(picture(source, nullptr, false), "class=\"tn\""), 0u);
}

TEST(Pictures, ADisabledRungIsPaleAndHasNoPower) {
  Live live("p");
  live.set("p.a", "TRUE");
  const std::string rung = "{network 'Lamp' disabled}\n|--[ a ]--( x )--|\n";
  const std::string svg = picture(ladder(rung), &live);
  EXPECT_EQ(count(svg, "<g class=\"x\">"), 1u);
  EXPECT_NE(svg.find(">Lamp</text>"), std::string::npos);
  EXPECT_NE(svg.find(">disabled</text>"), std::string::npos);
  EXPECT_EQ(count(svg, "\"l on\""), 0u);
}

TEST(Pictures, BoxesHaveTheNumberOfTheirTurn) {
  const std::string svg = picture(
      "PROGRAM p\nFBD\n  WIRE s := ADD(a, 1);\n  b := s;\n  c := s;\n  WIRE t := MUL(b, c);\n"
      "  d := t;\nEND_FBD\nEND_PROGRAM\n",
      nullptr);
  EXPECT_EQ(count(svg, "class=\"tn\">1</text>"), 1u);
  EXPECT_EQ(count(svg, "class=\"tn\">2</text>"), 1u);
}

TEST(Pictures, PowerIsColouredAsFarAsItIsKnown) {
  Live live("p");
  live.set("p.a", "TRUE");
  live.set("p.b", "FALSE");
  std::string on = picture(ladder("|--[ a ]--( x )--|\n"), &live);
  EXPECT_GT(count(on, "\"l on\""), 5u);
  EXPECT_EQ(count(on, "\"l of\""), 0u);
  std::string off = picture(ladder("|--[ b ]--( x )--|\n"), &live);
  EXPECT_GT(count(off, "\"l of\""), 3u);
  // Nobody has read `c`, and an edge cannot be seen: neither on nor off behind them.
  std::string unknown = picture(ladder("|--[ c ]--( x )--|\n"), &live);
  std::string edge = picture(ladder("|--[P a ]--( x )--|\n"), &live);
  EXPECT_EQ(count(unknown, "\"l of\""), 0u);
  EXPECT_EQ(count(edge, "\"l of\""), 0u);
  EXPECT_EQ(count(unknown, "\"l on\""), 4u) << "from the rail to the contact";
}

}  // namespace
}  // namespace frontend::draw
