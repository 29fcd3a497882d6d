// Random ladder, written as ladder and as function block diagram: all do the same, scan by scan.
// Coils write what contacts read, so the order in which both happen counts.
#include <gtest/gtest.h>

#include <random>

#include "frontend/fbd/read.h"
#include "frontend/ladder/read.h"
#include "frontend/network/same.h"
#include "frontend/network/write.h"
#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

using frontend::network::Body;
using frontend::network::Element;
using frontend::network::Kind;
using frontend::network::Link;
using frontend::network::Modifier;

constexpr int kVariables = 8;
constexpr const char* kVars =
    "a, b, c, d, e, f, g, h : BOOL; n, m : INT; t : TON; k : CTU; full : BOOL; x : TIME;";

class RandomLadder {
 public:
  explicit RandomLadder(uint32_t seed) : random_(seed) {}

  Body make() {
    for (uint32_t rungs = 1 + pick(4); rungs > 0; --rungs) {
      body_.networks.emplace_back();
      Element rail;
      rail.kind = Kind::kLeftRail;
      rail.outputs.resize(1);
      elements().push_back(rail);
      series({{0, 0}}, 0, true);
    }
    return body_;
  }
  uint32_t pick(uint32_t count) { return random_() % count; }

 private:
  std::vector<Element>& elements() { return body_.networks.back().elements; }
  std::string variable() { return std::string(1, static_cast<char>('a' + pick(kVariables))); }

  uint32_t add(Kind kind, std::string operand, Modifier modifier, const std::vector<Link>& from) {
    Element element;
    element.kind = kind;
    element.operand.text = std::move(operand);
    element.modifier = modifier;
    element.inputs.resize(1);
    element.inputs[0].from = from;
    element.outputs.resize(1);
    elements().push_back(std::move(element));
    return static_cast<uint32_t>(elements().size() - 1);
  }
  std::vector<Link> contact(const std::vector<Link>& from) {
    static const char* const kExpressions[] = {"n > 3", "a OR b", "m <> n", "NOT c"};
    std::string operand = pick(4) == 0 ? kExpressions[pick(4)] : variable();
    bool edge = pick(5) == 0 && operand.size() == 1;
    Modifier modifier = static_cast<Modifier>(edge ? 2 + pick(2) : pick(2));
    return {{add(Kind::kContact, operand, modifier, from), 0}};
  }
  // n := n + 1, with EN and ENO.
  std::vector<Link> count(const std::vector<Link>& from) {
    std::string to = pick(2) == 0 ? "n" : "m";
    Element source;
    source.kind = Kind::kSource;
    source.operand.text = to + " + 1";
    source.outputs.resize(1);
    elements().push_back(source);
    auto number = static_cast<uint32_t>(elements().size());
    Element move;
    move.kind = Kind::kBlock;
    move.type.text = "MOVE";
    move.inputs.resize(2);
    move.inputs[0].name = "EN";
    move.inputs[0].from = from;
    move.inputs[1].from = {{number - 1, 0}};
    move.outputs = {{"", false}, {"ENO", false}};
    elements().push_back(move);
    add(Kind::kSink, to, Modifier::kNone, {{number, 0}});
    return {{number, 1}};
  }

  std::vector<Link> series(std::vector<Link> from, uint32_t depth, bool ends) {
    bool forked = false;
    for (uint32_t length = 1 + pick(3); length > 0; --length) {
      if (depth >= 3 || forked || pick(3) != 0) {
        from = pick(7) == 0 ? count(from) : contact(from);
        forked = false;
        continue;
      }
      std::vector<Link> met;
      for (uint32_t b = 2 + pick(2); b > 0; --b) {
        for (Link link : series(from, depth + 1, false)) met.push_back(link);
      }
      from = met;
      forked = true;
    }
    if (!ends) return from;
    if (depth < 2 && !forked && pick(3) == 0) {
      for (uint32_t b = 2; b > 0; --b) series(from, depth + 1, true);
      return {};
    }
    for (uint32_t coils = 1 + pick(2); coils > 0; --coils) {
      from = {{add(Kind::kCoil, variable(), static_cast<Modifier>(pick(6)), from), 0}};
    }
    return {};
  }

  std::mt19937 random_;
  Body body_;
};

std::string state(Controlled& program) {
  std::string out;
  for (int v = 0; v < kVariables; ++v) {
    out += std::to_string(program.number(std::string("P.") + static_cast<char>('a' + v)));
  }
  return out + ' ' + std::to_string(program.number("P.n")) + ' ' +
         std::to_string(program.number("P.m"));
}

TEST(DiagramText, LadderAndItsBoxesDoTheSame) {
  uint32_t compared = 0;
  for (uint32_t seed = 1; seed <= 150; ++seed) {
    RandomLadder random(seed);
    Body body = random.make();
    std::optional<std::string> ladder = frontend::network::write_ladder(body, 2);
    std::string boxes = frontend::network::write_fbd(body, 2);
    ASSERT_TRUE(ladder.has_value()) << seed;
    Controlled drawn(kVars, "LADDER\n" + *ladder + "END_LADDER");
    Controlled listed(kVars, "FBD\n" + boxes + "END_FBD");
    ASSERT_EQ(drawn.problem(), "") << *ladder;
    ASSERT_EQ(listed.problem(), "") << boxes;
    for (int scan = 0; scan < 12; ++scan) {
      for (int v = 0; v < kVariables; ++v) {
        if (random.pick(4) != 0) continue;
        std::string path = std::string("P.") + static_cast<char>('a' + v);
        int64_t value = random.pick(2);
        drawn.set(path, value);
        listed.set(path, value);
      }
      ASSERT_EQ(drawn.scan(), "");
      ASSERT_EQ(listed.scan(), "");
      ASSERT_EQ(state(drawn), state(listed)) << seed << '\n' << *ladder << boxes;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 150u * 12);
}

// What is written of boxes is read as the same boxes.
TEST(DiagramText, BoxesComeBackAsTheyWere) {
  const std::string rows =
      "  (* holds *)\n"
      "  t : TON(IN := [/ a OR b], PT := T#1s);\n"
      "  WIRE low := LT(n, 20);\n"
      "  WIRE both := AND(t.Q, low, NOT c, [P d]);\n"
      "  e := NOT both;\n"
      "  f S= both;\n"
      "  g R= low;\n"
      "  JMP Quiet IF both;\n"
      "  RETURN IF [/ a OR b];\n"
      "  RETURN;\n"
      "\n"
      "  Quiet:\n"
      "  k : CTU(CU := both2, R := k.Q, PV := 10);\n"
      "  h := k.Q;\n";
  base::Diagnostics diagnostics;
  Body body = frontend::fbd::read(rows, base::SourcePos{0}, diagnostics);
  ASSERT_TRUE(diagnostics.all().empty()) << diagnostics.all()[0].text;
  EXPECT_EQ(frontend::network::write_fbd(body, 2), rows);
}

// A name that is taken is no wire's; expressions say the new one.
TEST(DiagramText, WiresOfExpressionsGetTheirNewNames) {
  const std::string rows =
      "WIRE low := LT(EN := b, n, 20);\n"
      "r := MAX(low, low * 2, n.low, F(low := low)) + E#low + low.ENO;\n";
  base::Diagnostics diagnostics;
  Body body = frontend::fbd::read(rows, base::SourcePos{0}, diagnostics);
  ASSERT_TRUE(diagnostics.all().empty()) << diagnostics.all()[0].text;
  EXPECT_EQ(frontend::network::write_fbd(body, 0), rows);
  EXPECT_EQ(frontend::network::write_fbd(body, 0, "low"),
            "WIRE lt1 := LT(EN := b, n, 20);\n"
            "r := MAX(lt1, lt1 * 2, n.low, F(low := lt1)) + E#low + lt1.ENO;\n");
}

// Bodies with the same expressions of other wires are not the same.
TEST(DiagramText, ExpressionsAreComparedByTheirWires) {
  const auto meaning = [](const std::string& rows) {
    base::Diagnostics diagnostics;
    return frontend::network::canonical(frontend::fbd::read(rows, base::SourcePos{0}, diagnostics));
  };
  const std::string boxes = "WIRE a := ADD(x, 1); WIRE b := SUB(x, 1);";
  EXPECT_EQ(meaning(boxes + "y := 2*a;"), meaning(boxes + "y := 2 * A;"));
  EXPECT_NE(meaning(boxes + "y := 2 * a;"), meaning(boxes + "y := 2 * b;"));
  EXPECT_EQ(meaning(boxes + "y := 2 * a;"),
            meaning("WIRE c := ADD(x, 1); WIRE d := SUB(x, 1); y := 2 * c;"));
}

}  // namespace
}  // namespace frontend_test
