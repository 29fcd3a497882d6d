// Charts as parts beside and below each other; every step and transition in exactly one place.
#include "frontend/draw/chart_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "frontend/parse/parse.h"

namespace frontend::draw {
namespace {

struct Drawn {
  std::string text;
  std::map<std::string, int> seen;
};

std::string print(const sfc::Net& net, const Sequence& sequence, Drawn& drawn);

std::string print(const sfc::Net& net, const Part& part, Drawn& drawn) {
  auto step = [&] { return std::string(net.steps[part.number].decl->name.text); };
  auto transition = [&] { return std::string(net.transitions[part.number].decl->name.text); };
  switch (part.kind) {
    case PartKind::kStep:
      ++drawn.seen[step()];
      return step();
    case PartKind::kTransition:
      ++drawn.seen[transition()];
      return transition();
    case PartKind::kJump:
      return ">" + step();
    case PartKind::kJoin:
      return "&" + transition();
    case PartKind::kWaits:
      return "waits";
    default:
      break;
  }
  bool both = part.kind == PartKind::kSimultaneous;
  std::string out = both ? "{" : "[";
  for (size_t b = 0; b < part.branches.size(); ++b) {
    if (b != 0) out += both ? " & " : " | ";
    out += print(net, part.branches[b], drawn) + (part.meets[b] ? "" : "!");
  }
  return out + (both ? "}" : "]");
}

std::string print(const sfc::Net& net, const Sequence& sequence, Drawn& drawn) {
  std::string out;
  for (const Part& part : sequence) out += (out.empty() ? "" : " ") + print(net, part, drawn);
  return out;
}

// `links`: name, from and to of each transition; the first step is the initial one.
std::string parts(std::initializer_list<std::array<const char*, 3>> links) {
  std::string source = "PROGRAM p\n";
  std::vector<std::string> steps;
  auto add = [&](std::string names) {
    std::erase_if(names, [](char c) { return c == '(' || c == ')' || c == ' '; });
    for (size_t at = 0; at <= names.size();) {
      size_t end = std::min(names.find(',', at), names.size());
      std::string name = names.substr(at, end - at);
      if (std::find(steps.begin(), steps.end(), name) == steps.end()) steps.push_back(name);
      at = end + 1;
    }
  };
  for (const auto& link : links) {
    add(link[1]);
    add(link[2]);
  }
  for (size_t s = 0; s < steps.size(); ++s) {
    source += (s == 0 ? "INITIAL_STEP " : "STEP ") + steps[s] + ": END_STEP\n";
  }
  for (const auto& [name, from, to] : links) {
    source += std::string("TRANSITION ") + name + " FROM " + from + " TO " + to +
              " := TRUE; END_TRANSITION\n";
  }
  base::SourceMap sources;
  sources.add("a.st", source + "END_PROGRAM\n");
  base::Diagnostics diagnostics;
  Tree tree;
  parse(sources, 0, tree, diagnostics);
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.all()[0].text << source;
  sfc::Net net = sfc::resolve(tree.charts[0]);
  Drawn drawn;
  std::string out;
  for (const Sequence& sequence : chart_parts(net)) {
    out += (out.empty() ? "" : " ; ") + print(net, sequence, drawn);
  }
  for (const std::string& step : steps) EXPECT_EQ(drawn.seen[step], 1) << step;
  for (const auto& link : links) EXPECT_EQ(drawn.seen[link[0]], 1) << link[0];
  return out;
}

TEST(ChartParts, SequenceAndLoop) {
  EXPECT_EQ(parts({{"t", "A", "B"}, {"u", "B", "A"}}), "A t B u >A");
}

TEST(ChartParts, AlternativesMeet) {
  EXPECT_EQ(
      parts({{"t", "A", "B"}, {"u", "A", "C"}, {"v", "B", "D"}, {"w", "C", "D"}, {"x", "D", "A"}}),
      "A [t B v | u C w] D x >A");
}

TEST(ChartParts, AnAlternativeThatLeadsBack) {
  EXPECT_EQ(parts({{"t", "A", "B"}, {"u", "B", "C"}, {"v", "B", "A"}, {"w", "C", "A"}}),
            "A t B [u C w >A! | v >A!]");
}

TEST(ChartParts, SimultaneousBranchesMeet) {
  EXPECT_EQ(parts({{"t", "A", "(B, C)"}, {"u", "B", "D"}, {"v", "(D, C)", "E"}, {"w", "E", "A"}}),
            "A t {B u D & C} v E w >A");
}

TEST(ChartParts, AWayOutOfASimultaneousBranchIsAnArrow) {
  EXPECT_EQ(parts({{"t", "A", "(B, C)"},
                   {"u", "B", "D"},
                   {"v", "C", "E"},
                   {"w", "D", "A"},
                   {"x", "E", "A"}}),
            "A t {B u D w >A! & C v E x >A!}");
}

TEST(ChartParts, JoinsOfDifferentBranchesStandApart) {
  EXPECT_EQ(parts({{"t", "A", "(B, C, D)"}, {"u", "(B, C)", "E"}, {"v", "(E, D)", "A"}}),
            "A t {B & C & D &v!} u E &v ; waits v >A");
}

TEST(ChartParts, AJumpIntoAnotherAlternative) {
  EXPECT_EQ(parts({{"t", "A", "B"},
                   {"u", "A", "C"},
                   {"v", "B", "D"},
                   {"w", "B", "C"},
                   {"x", "C", "D"},
                   {"y", "D", "A"}}),
            "A [t B [v | w >C!] | u C x] D y >A");
}

TEST(ChartParts, WhatNothingLeadsToStandsApart) {
  EXPECT_EQ(parts({{"t", "A", "B"}, {"u", "C", "B"}}), "A t >B ; B ; C u >B");
}

}  // namespace
}  // namespace frontend::draw
