// What an edit costs, counted: bodies that are checked and lowered again.
#include <gtest/gtest.h>
#include <malloc.h>

#include "tests/unit/sanitized.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

// Sources of which one can be exchanged, and their builds.
class Project {
 public:
  explicit Project(std::vector<std::string> texts) : build_(settings_) {
    for (std::string& text : texts) {
      sources_.add("part" + std::to_string(sources_.file_count()) + ".st", std::move(text));
    }
    save(0, std::string(sources_.text(0)));
  }

  void save(uint32_t file, std::string text) {
    sources_.replace(file, std::move(text));
    const workspace::Counts before = build_.counts();
    outcome = test::build_again(build_, sources_);
    EXPECT_TRUE(outcome == test::build_from_nothing(sources_, settings_))
        << outcome.messages << outcome.refusal;
    whole = build_.counts().whole - before.whole;
    lowered = build_.counts().lowered - before.lowered;
  }
  // The one place where `from` stands becomes `to`.
  void edit(uint32_t file, const std::string& from, const std::string& to) {
    std::string text(sources_.text(file));
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    save(file, text.replace(at, from.size(), to));
  }
  std::string text(uint32_t file) const { return std::string(sources_.text(file)); }

  test::Outcome outcome;
  uint64_t whole = 0;  // by the last save
  uint64_t lowered = 0;

 private:
  workspace::Settings settings_;
  base::SourceMap sources_;
  workspace::IncrementalBuild build_;
};

constexpr const char* kBlocks = R"(FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
  Twice := x + x;
END_FUNCTION

FUNCTION_BLOCK Motor
VAR_INPUT Start : BOOL; END_VAR
VAR_OUTPUT Speed : INT; Text : STRING[20]; END_VAR
VAR Step : INT; END_VAR
METHOD Faster : BOOL
  Speed := Twice(Speed);
  Faster := Speed > 100;
END_METHOD
  IF Start THEN
    Step := Step + 1;
    Text := 'running';
  END_IF;
  IF Step > 10 THEN
    Text := 'tired';
    Step := 0;
  END_IF;
END_FUNCTION_BLOCK

FUNCTION_BLOCK Last
VAR n : INT; END_VAR
  n := n + Twice(n) / 3;
END_FUNCTION_BLOCK
)";
constexpr const char* kMain = R"(PROGRAM Main
VAR
  M : Motor;
  L : Last;
END_VAR
  M(Start := TRUE);
  M.Faster();
  L();
END_PROGRAM
)";

TEST(Edits, PerformanceStatementCostsOneBody) {
  Project project({kBlocks, kMain});
  EXPECT_EQ(project.whole, 1u);
  project.edit(0, "Step + 1", "Step + 2");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
  project.edit(1, "TRUE", "FALSE");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
  project.edit(0, "Speed > 100", "Speed > 99");
  EXPECT_EQ(project.lowered, 1u);
}

TEST(Edits, LinesAndCommentsOfABodyCostThatBody) {
  Project project({kBlocks, kMain});
  project.edit(0, "    Step := Step + 1;\n", "\n\n    (* one more *)\n    Step := Step + 1;\n");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
}

// Behind the comment everything has the place that it had, but not the line.
TEST(Edits, ALineInPlaceOfAnotherCharacterMovesLines) {
  std::string blocks = kBlocks;
  blocks.insert(blocks.find("FUNCTION_BLOCK Last"), "(* one two *)\n");
  Project project({blocks, kMain});
  project.edit(0, "(* one two *)", "(* one\ntwo *)");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 0u);
}

TEST(Edits, InlinedFunctionCostsItselfAndWhoHoldsIt) {
  Project project({kBlocks, kMain});
  project.edit(0, "x + x", "x * 2");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 3u);  // Twice, Motor.Faster, Last
}

TEST(Edits, NoEditCostsNothing) {
  Project project({kBlocks, kMain});
  project.save(0, project.text(0));
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 0u);
}

// The image says that the text is another one (E-02), though the code is what it was.
TEST(Edits, E02_AnotherTextWithTheSameCodeIsInTheImage) {
  Project project({kBlocks, kMain});
  project.edit(0, "n + Twice(n) / 3", "(n + (Twice(n) / 3))");
  EXPECT_EQ(project.whole, 0u);
  project.edit(0, "(n + (Twice(n) / 3))", "n + Twice(n) / 3");
  EXPECT_EQ(project.whole, 0u);
}

TEST(Edits, DeclarationsCostEverything) {
  Project project({kBlocks, kMain});
  project.edit(0, "Step : INT", "Step : DINT");
  EXPECT_EQ(project.whole, 1u);
  project.edit(0, "Step : DINT", "Step : INT; more : INT");
  EXPECT_EQ(project.whole, 1u);
  project.edit(0, "Step + 1", "Step + more");
  EXPECT_EQ(project.whole, 0u);
}

TEST(Edits, FirstUseAndLastUseOfAVariableAreReported) {
  Project project({kBlocks, kMain});
  project.edit(0, "n := n + Twice(n) / 3", "Twice(1)");
  EXPECT_NE(project.outcome.messages.find("`n` is never used"), std::string::npos);
  project.edit(0, "Twice(1)", "n := Twice(n)");
  EXPECT_EQ(project.outcome.messages.find("never used"), std::string::npos);
  EXPECT_EQ(project.whole, 0u);
}

TEST(Edits, AfterAMistakeTheNextGoodEditCostsOneBody) {
  Project project({kBlocks, kMain});
  project.edit(0, "Step + 1;", "Step + ;");
  EXPECT_FALSE(project.outcome.image.has_value());
  project.edit(0, "Step + ;", "Step + 3;");
  EXPECT_TRUE(project.outcome.image.has_value());
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
  for (int twice = 0; twice < 2; ++twice) {
    project.edit(0, "Step + 3;", "Step + Missing; Start := 1.5;");
    EXPECT_FALSE(project.outcome.image.has_value());
    project.edit(0, "Step + Missing; Start := 1.5;", "Step + 3;");
    EXPECT_EQ(project.whole, 0u);
  }
  project.edit(0, "Step + 3", "Step + 4");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
}

TEST(Edits, CommentsOutsideOfBodiesCostNothing) {
  Project project(
      {"{attribute 'qualified_only'}\nVAR_GLOBAL g : INT; END_VAR\n" + std::string(kBlocks),
       kMain});
  project.edit(0, "FUNCTION_BLOCK Motor", "(* a\n   motor *)\nFUNCTION_BLOCK Motor  // here");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 0u);
  project.edit(0, "VAR Step : INT;", "\n(* the sequence *)\nVAR  Step:INT;  (* where it is *)");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 0u);
  project.edit(0, "VAR  Step:INT", "VAR  Stop:INT");
  EXPECT_FALSE(project.outcome.image.has_value());
  project.edit(0, "VAR  Stop:INT", "VAR\n\n  Step :\n INT");
  EXPECT_TRUE(project.outcome.image.has_value());
}

TEST(Edits, PragmasAndSpacesThatMatterCostEverything) {
  Project project(
      {"{attribute 'list' := 'G'}\nVAR_GLOBAL g : INT; END_VAR\n" + std::string(kBlocks), kMain});
  project.edit(0, "'G'", "'H'");
  EXPECT_EQ(project.whole, 1u);
  project.edit(0, "g : INT", "g g : INT");
  EXPECT_EQ(project.whole, 1u);
}

TEST(Edits, MoreAndFewerTextsCostOneBody) {
  Project project({kBlocks, kMain,
                   "FUNCTION_BLOCK Other VAR Text : STRING[20]; END_VAR\n"
                   "  Text := 'another';\nEND_FUNCTION_BLOCK\n"});
  project.edit(0, "    Step := 0;\n",
               "    Step := 0;\n    Text := 'rest';\n    Text := 'tired';\n");
  EXPECT_EQ(project.whole, 1u);  // the first text of four letters
  project.edit(0, "    Text := 'rest';\n", "    Text := 'rest';\n    Text := 'calm';\n");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
  project.edit(0, "    Text := 'calm';\n", "");
  EXPECT_EQ(project.whole, 0u);
  project.edit(0, "    Text := 'rest';\n",
               "    Text := 'rest'; Text := 'free'; Step := 1.5 + 'x';\n");
  EXPECT_FALSE(project.outcome.image.has_value());
  project.edit(0, " Text := 'free'; Step := 1.5 + 'x';", "");
  project.edit(2, "'another'", "'a other'");
  EXPECT_EQ(project.lowered, 1u);
}

TEST(Edits, LettersBeyondAsciiCostOneBody) {
  Project project({kBlocks, kMain});
  project.edit(0, "Step + 1;", "Step + 2;  (* l\303\244uft *)");
  EXPECT_EQ(project.whole, 0u);
  project.edit(0, "Step := 0;", "Step := 1;  (* m\374de *)");  // now all of the file is Latin-1
  EXPECT_EQ(project.whole, 1u);
}

TEST(Edits, SeveralFilesAtOnce) {
  Project project({kBlocks, kMain});
  project.edit(0, "Step + 1", "Step + 4");
  project.edit(1, "TRUE", "M.Speed < 100");
  project.edit(0, "Twice(n) / 3", "Twice(n) / 4");
  EXPECT_EQ(project.whole, 0u);
}

// What a CONFIGURATION says of a program is read again whenever the program's body is lowered,
// among the nodes of all later texts.
TEST(Edits, ConnectionsOutliveEditsOfTheirProgram) {
  Project project({R"(VAR_GLOBAL g : INT; h : INT; s : STRING[8]; b : BOOL; END_VAR
PROGRAM Turn
VAR_INPUT in : INT; name : STRING[8]; END_VAR
VAR_OUTPUT out : INT; done : BOOL; END_VAR
  out := in + LEN(name) + SHL(IN := in, N := 0);
  done := in > 0;
END_PROGRAM
CONFIGURATION c
  TASK t(INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM p WITH t : Turn(in := g + 1, name := s, out => h, NOT done => b);
  PROGRAM q WITH t : Turn(in := h, out => g);
END_CONFIGURATION
)"});
  for (int save = 0; save < 12; ++save) {
    project.edit(0, "N := " + std::to_string(save), "N := " + std::to_string(save + 1));
    EXPECT_EQ(project.whole, 0u);
    EXPECT_EQ(project.lowered, 3u);  // itself, and as p and q
  }
}

// Methods of other instances have the depth of calls that is usual, and an edit of one method may
// give it to another one, or fewer calls to all.
TEST(Edits, DepthsOfCallsAreThoseOfAWholeBuild) {
  std::string text = R"(FUNCTION_BLOCK Pair
VAR_INPUT p : POINTER TO Pair; k : INT; END_VAR
METHOD Up : INT
  Up := 1; IF p <> 0 THEN Up := Up + Down(); END_IF
END_METHOD
METHOD Down : INT
  Down := 2; IF k > 3 THEN Down := Down + p^.Up(); END_IF
END_METHOD
METHOD Rest : INT
  Rest := k;
END_METHOD
METHOD Alone : INT
  Alone := 1; IF p <> 0 THEN Alone := Alone + p^.Rest(); END_IF
END_METHOD
)";
  std::string calls;
  for (int i = 1; i <= 4; ++i) {
    const std::string name = "Sum" + std::to_string(i);
    text += "METHOD " + name + " : INT " + name + " := 3; IF p <> 0 THEN " + name + " := p^." +
            name + "(); END_IF END_METHOD\n";
    calls += " n := a." + name + "();";
  }
  text +=
      "END_FUNCTION_BLOCK\nPROGRAM Main VAR a : Pair; n : INT; END_VAR n := a.Up() + a.Alone();" +
      calls + " END_PROGRAM\n";
  Project project({text});
  ASSERT_NE(project.outcome.messages.find("\"errors\":0"), std::string::npos)
      << project.outcome.messages;
  project.edit(0, "Up + Down()", "Up + p^.Down()");            // another one breaks the circle
  project.edit(0, "Alone + p^.Rest()", "Alone + p^.Alone()");  // fewer calls for all
  project.edit(0, "Down := 2", "Down := 4");
  EXPECT_EQ(project.whole, 0u);
  EXPECT_EQ(project.lowered, 1u);
  project.edit(0, "Up + p^.Down()", "Up + Down()");
  project.edit(0, "Down + p^.Up()", "Down + Up()");  // the own instance alone: an error
  EXPECT_EQ(project.outcome.messages.find("\"errors\":0"), std::string::npos);
}

// Texts and nodes of former edits go when there are too many of them.
TEST(Edits, TenThousandEditsKeepTheirMemory) {
  workspace::Settings settings;
  workspace::IncrementalBuild build(settings);
  base::SourceMap sources;
  sources.add("blocks.st", kBlocks);
  sources.add("main.st", kMain);
  const std::string before = kBlocks;
  const size_t at = before.find("Step + 1");
  constexpr int kEdits = 10'000 / kOneOf;
  size_t after_some = 0;
  for (int edit = 0; edit < kEdits; ++edit) {
    std::string text = before;
    sources.replace(0, text.replace(at, 8, "Step + " + std::to_string(edit % 97)));
    base::Diagnostics diagnostics;
    ASSERT_TRUE(build.build(sources, diagnostics).ok());
    if (edit == kEdits / 5) after_some = mallinfo2().uordblks;
    if (edit <= kEdits / 5) continue;
    ASSERT_LT(mallinfo2().uordblks, 2 * after_some + (48u << 20)) << edit;
  }
  EXPECT_LT(build.counts().whole, 100u);
}

}  // namespace
