// Ladder as `stc fmt` draws it: read, written, and read again.
#include <gtest/gtest.h>

#include <random>

#include "frontend/ladder/read.h"
#include "frontend/network/layout.h"
#include "frontend/network/same.h"
#include "frontend/network/write.h"

namespace frontend::network {
namespace {

Body read(const std::string& text) {
  base::Diagnostics diagnostics;
  Body body = ladder::read(text, base::SourcePos{0}, diagnostics);
  for (const base::Diagnostic& one : diagnostics.all()) ADD_FAILURE() << one.text << "\n" << text;
  return body;
}

// Drawn twice: the second time nothing changes, and it means the same.
std::string drawn(const std::string& text) {
  Body body = read(text);
  std::optional<std::string> out = write_ladder(body, 0);
  if (!out) return "no ladder";
  Body again = read(*out);
  EXPECT_EQ(canonical(again), canonical(body)) << *out;
  EXPECT_EQ(write_ladder(again, 0).value_or(""), *out);
  return *out;
}

// A row of 60 columns.
std::string rung(const std::string& left, const std::string& right) {
  size_t bytes = left.size() + right.size();
  for (char c : left) bytes -= (static_cast<uint8_t>(c) & 0xC0) == 0x80 ? 1 : 0;
  return left + std::string(60 - bytes, '-') + right;
}

TEST(LadderText, RailsAndCoilsStandInOneColumn) {
  EXPECT_EQ(drawn("|-[Start]-+-[/Stop]-(Run)-|\n"
                  "|-[Run]---+\n"
                  "|-[Run]-(S Lamp)\n"),
            rung("|--[ Start ]--+--[/ Stop ]", "( Run )--|") + "\n" +
                "|--[ Run ]----+\n"
                "\n" +
                rung("|--[ Run ]", "(S Lamp )--|") + "\n");
}

TEST(LadderText, AWideRungDoesNotMoveTheOthers) {
  std::string name(60, 'x');
  EXPECT_EQ(drawn("|-[a]-(b)-|\n"
                  "|-[ " +
                  name + " ]-[" + name + "]-(c)-|\n"),
            rung("|--[ a ]", "( b )--|") + "\n" +
                "\n"
                "|--[ " +
                name + " ]--[ " + name + " ]--( c )--|\n");
}

TEST(LadderText, BranchesEndAtTheRailEachForItself) {
  EXPECT_EQ(
      drawn("|-+-[a]-(x)-|\n"
            "  +-[b]-(y)-(/z)-|\n"),
      rung("|--+--[ a ]", "( x )--|") + "\n" + rung("|  +--[ b ]", "( y )--(/ z )--|") + "\n");
}

TEST(LadderText, NestedBranches) {
  EXPECT_EQ(drawn("|-[a]-+-[b]-+-[c]-+-+-(q)-|\n"
                  "      |     +-[d]-+ |\n"
                  "      +-[e]---------+\n"),
            rung("|--[ a ]--+--[ b ]--+--[ c ]--+", "( q )--|") + "\n" +
                "|         |         +--[ d ]--+\n"
                "|         +--[ e ]------------+\n");
}

// Joints of two branches would touch: a row stands between them.
TEST(LadderText, BranchesThatWouldTouchAreSetApart) {
  EXPECT_EQ(drawn("|-+-[a]-+-[b]-+-[c]-+-(q)-|\n"
                  "  |     +-[d]-+     |\n"
                  "  |                 |\n"
                  "  +-[e]-+-[f]-+-[g]-+\n"
                  "        +-[h]-+\n"),
            rung("|--[ a ]--+--[ b ]--+--[ c ]--+", "( q )--|") + "\n" +
                "|         +--[ d ]--+         |\n"
                "|                             |\n"
                "|--[ e ]--+--[ f ]--+--[ g ]--+\n"
                "|         +--[ h ]--+\n");
}

TEST(LadderText, Boxes) {
  EXPECT_EQ(drawn("|-[a]-[t1:TON(IN:=_,PT:=T#5s,ET=>e)]-[v:=MAX(EN:=_,a,[/b+c])]-(q)-|\n"),
            "|--[ a ]--[ t1: TON  IN:=_, PT:=T#5s, ET=>e ]--[ v := MAX(a, [/ b+c]) ]--( q )--|\n");
  EXPECT_EQ(
      drawn("|-[a]-[v:=x]-[w:=MOVE(F(x))]-[F(EN:=_,=>v,R=>NOT u,ENO=>_)]-(RETURN)-|\n"),
      "|--[ a ]--[ v := x ]--[ w := MOVE(F(x)) ]--[ F(EN:=_, =>v, R=>NOT u) ]--( RETURN )--|\n");
  EXPECT_EQ(drawn("|-[a]-[LT(_,b)]-[c1:CTU R:=_,CV=>n,QD=>_]-(JMP L)-|\nL:\n"),
            "|--[ a ]--[ LT(_, b) ]--[ c1: CTU  R:=_, CV=>n, QD=>_ ]--( JMP L )--|\n\nL:\n");
}

TEST(LadderText, CommentsAndLabels) {
  EXPECT_EQ(drawn("(* one\n      two *)\n"
                  "L :\n"
                  "// a *) b\n"
                  "|-[a]-(b)-|  // behind\n"
                  "(* last *)\n"),
            "(* one\n   two *)\n"
            "// a *) b\n"
            "(* behind *)\n"
            "L:\n" +
                rung("|--[ a ]", "( b )--|") + "\n" +
                "\n"
                "(* last *)\n");
}

TEST(LadderText, ColumnsAreCharacters) {
  EXPECT_EQ(drawn("|-[T\xC3\xBCr]-+-(x)-|\n"
                  "|-[abc]-+\n"),
            rung("|--[ T\xC3\xBCr ]--+", "( x )--|") + "\n" + "|--[ abc ]--+\n");
  EXPECT_EQ(drawn("|-[T\xFCr]-+-(x)-|\n"
                  "|-[abc]-+\n"),
            rung("|--[ T\xFCr ]--+", "( x )--|") + "\n" + "|--[ abc ]--+\n");
}

Element element(Kind kind, const std::string& operand, std::vector<Link> from) {
  Element out;
  out.kind = kind;
  out.operand.text = operand;
  out.inputs.resize(1);
  out.inputs[0].from = std::move(from);
  out.outputs.resize(1);
  return out;
}

Body one_rung(std::vector<Element> elements) {
  Body body;
  body.networks.resize(1);
  Element rail;
  rail.kind = Kind::kLeftRail;
  rail.outputs.resize(1);
  body.networks[0].elements = {rail};
  for (Element& one : elements) body.networks[0].elements.push_back(std::move(one));
  return body;
}

TEST(LadderText, WhatIsNoSeriesAndParallelRungIsRefused) {
  // x gets power from a, y from a or b: a tap inside of a branch.
  Body tap =
      one_rung({element(Kind::kContact, "a", {{0, 0}}), element(Kind::kContact, "b", {{0, 0}}),
                element(Kind::kCoil, "x", {{1, 0}}), element(Kind::kCoil, "y", {{1, 0}, {2, 0}})});
  EXPECT_FALSE(place(tap.networks[0]).has_value());
  EXPECT_FALSE(write_ladder(tap, 0).has_value());
  // A bridge.
  Body bridge = one_rung(
      {element(Kind::kContact, "a", {{0, 0}}), element(Kind::kContact, "b", {{0, 0}}),
       element(Kind::kContact, "c", {{1, 0}}), element(Kind::kContact, "d", {{1, 0}, {2, 0}}),
       element(Kind::kCoil, "x", {{3, 0}, {4, 0}})});
  EXPECT_FALSE(place(bridge.networks[0]).has_value());
  EXPECT_FALSE(place(one_rung({element(Kind::kCoil, "x", {})}).networks[0]).has_value());
}

// Where contacts are read may differ, but for what writes them.
TEST(LadderText, ContactsAreReadOnTheSameSideOfWhatWritesThem) {
  auto rungs = [](const std::string& contact) {
    return one_rung({element(Kind::kContact, "a", {{0, 0}}),
                     element(Kind::kContact, contact, {{0, 0}}),
                     element(Kind::kCoil, "x", {{1, 0}}), element(Kind::kCoil, "y", {{2, 0}})});
  };
  // As text, the second contact is read behind the first coil.
  EXPECT_TRUE(write_ladder(rungs("b"), 0).has_value());
  EXPECT_NE(canonical(rungs("b")), canonical(read(*write_ladder(rungs("b"), 0))));
  for (const char* contact : {"x", "NOT x", "p^", "X.Q", "F(b)", "%IX0.0"}) {
    EXPECT_FALSE(write_ladder(rungs(contact), 0).has_value()) << contact;
  }
}

// 30,000 columns in 1,000 rows: it would be painted in gigabytes, and nobody could read it.
TEST(LadderText, AnEndlessDrawingIsRefused) {
  std::vector<Element> elements;
  for (uint32_t i = 0; i < 3000; ++i) {
    elements.push_back(element(Kind::kContact, "a", {{i, 0}}));
  }
  for (uint32_t i = 0; i < 1000; ++i) {
    elements.push_back(element(Kind::kCoil, "x" + std::to_string(i), {{3000, 0}}));
  }
  EXPECT_FALSE(write_ladder(one_rung(std::move(elements)), 0).has_value());
}

TEST(LadderText, AnOperandThatWouldReadAsSomethingElseIsRefused) {
  for (const char* operand : {"a ] b", "t : TON", "P x", "a := b", "F(_)", "a\nb"}) {
    Body body =
        one_rung({element(Kind::kContact, operand, {{0, 0}}), element(Kind::kCoil, "x", {{1, 0}})});
    EXPECT_FALSE(write_ladder(body, 0).has_value()) << operand;
  }
}

TEST(LadderText, ElementCommentsAreKept) {
  Body body = one_rung({element(Kind::kCoil, "x", {{0, 0}})});
  body.networks[0].elements[1].comments = {"motor"};
  EXPECT_EQ(write_ladder(body, 2).value_or("").substr(0, 15), "  (* motor *)\n ");
}

// Random rungs of nested series and parallel branches.
class RandomRung {
 public:
  explicit RandomRung(uint32_t seed) : random_(seed) {}

  Body make() {
    body_ = one_rung({});
    series({{0, 0}}, 0, true);
    return body_;
  }

 private:
  uint32_t pick(uint32_t count) { return random_() % count; }
  uint32_t add(Kind kind, const std::vector<Link>& from) {
    auto number = static_cast<uint32_t>(body_.networks[0].elements.size());
    auto name = "v" + std::to_string(number) + std::string(pick(6), 'x');
    body_.networks[0].elements.push_back(element(kind, name, from));
    body_.networks[0].elements.back().modifier = static_cast<Modifier>(pick(4));
    return number;
  }
  std::vector<Link> series(std::vector<Link> from, uint32_t depth, bool ends) {
    uint32_t length = 1 + pick(3);
    bool forked = false;
    for (uint32_t i = 0; i < length; ++i) {
      if (depth >= 4 || forked || pick(3) != 0) {
        from = {{add(Kind::kContact, from), 0}};
        forked = false;
        continue;
      }
      std::vector<Link> ends_of;
      for (uint32_t b = 2 + pick(2); b > 0; --b) {
        for (Link link : series(from, depth + 1, false)) ends_of.push_back(link);
      }
      from = ends_of;
      forked = true;
    }
    if (!ends) return from;
    if (depth < 3 && !forked && pick(3) == 0) {
      for (uint32_t b = 2 + pick(2); b > 0; --b) series(from, depth + 1, true);
      return {};
    }
    for (uint32_t c = 1 + pick(2); c > 0; --c) from = {{add(Kind::kCoil, from), 0}};
    return {};
  }

  std::mt19937 random_;
  Body body_;
};

TEST(LadderText, RandomRungsComeBackAsTheyWere) {
  for (uint32_t seed = 1; seed <= 400; ++seed) {
    Body body = RandomRung(seed).make();
    ASSERT_TRUE(place(body.networks[0]).has_value()) << seed << canonical(body);
    std::optional<std::string> text = write_ladder(body, 0);
    ASSERT_TRUE(text.has_value()) << seed << canonical(body);
    EXPECT_EQ(drawn(*text), *text);
  }
}

}  // namespace
}  // namespace frontend::network
