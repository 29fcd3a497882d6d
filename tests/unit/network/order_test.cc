// Order of execution and division into networks of what a drawing says.
#include "frontend/network/order.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace frontend::network {
namespace {

Element element(Kind kind, const std::string& operand, int32_t x, int32_t y) {
  Element out;
  out.kind = kind;
  out.operand.text = operand;
  out.position = {x, y, 0, 10, true};
  if (kind != Kind::kSource && kind != Kind::kLeftRail) out.inputs.resize(1);
  if (kind != Kind::kSink) out.outputs.resize(1);
  return out;
}

// A function when `operand` is empty.
Element block(const std::string& type, const std::string& operand, int32_t x, int32_t y) {
  Element out = element(Kind::kBlock, operand, x, y);
  out.type.text = type;
  return out;
}

void link(Network& network, uint32_t from, uint32_t to) {
  network.elements[to].inputs[0].from.push_back({from, 0});
}

std::string name_of(const Element& element) {
  if (element.kind == Kind::kLeftRail) return "|";
  return element.operand.empty() ? element.type.text : element.operand.text;
}

std::string ordered(Network network, std::vector<Precedence> precedences = {}) {
  std::vector<uint32_t> loop = order(network, precedences);
  std::string out = loop.empty() ? "" : "loop:";
  for (uint32_t i : loop) out += " " + name_of(network.elements[i]);
  if (!loop.empty()) return out;
  for (const Element& each : network.elements) out += name_of(each) + " ";
  return out;
}

TEST(Order, AlongDataThenDownThenRight) {
  Network network;
  network.elements = {element(Kind::kCoil, "c", 30, 0), element(Kind::kContact, "b", 20, 0),
                      element(Kind::kContact, "d", 10, 20), element(Kind::kContact, "a", 10, 0),
                      element(Kind::kLeftRail, "", 0, 0)};
  link(network, 4, 3);
  link(network, 4, 2);
  link(network, 3, 1);
  link(network, 1, 0);
  link(network, 2, 0);
  EXPECT_EQ(ordered(network), "| a b d c ");
  // Links follow their elements.
  ASSERT_TRUE(order(network, {}).empty());
  EXPECT_EQ(network.elements[4].inputs[0].from, (std::vector<Link>{{2, 0}, {3, 0}}));
  EXPECT_EQ(network.elements[1].inputs[0].from, (std::vector<Link>{{0, 0}}));
}

TEST(Order, WhatABoxGivesIsWrittenAtOnce) {
  Network network;
  network.elements = {element(Kind::kSink, "v", 50, 30), block("ADD", "", 10, 0),
                      block("SUB", "", 10, 10)};
  link(network, 1, 0);
  EXPECT_EQ(ordered(network), "ADD v SUB ");
}

TEST(Order, IdsOfExecutionGoFirst) {
  Network network;
  network.elements = {block("ADD", "one", 0, 0), block("SUB", "two", 10, 0)};
  link(network, 0, 1);
  network.elements[0].order = 7;
  network.elements[1].order = 3;
  EXPECT_EQ(ordered(network), "two one ");  // `two` gets what `one` gave in the last scan
  network.elements[0].operand.text.clear();
  EXPECT_EQ(ordered(network), "loop: ADD two");  // a function keeps nothing
}

TEST(Order, LoopsAreCutAtInstances) {
  Network network;
  network.elements = {block("T", "left", 0, 10), block("T", "right", 50, 10),
                      element(Kind::kSink, "out", 0, 0), block("NOT", "", 25, 10)};
  link(network, 0, 3);
  link(network, 3, 1);
  link(network, 1, 0);
  link(network, 1, 2);
  // Upwards in the drawing; what is not in the loop is not cut.
  EXPECT_EQ(ordered(network), "left NOT right out ");
  // A block that feeds itself.
  Network self;
  self.elements = {block("T", "t", 0, 0)};
  link(self, 0, 0);
  EXPECT_EQ(ordered(self), "t ");
}

TEST(Order, LoopsOfFunctionsAreRefused) {
  Network network;
  network.elements = {block("ADD", "", 0, 0), block("MUL", "", 10, 0), block("T", "t", 20, 0)};
  link(network, 0, 1);
  link(network, 1, 0);
  link(network, 1, 2);
  EXPECT_EQ(ordered(network), "loop: ADD MUL");
  Network self;
  self.elements = {block("ADD", "", 0, 0)};
  link(self, 0, 0);
  EXPECT_EQ(ordered(self), "loop: ADD");
}

TEST(Order, PrecedencesCount) {
  Network network;
  network.elements = {element(Kind::kSource, "v", 0, 0), block("F", "f", 0, 10)};
  EXPECT_EQ(ordered(network), "v f ");
  EXPECT_EQ(ordered(network, {{1, 0}}), "f v ");
}

// A chain in which each block also feeds the one before it: linear, and to the right.
TEST(Order, LongLoopsTakeNoTime) {
  Network network;
  constexpr uint32_t kCount = 20000;
  for (uint32_t i = 0; i < kCount; ++i) {
    network.elements.push_back(block("T", "t" + std::to_string(i), static_cast<int32_t>(i), 0));
  }
  for (uint32_t i = 1; i < kCount; ++i) {
    link(network, i - 1, i);
    link(network, i, i - 1);
  }
  std::reverse(network.elements.begin(), network.elements.end());
  for (Element& each : network.elements) {
    for (Link& from : each.inputs[0].from) from.element = kCount - 1 - from.element;
  }
  ASSERT_TRUE(order(network, {}).empty());
  EXPECT_EQ(network.elements.front().operand.text, "t0");
  EXPECT_EQ(network.elements.back().operand.text, "t19999");
}

TEST(Split, RailsConnectNothing) {
  Network all;
  all.elements = {element(Kind::kLeftRail, "", 0, 0),   element(Kind::kCoil, "low", 30, 50),
                  element(Kind::kContact, "a", 10, 50), element(Kind::kCoil, "high", 30, 0),
                  element(Kind::kContact, "b", 10, 10), element(Kind::kRightRail, "", 40, 0)};
  link(all, 0, 2);
  link(all, 2, 1);
  link(all, 0, 4);
  link(all, 4, 3);
  link(all, 1, 5);
  link(all, 3, 5);
  std::vector<Part> parts = split(all, {});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].from, (std::vector<uint32_t>{0, 3, 4, 5}));
  EXPECT_EQ(parts[1].from, (std::vector<uint32_t>{0, 1, 2, 5}));
  EXPECT_EQ(parts[0].network.elements[2].inputs[0].from, (std::vector<Link>{{0, 0}}));
  EXPECT_EQ(parts[0].network.elements[1].inputs[0].from, (std::vector<Link>{{2, 0}}));
  EXPECT_EQ(parts[1].network.elements[3].inputs[0].from, (std::vector<Link>{{1, 0}}));
  EXPECT_EQ(ordered(parts[1].network), "| a low  ");
}

TEST(Split, IdsOfExecutionGoBeforePlaces) {
  Network all;
  all.elements = {element(Kind::kSink, "third", 0, 0), element(Kind::kSink, "first", 0, 40),
                  block("T", "second", 0, 90)};
  all.elements[0].order = 3;
  all.elements[1].order = 1;
  EXPECT_EQ(split(all, {})[0].network.elements[0].operand.text, "third");  // one has none
  all.elements[2].order = 2;
  std::vector<Part> parts = split(all, {});
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].network.elements[0].operand.text, "first");
  EXPECT_EQ(parts[2].network.elements[0].operand.text, "third");
  // Executed in turns: one network.
  all.elements.push_back(element(Kind::kContact, "fourth", 0, 200));
  all.elements[3].order = 4;
  link(all, 3, 1);
  parts = split(all, {});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(ordered(parts[0].network),
            "loop: third first second fourth");  // ids against the flow of data
}

TEST(Split, PrecedencesKeepTogether) {
  Network all;
  all.elements = {element(Kind::kSink, "v", 0, 0), element(Kind::kSource, "v", 0, 90),
                  element(Kind::kSink, "w", 0, 40)};
  const std::vector<Precedence> precedences = {{0, 1}};
  std::vector<Part> parts = split(all, precedences);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].from, (std::vector<uint32_t>{0, 1}));
  ASSERT_EQ(parts[0].precedences.size(), 1u);
  EXPECT_EQ(parts[0].precedences[0].second, 1u);
  EXPECT_TRUE(parts[1].precedences.empty());
}

TEST(Split, WhatIsLinkedToNothingGoesByItsPlace) {
  Network all;
  all.elements = {element(Kind::kSink, "v", 0, 0), element(Kind::kSink, "w", 0, 40)};
  std::vector<int32_t> ends = ends_of(split(all, {}));
  EXPECT_EQ(ends, (std::vector<int32_t>{10, 50}));
  EXPECT_EQ(place_between(ends, -5), 0u);
  EXPECT_EQ(place_between(ends, 10), 0u);
  EXPECT_EQ(place_between(ends, 11), 1u);
  EXPECT_EQ(place_between(ends, 90), 1u);
  EXPECT_EQ(place_between({}, 90), 0u);
}

}  // namespace
}  // namespace frontend::network
