// What can be asked of a compilation, in every language: L-01, definition, references, hover and
// signature help stand on it.
#include "frontend/questions/questions.h"

#include <gtest/gtest.h>

#include "frontend/questions/compilation.h"

namespace {

using frontend::questions::Compilation;
using frontend::questions::Occurrence;
using frontend::questions::Questions;
using frontend::questions::Role;
using frontend::questions::Symbol;

class Asked {
 public:
  explicit Asked(std::vector<std::string> texts) {
    for (size_t i = 0; i < texts.size(); ++i) {
      sources_.add("file" + std::to_string(i + 1) + ".st", texts[i]);
    }
    compilation_ = std::make_unique<Compilation>(sources_, frontend::CompileOptions());
    questions_ = std::make_unique<Questions>(*compilation_->sema());
  }

  Questions& questions() { return *questions_; }
  std::string messages() const {
    std::string all;
    for (const auto& message : compilation_->diagnostics().all()) {
      if (base::diagnostic_row(message.code).severity == base::Severity::kError) {
        all += message.text + "\n";
      }
    }
    return all;
  }
  // The place of the last letter of `before`, which occurs once in all files.
  base::SourcePos at(const std::string& before) const {
    for (uint32_t file = 0; file < sources_.file_count(); ++file) {
      const size_t found = sources_.text(file).find(before);
      if (found == std::string_view::npos) continue;
      EXPECT_EQ(sources_.text(file).find(before, found + 1), std::string_view::npos) << before;
      return {sources_.begin(file).offset + static_cast<uint32_t>(found + before.size()) - 1};
    }
    ADD_FAILURE() << "no text has " << before;
    return {};
  }
  std::string symbol(const std::string& before) {
    const Symbol* found = questions_->symbol_at(at(before));
    if (found == nullptr) return "nothing";
    return std::string(word_of(found->kind)) + ' ' + found->name;
  }
  // "2:5 3:1w": lines and columns, with the number of another file in front.
  std::string uses(const std::string& before) {
    const Symbol* found = questions_->symbol_at(at(before));
    if (found == nullptr) return "nothing";
    std::string all;
    for (const Occurrence& use : questions_->uses_of(*found)) {
      const base::SourceLocation where = questions_->locate(use.span.begin);
      all += all.empty() ? "" : " ";
      if (where.file != "file1.st") all += std::string(where.file.substr(4, 1)) + '/';
      all += std::to_string(where.line) + ':' + std::to_string(where.column);
      if (use.role == Role::kDeclared) all += 'd';
      if (use.role == Role::kWritten) all += 'w';
    }
    return all;
  }
  std::string signature(const std::string& before) {
    const Symbol* found = questions_->symbol_at(at(before));
    return found == nullptr ? "nothing" : questions_->signature_of(*found).text;
  }
  std::string documentation(const std::string& before) {
    const Symbol* found = questions_->symbol_at(at(before));
    return found == nullptr ? "nothing" : questions_->signature_of(*found).documentation;
  }
  std::string type(const std::string& before) {
    const auto found = questions_->type_at(at(before));
    return found ? found->type : "nothing";
  }

 private:
  base::SourceMap sources_;
  std::unique_ptr<Compilation> compilation_;
  std::unique_ptr<Questions> questions_;
};

const char* const kTypes =
    "TYPE Colour : (Red, Green := 5, Blue); END_TYPE\n"
    "TYPE Point : STRUCT x : INT; y : REAL; END_STRUCT END_TYPE\n"
    "VAR_GLOBAL level : INT; END_VAR\n";

TEST(Questions, L01_AnswersInStructuredText) {
  Asked asked({kTypes,
               "PROGRAM Main\n"
               "VAR p : Point; c : Colour; n : INT; END_VAR\n"
               "n := level + p.x;\n"
               "p.y := TO_REAL(n);\n"
               "c := Green; c := Colour#Blue; c := Colour.Red;\n"
               "END_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.symbol("n := l"), "variable level");
  EXPECT_EQ(asked.uses("n := l"), "3:12d 2/3:6");
  EXPECT_EQ(asked.symbol("level + p.x"), "field Point.x");
  EXPECT_EQ(asked.uses("level + p.x"), "2:21d 2/3:16");
  EXPECT_EQ(asked.uses("x : INT; y"), "2:30d 2/4:3w");
  EXPECT_EQ(asked.symbol("c := Gr"), "enumerator Colour#Green");
  EXPECT_EQ(asked.symbol("Colour#B"), "enumerator Colour#Blue");
  EXPECT_EQ(asked.symbol("Colour.R"), "enumerator Colour#Red");
  EXPECT_EQ(asked.symbol("c := Colour#"), "type Colour");
  EXPECT_EQ(asked.uses("TYPE Colour"), "1:6d 2/2:20 2/5:18 2/5:36");
  EXPECT_EQ(asked.uses("TO_REAL(n"), "2/2:28d 2/3:1w 2/4:16");
  EXPECT_EQ(asked.type("level + p.x"), "INT");
  EXPECT_EQ(asked.type("level +"), "INT");
  EXPECT_EQ(asked.type("p.y"), "REAL");
  EXPECT_EQ(asked.symbol("END_P"), "nothing");
}

TEST(Questions, L01_AnswersForMembersOfBlocks) {
  Asked asked(
      {"INTERFACE Runs METHOD go : BOOL VAR_INPUT far : INT; END_VAR END_METHOD "
       "END_INTERFACE\n"
       "FUNCTION_BLOCK Base IMPLEMENTS Runs\n"
       "VAR_INPUT speed : INT; END_VAR VAR_OUTPUT done : BOOL; END_VAR\n"
       "METHOD go : BOOL VAR_INPUT far : INT; END_VAR go := far > speed; END_METHOD\n"
       "PROPERTY rate : INT GET rate := speed; END_GET SET speed := rate; END_SET "
       "END_PROPERTY\n"
       "END_FUNCTION_BLOCK\n",
       "FUNCTION_BLOCK Pump EXTENDS Base\n"
       "IF THIS^.go(far := 3) THEN SUPER^.rate := 4; END_IF\n"
       "END_FUNCTION_BLOCK\n"
       "PROGRAM Main VAR a : Pump; r : Runs; b : BOOL; END_VAR\n"
       "a(speed := 5, done => b); r := a; b := r.go(1); b := a.go(2); a.rate := 7;\n"
       "b := a.done;\n"
       "END_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.symbol("a(sp"), "variable Base.speed");
  EXPECT_EQ(asked.uses("VAR_INPUT sp"), "3:11d 4:59 5:33 5:52w 2/5:3w");
  EXPECT_EQ(asked.symbol("5, do"), "variable Base.done");
  EXPECT_EQ(asked.symbol("b := a.d"), "variable Base.done");
  EXPECT_EQ(asked.symbol("b := r.g"), "method Runs.go");
  EXPECT_EQ(asked.symbol("b := a.g"), "method Base.go");
  EXPECT_EQ(asked.symbol("THIS^.g"), "method Base.go");
  EXPECT_EQ(asked.symbol("THIS^.go(f"), "variable Base.go.far");
  EXPECT_EQ(asked.symbol("SUPER^.r"), "property Base.rate");
  EXPECT_EQ(asked.symbol("a.ra"), "property Base.rate");
  EXPECT_EQ(asked.symbol("EXTENDS B"), "functionBlock Base");
  EXPECT_EQ(asked.uses("IMPLEMENTS R"), "1:11d 2:32 2/4:32");
  EXPECT_EQ(asked.signature("b := a.g"), "METHOD Base.go(far : INT) : BOOL");
}

TEST(Questions, L01_AnswersForQualifiedNames) {
  Asked asked(
      {"NAMESPACE Plant.Line\n"
       "FUNCTION Twice : INT VAR_INPUT v : INT; END_VAR Twice := 2 * v; END_FUNCTION\n"
       "FUNCTION_BLOCK Pump VAR_INPUT on : BOOL; END_VAR END_FUNCTION_BLOCK\n"
       "END_NAMESPACE\n"
       "{attribute 'list' := 'Shared'} VAR_GLOBAL total : INT; END_VAR\n",
       "PROGRAM Main VAR p : Plant.Line.Pump; n : INT; END_VAR\n"
       "n := Plant.Line.Twice(v := 4); Shared.total := n; p(on := TRUE);\n"
       "END_PROGRAM\n",
       "USING Plant.Line;\n"
       "FUNCTION Four : INT VAR_INPUT w : INT; END_VAR Four := Twice(w) + Twice(3); "
       "END_FUNCTION\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.symbol("Plant.Line.T"), "function Plant.Line.Twice");
  EXPECT_EQ(asked.uses("Plant.Line.T"), "2:10d 2:49w 2/2:17 3/2:56 3/2:67");
  EXPECT_EQ(asked.symbol("Plant.Line.P"), "functionBlock Plant.Line.Pump");
  EXPECT_EQ(asked.symbol("Twice(v"), "variable Plant.Line.Twice.v");
  EXPECT_EQ(asked.uses("Shared.to"), "5:43d 2/2:39w");
  EXPECT_EQ(asked.uses("p(o"), "3:31d 2/2:53w");
}

TEST(Questions, L01_AnswersInLadder) {
  Asked asked({kTypes,
               "PROGRAM Main\nVAR Start, Stop, Run : BOOL; T1 : TON; END_VAR\nLADDER\n"
               "  |--[ Start ]--+--[/ Stop ]----------( Run )--|\n"
               "  |--[ Run ]----+\n"
               "  |--[ Run ]--[ T1: TON IN:=_, PT:=T#1s ]--|\n"
               "END_LADDER\nEND_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.symbol("[ Sta"), "variable Main.Start");
  EXPECT_EQ(asked.uses("( R"), "2/2:18d 2/4:41w 2/5:8 2/6:8");
  EXPECT_EQ(asked.symbol("[ T1: TO"), "functionBlock TON");
  EXPECT_EQ(asked.symbol("[ T"), "variable Main.T1");
  EXPECT_EQ(asked.type("[/ St"), "BOOL");
}

TEST(Questions, L01_AnswersInFunctionBlockDiagrams) {
  Asked asked({kTypes,
               "PROGRAM Main\nVAR go, done : BOOL; t : TON; END_VAR\nFBD\n"
               "  t : TON(IN := go, PT := T#30ms);\n"
               "  WIRE next := ADD(EN := [P go], level, 1);\n"
               "  level := next;\n"
               "  done := t.Q;\n"
               "END_FBD\nEND_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.uses("VAR go"), "2/2:5d 2/4:17 2/5:29");
  EXPECT_EQ(asked.uses("GLOBAL l"), "3:12d 2/5:34 2/6:3w");
  EXPECT_EQ(asked.symbol("t : TON(I"), "variable TON.IN");
  EXPECT_EQ(asked.symbol("t.Q"), "variable TON.Q");
  EXPECT_EQ(asked.symbol("next := A"), "standardFunction ADD");
}

TEST(Questions, L01_AnswersInInstructionLists) {
  Asked asked(
      {"PROGRAM Main\nVAR a, b : INT; END_VAR\n"
       "LD a\nADD 3\nST b\nEND_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.symbol("LD a"), "variable Main.a");
  EXPECT_EQ(asked.uses("ST b"), "2:8d 5:4w");
}

TEST(Questions, L01_AnswersInCharts) {
  Asked asked(
      {"PROGRAM Main\nVAR go : BOOL; lamp : BOOL; END_VAR\n"
       "INITIAL_STEP Idle: END_STEP\n"
       "STEP Busy: Fill(N); lamp(S); END_STEP\n"
       "TRANSITION FROM Idle TO Busy := go; END_TRANSITION\n"
       "TRANSITION FROM Busy TO Idle := Busy.T > T#1s; END_TRANSITION\n"
       "ACTION Fill: lamp := go; END_ACTION\n"
       "END_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.uses("STEP Bu"), "4:6d 5:25 6:17 6:33");
  EXPECT_EQ(asked.symbol("lamp := g"), "variable Main.go");
  EXPECT_EQ(asked.uses("Busy := g"), "2:5d 5:33 7:22");
  EXPECT_EQ(asked.uses("ACTION F"), "4:12 7:8d");
  EXPECT_EQ(asked.uses("BOOL; l"), "2:16d 4:21w 7:14w");
}

TEST(Questions, L01_SaysHowThingsAreCalledAndWhatTheirAuthorsSay) {
  Asked asked(
      {"(* Makes a value of a raw one.\n   Never below zero. *)\n"
       "{attribute 'x'}\n"
       "FUNCTION Scale : REAL\n"
       "VAR_INPUT raw : INT; gain : REAL := 1.0; END_VAR\n"
       "VAR_OUTPUT cut : BOOL; (* it was below *) END_VAR\n"
       "Scale := TO_REAL(raw) * gain;\nEND_FUNCTION\n"
       "FUNCTION_BLOCK Lamp // on or off\n"
       "VAR\n  // counts hours\n  // and minutes\n  used : TIME;\nEND_VAR\n"
       "END_FUNCTION_BLOCK\n"
       "PROGRAM Main VAR r : REAL; l : Lamp; t : TON; END_VAR\n"
       "r := Scale(4, MIN(2.0, 3.0)); l(); t(IN := TRUE);\nEND_PROGRAM\n"});
  EXPECT_EQ(asked.messages(), "");
  EXPECT_EQ(asked.signature("r := Sc"),
            "FUNCTION Scale(raw : INT, gain : REAL, VAR_OUTPUT cut : BOOL) : REAL");
  EXPECT_EQ(asked.documentation("r := Sc"), "Makes a value of a raw one.\nNever below zero.");
  EXPECT_EQ(asked.documentation("OUTPUT c"), "it was below");
  EXPECT_EQ(asked.documentation("BLOCK L"), "on or off");
  EXPECT_EQ(asked.documentation("  u"), "counts hours\nand minutes");
  EXPECT_EQ(asked.documentation("VAR r"), "");
  EXPECT_EQ(asked.symbol("(4, M"), "standardFunction MIN");
  EXPECT_NE(asked.signature("(4, M").find("MIN("), std::string::npos);
  EXPECT_EQ(asked.questions().called_at(asked.at("MIN(2"))->name, "MIN");
  EXPECT_EQ(asked.questions().called_at(asked.at("Scale(4"))->name, "Scale");
  EXPECT_EQ(asked.symbol("t(I"), "variable TON.IN");
  EXPECT_EQ(asked.signature("l : L"), "FUNCTION_BLOCK Lamp()");
}

TEST(Questions, L06_AnswersForSourcesWithMistakes) {
  Asked asked(
      {"PROGRAM Main\nVAR a : INT; b : Missing; END_VAR\n"
       "a := unknown + a;\na := b.c;\na := a + 1;\nEND_PROGRAM\n"});
  EXPECT_NE(asked.messages(), "");
  EXPECT_EQ(asked.uses("VAR a"), "2:5d 3:1w 3:16 4:1w 5:1w 5:6");
  EXPECT_EQ(asked.symbol("a := un"), "nothing");
}

}  // namespace
