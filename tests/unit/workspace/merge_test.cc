// An edit that was made in one program, made in another (E-09 to E-13, D3). What comes out is what
// the compiler makes of sources with both edits, linked on top of the program that was there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "ir/bytecode/renames.h"
#include "ir/bytecode/symbols.h"
#include "linker/link.h"
#include "linker/merge.h"
#include "tests/unit/sanitized.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

using ir::PartKind;
using ir::PartState;

std::optional<ir::Image> compiled(const std::string& text, const ir::Image* base = nullptr,
                                  ir::PassSet passes = ir::PassSet::all()) {
  workspace::Settings settings;
  settings.link.base = base;
  settings.passes = passes;
  const test::Outcome built = test::build_from_nothing(test::one_file(text), settings);
  if (!built.image) return std::nullopt;
  return std::move(*ir::decode(*built.image));
}

ir::Image image_of(const std::string& text, const ir::Image* base = nullptr) {
  std::optional<ir::Image> image = compiled(text, base);
  EXPECT_TRUE(image.has_value()) << text;
  return image ? *std::move(image) : ir::Image();
}

// Lines are those of the text that a POU came from.
std::string without_lines(const std::string& code) {
  std::istringstream in(code);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("; line")) out += line + "\n";
  }
  return out;
}

// Constants by what they are: their places in the pool are those of a history.
std::string with_constants(const std::string& code, const ir::Image& image) {
  static const std::regex kConstant(R"((_(8|16|32|64)\b.*?)const\[(\d+)\])");
  std::string out;
  std::istringstream in(code);
  for (std::string line; std::getline(in, line);) {
    for (std::smatch found; std::regex_search(line, found, kConstant);) {
      const size_t bytes = std::stoul(found[2]) / 8;
      const size_t at = std::stoul(found[3]);
      uint64_t value = 0;
      if (at + bytes <= image.pool.size()) std::memcpy(&value, image.pool.data() + at, bytes);
      line = std::string(found.prefix()) + found[1].str() + "constant " + std::to_string(value) +
             std::string(found.suffix());
    }
    out += line + "\n";
  }
  return out;
}

// POUs, parts and initial values, in words. Bare addresses are variables in the order in which code
// names them first, which means nothing.
std::string description(const ir::Image& image) {
  std::string out;
  for (const ir::Part& part : ir::parts_of(image)) {
    out += std::string(ir::part_kind_name(part.kind)) + " " + part.name + " " +
           base::short_hex(part.identity) + "\n";
  }
  std::vector<std::string> pous;
  for (const ir::LinkedPou& pou : image.pous) {
    if (!pou.name.empty()) {
      pous.push_back(with_constants(without_lines(ir::disassemble(image, pou)), image));
    }
  }
  std::sort(pous.begin(), pous.end());
  for (const std::string& pou : pous) out += pou;
  base::Bytes memory(image.data_capacity, 0);
  ir::read_initial(image, 0, memory);
  std::istringstream state(ir::state_text(image, memory));
  std::vector<std::string> values;
  for (std::string line; std::getline(state, line);) values.push_back(line);
  std::sort(values.begin(), values.end());
  for (const std::string& line : values) out += line + "\n";
  return out;
}

class Plant {
 public:
  // A project whose parts can be written otherwise.
  std::string a =
      "FUNCTION_BLOCK A VAR_INPUT x : INT; END_VAR VAR_OUTPUT n : INT; END_VAR n := n + x;";
  std::string b = "FUNCTION_BLOCK B VAR_OUTPUT m : INT := 5; END_VAR m := m + 1;";
  std::string c = "FUNCTION_BLOCK C VAR k : DINT; END_VAR k := k + shared;";
  std::string types = "TYPE S : STRUCT u, v : INT; END_STRUCT; END_TYPE\n";
  std::string globals = "VAR_GLOBAL shared : DINT := 7; pair : S; END_VAR\n";
  std::string own;  // POUs of one plant alone
  std::string main = "a1(x := 2); b1(); c1(); pair.v := a1.n;";
  std::string variables = "a1 : A; b1 : B; c1 : C;";

  std::string text() const {
    return types + globals + a + " END_FUNCTION_BLOCK\n" + b + " END_FUNCTION_BLOCK\n" + c +
           " END_FUNCTION_BLOCK\n" + own + "PROGRAM Main VAR " + variables + " END_VAR " + main +
           " END_PROGRAM\n";
  }
};

const ir::PartEdit* row_of(const std::vector<ir::PartEdit>& rows, const std::string& name) {
  for (const ir::PartEdit& row : rows) {
    if (row.kind == PartKind::kUnit && row.name == name) return &row;
  }
  return nullptr;
}

// What the edit renames by a rule keeps its value in the other program, too: members, globals,
// types and what is in them.
TEST(Merge, X2_RulesOfTheEditGoAlong) {
  Plant plant;
  const ir::Image original = image_of(plant.text());
  Plant next = plant;
  next.c = "FUNCTION_BLOCK C VAR {renamed from := 'k'} sum : DINT; END_VAR sum := sum + shared;";
  const ir::Image edited = image_of(next.text());
  Plant other = plant;
  other.own = "FUNCTION_BLOCK Own VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK\n";
  const ir::Image target = image_of(other.text());
  const base::Result<ir::Image> merged = linker::merge({original, edited, target}, {});
  ASSERT_TRUE(merged.ok()) << base::to_string(merged.error());
  EXPECT_TRUE(ir::find_symbol(*merged, "Main.c1.sum").ok());
  const std::optional<ir::Image> renamed = ir::under_new_names(target, *merged);
  ASSERT_TRUE(renamed.has_value());
  EXPECT_TRUE(ir::find_symbol(*renamed, "Main.c1.sum").ok());
  // Edited again, it still has the rule, as its sources do.
  Plant again = next;
  again.a += " n := n + 1;";
  const base::Result<ir::Image> twice =
      linker::merge({edited, image_of(again.text()), *merged}, {});
  ASSERT_TRUE(twice.ok()) << base::to_string(twice.error());
  EXPECT_TRUE(ir::under_new_names(target, *twice).has_value());
}

// The worked example: A and B are edited; one controller has both, one has another B.
TEST(Merge, E11_SaysWhatEachControllerHas) {
  Plant plant;
  const ir::Image original = image_of(plant.text());
  Plant next = plant;
  next.a += " n := n + 1;";
  next.b += " m := m + 2;";
  const ir::Image edited = image_of(next.text());
  Plant other = plant;
  other.b += " m := m + 100;";
  const ir::Image second = image_of(other.text());
  const std::vector<ir::PartEdit> rows = linker::merge_parts({original, edited, second});
  ASSERT_NE(row_of(rows, "A"), nullptr);
  EXPECT_EQ(row_of(rows, "A")->state, PartState::kOk);
  EXPECT_EQ(row_of(rows, "B")->state, PartState::kDifferent);
  EXPECT_EQ(row_of(rows, "C"), nullptr);
  const base::Result<ir::Image> refused = linker::merge({original, edited, second}, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kOtherPart);
  EXPECT_NE(refused.error().text.find("unit `B` is another one here"), std::string::npos)
      << refused.error().text;
  EXPECT_EQ(row_of(linker::merge_parts({original, edited, edited}), "A")->state, PartState::kHasIt);
  Plant without = plant;
  without.b = "FUNCTION_BLOCK D";
  without.main = "a1(x := 2); c1();";
  without.variables = "a1 : A; c1 : C;";
  const ir::Image third = image_of(without.text());
  EXPECT_EQ(row_of(linker::merge_parts({original, edited, third}), "B")->state,
            PartState::kMissing);
}

// What is no part of the edit stays, byte for byte, whatever it is there.
TEST(Merge, E09_LinksTheEditIntoTheOwnProgramOfAController) {
  Plant plant;
  const ir::Image original = image_of(plant.text());
  Plant next = plant;
  next.a =
      "FUNCTION_BLOCK A VAR_INPUT x : INT; END_VAR VAR_OUTPUT n : INT; END_VAR VAR more : LREAL := "
      "1.5; "
      "END_VAR "
      "n := n + x; more := more * 2.0; pair.u := n; new_global := new_global + 1;";
  next.globals = "VAR_GLOBAL shared : DINT := 7; pair : S; new_global : INT := 3; END_VAR\n";
  const ir::Image edited = image_of(next.text());
  // Another C, and things of its own: other addresses, other numbers.
  Plant own = plant;
  own.c = "FUNCTION_BLOCK C VAR z : ARRAY[0..9] OF LREAL; k : DINT; END_VAR k := k - shared;";
  own.globals = "VAR_GLOBAL values : ARRAY[0..99] OF DINT; shared : DINT := 7; pair : S; END_VAR\n";
  own.own = "FUNCTION Mine : INT Mine := 4; END_FUNCTION\n";
  own.main += " values[3] := Mine() + b1.m;";
  const ir::Image target = image_of(own.text());
  const base::Result<ir::Image> merged = linker::merge({original, edited, target}, {});
  ASSERT_TRUE(merged.ok()) << merged.error().text;
  Plant both = own;
  both.a = next.a;
  both.globals =
      "VAR_GLOBAL values : ARRAY[0..99] OF DINT; shared : DINT := 7; pair : S; "
      "new_global : INT := 3; END_VAR\n";
  EXPECT_EQ(description(*merged), description(image_of(both.text(), &target)));
  for (const ir::LinkedPou& pou : target.pous) {
    if (pou.name == "A") continue;
    const auto found = std::find_if(merged->pous.begin(), merged->pous.end(),
                                    [&](const auto& row) { return row.name == pou.name; });
    ASSERT_NE(found, merged->pous.end()) << pou.name;
    EXPECT_EQ(found->identity, pou.identity) << pou.name;
    EXPECT_TRUE(std::equal(target.code.begin() + pou.first_unit,
                           target.code.begin() + pou.first_unit + pou.unit_count,
                           merged->code.begin() + found->first_unit))
        << pou.name;
  }
}

base::Result<ir::Image> merged(const Plant& original, const Plant& edited, const Plant& target) {
  const ir::Image first = image_of(original.text());
  const ir::Image next = image_of(edited.text());
  const ir::Image own = image_of(target.text());
  return linker::merge({first, next, own}, {});
}

void expect_refused(const base::Result<ir::Image>& result, const std::string& text) {
  ASSERT_FALSE(result.ok()) << text;
  EXPECT_EQ(result.error().refusal, base::Refusal::kCannotRelink);
  EXPECT_NE(result.error().text.find(text), std::string::npos) << result.error().text;
}

// A unit of the target alone calls what the edit gives another interface.
TEST(Merge, E09_RefusesWhoUsesAnInterfaceThatTheEditChanges) {
  Plant plant;
  plant.own =
      "FUNCTION Twice : INT VAR_INPUT v : INT; END_VAR VAR r : ARRAY[0..3] OF INT; "
      "END_VAR r[v] := v; Twice := 2 * r[v]; END_FUNCTION\n";
  plant.main += " pair.u := Twice(3);";
  Plant next = plant;
  next.own =
      "FUNCTION Twice : INT VAR_INPUT v : INT; w : INT := 1; END_VAR VAR r : ARRAY[0..3] OF "
      "INT; END_VAR r[v] := v; Twice := 2 * r[v] + w; END_FUNCTION\n";
  Plant own = plant;
  own.own += "FUNCTION_BLOCK Mine VAR_OUTPUT o : INT; END_VAR o := Twice(2); END_FUNCTION_BLOCK\n";
  own.variables += " mine : Mine;";
  own.main += " mine();";
  expect_refused(merged(plant, next, own), "`Mine` uses `Twice`, which has another interface");
}

// What has become a number in code: a constant, and a literal of an enumeration.
TEST(Merge, E10_RefusesCodeThatHoldsValuesAsTheyWere) {
  Plant plant;
  plant.globals =
      "VAR_GLOBAL shared : DINT := 7; pair : S; END_VAR "
      "VAR_GLOBAL CONSTANT limit : INT := 10; END_VAR\n";
  plant.types += "TYPE Mode : (Off, Slow, Fast); END_TYPE\n";
  Plant next = plant;
  next.a =
      "FUNCTION_BLOCK A VAR_INPUT x : INT; END_VAR VAR_OUTPUT n : INT; END_VAR n := n + limit;";
  Plant own = plant;
  own.globals =
      "VAR_GLOBAL shared : DINT := 7; pair : S; END_VAR "
      "VAR_GLOBAL CONSTANT limit : INT := 99; END_VAR\n";
  expect_refused(merged(plant, next, own), "the code of `A` was made with another global `limit`");
  // The other way round: the edit changes the constant, and a unit of its own holds it.
  Plant constant = plant;
  constant.globals = own.globals;
  Plant uses = plant;
  uses.own = "FUNCTION_BLOCK Mine VAR_OUTPUT o : INT; END_VAR o := limit; END_FUNCTION_BLOCK\n";
  uses.variables += " mine : Mine;";
  uses.main += " mine();";
  expect_refused(merged(plant, constant, uses), "`Mine` was made with another global `limit`");
  Plant modes = plant;
  modes.types =
      "TYPE S : STRUCT u, v : INT; END_STRUCT; END_TYPE\n"
      "TYPE Mode : (Off, Crawl, Slow, Fast); END_TYPE\n";
  Plant slow = uses;
  slow.own =
      "FUNCTION_BLOCK Mine VAR_OUTPUT o : Mode; END_VAR o := Mode#Slow; END_FUNCTION_BLOCK\n";
  expect_refused(merged(plant, modes, slow), "`Mine` was made with another type `Mode`");
  // Who names neither goes with both.
  Plant other = plant;
  other.own = "FUNCTION_BLOCK Mine VAR_OUTPUT o : INT; END_VAR o := 3; END_FUNCTION_BLOCK\n";
  other.variables = uses.variables;
  other.main = uses.main;
  const base::Result<ir::Image> fine = merged(plant, constant, other);
  EXPECT_TRUE(fine.ok()) << fine.error().text;
}

// The caller passes what its call leaves out, of a function and of a method.
TEST(Merge, E10_RefusesACallerThatPassesAnotherDefault) {
  Plant plant;
  plant.own =
      "FUNCTION Far : INT VAR_INPUT n : INT; more : INT := 7; END_VAR Far := n + more; "
      "END_FUNCTION\nFUNCTION_BLOCK D METHOD Near : INT VAR_INPUT n : INT := 1; END_VAR "
      "Near := n; END_METHOD END_FUNCTION_BLOCK\n";
  plant.variables += " d : D; m : INT;";
  plant.main += " m := Far(pair.u) + d.Near();";
  Plant own = plant;
  own.main += " pair.u := m;";
  for (const char* const change : {"more : INT := 8", "n : INT := 2"}) {
    Plant next = plant;
    const std::string before = change[0] == 'm' ? "more : INT := 7" : "n : INT := 1";
    next.own.replace(next.own.find(before), before.size(), change);
    expect_refused(merged(plant, next, own), "the code of `Main` was made with another unit `" +
                                                 std::string(change[0] == 'm' ? "Far" : "D"));
    EXPECT_TRUE(merged(plant, next, plant).ok()) << "it goes along where it is the same";
  }
}

// What the target alone makes of the edited sources: instances of functions for its own types, and
// what gives its own instances their values where they are made anew at each call.
TEST(Merge, E10_RefusesWhatOnlyTheTargetMakesOfWhatIsEdited) {
  Plant plant;
  plant.own =
      "FUNCTION Twice : ANY_NUM VAR_INPUT n : ANY_NUM; END_VAR Twice := n + n; END_FUNCTION\n"
      "FUNCTION_BLOCK D VAR k : INT := 5; END_VAR k := k; END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK E EXTENDS D END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK I VAR x : INT; END_VAR METHOD FB_Init : BOOL VAR_INPUT bInitRetains, "
      "bInCopyCode : BOOL; END_VAR x := 1; END_METHOD x := 2; END_FUNCTION_BLOCK\n";
  plant.variables += " m : INT; l : LREAL;";
  plant.main += " m := Twice(m);";
  const auto edited = [&](const char* from, const char* to) {
    Plant next = plant;
    next.own.replace(next.own.find(from), std::strlen(from), to);
    return next;
  };
  const Plant twice = edited("n + n;", "n + n + n;");
  const Plant five = edited(":= 5", ":= 6");
  const Plant body = edited("k := k;", "k := k + 1;");
  Plant own = plant;
  own.main += " l := Twice(l);";
  expect_refused(merged(plant, twice, own),
                 "the code of `Twice(LREAL)` was made of another `Twice`");
  EXPECT_TRUE(merged(plant, five, own).ok()) << "Twice is as it was";
  for (const char* const local : {"D", "E", "ARRAY[0..1] OF E"}) {
    own = plant;
    own.own +=
        std::string("FUNCTION Own : INT VAR d : ") + local + "; END_VAR Own := 1; END_FUNCTION\n";
    own.main += " m := Own();";
    expect_refused(merged(plant, five, own), "is made anew at each call here");
  }
  EXPECT_TRUE(merged(plant, body, plant).ok());
  own = plant;
  own.own += "FUNCTION_BLOCK Own VAR i : I; END_VAR i(); END_FUNCTION_BLOCK\n";
  own.variables += " own : Own;";
  EXPECT_TRUE(merged(plant, edited("x := 2;", "x := 3;"), own).ok()) << "it starts once, by a call";
}

TEST(Merge, E10_RefusesATypeThatIsAnotherOneThere) {
  Plant plant;
  Plant next = plant;
  next.a =
      "FUNCTION_BLOCK A VAR_INPUT x : INT; END_VAR VAR_OUTPUT n : INT; END_VAR VAR s : S; "
      "END_VAR n := n + s.v;";
  Plant own = plant;
  own.types = "TYPE S : STRUCT u : LREAL; v : INT; END_STRUCT; END_TYPE\n";
  expect_refused(merged(plant, next, own), "the type `S`, which is another one there");
}

// Offsets behind a reference are numbers: they go only where the type lies as it did.
TEST(Merge, E09_CodeWithReferencesGoesWhereTypesLieAlike) {
  Plant plant;
  Plant next = plant;
  next.b =
      "FUNCTION_BLOCK B VAR_OUTPUT m : INT := 5; END_VAR VAR p : POINTER TO S; END_VAR "
      "p := ADR(pair); m := p^.v;";
  Plant own = plant;
  own.c = "FUNCTION_BLOCK C VAR z : LREAL; k : DINT; END_VAR k := k + shared;";
  const base::Result<ir::Image> fine = merged(plant, next, own);
  ASSERT_TRUE(fine.ok()) << fine.error().text;
  Plant both = own;
  both.b = next.b;
  const ir::Image target = image_of(own.text());
  EXPECT_EQ(description(*fine), description(image_of(both.text(), &target)));
}

// E-13: what fits, and nothing else.
TEST(Merge, E13_TakesTheUnitsThatFit) {
  Plant plant;
  Plant next = plant;
  next.a += " n := n + 1;";
  next.b += " m := m + 2;";
  Plant own = plant;
  own.b += " m := m + 100;";
  const ir::Image original = image_of(plant.text());
  const ir::Image edited = image_of(next.text());
  const ir::Image target = image_of(own.text());
  const base::Result<ir::Image> result = linker::merge({original, edited, target}, {{}, true});
  ASSERT_TRUE(result.ok()) << result.error().text;
  Plant wanted = own;
  wanted.a = next.a;
  EXPECT_EQ(description(*result), description(image_of(wanted.text(), &target)));
  // It does not, when what it needs comes with one that does not fit.
  Plant needs = next;
  needs.globals = "VAR_GLOBAL shared : DINT := 7; pair : S; fresh : INT; END_VAR\n";
  needs.a = "FUNCTION_BLOCK A VAR_INPUT x : INT; END_VAR VAR_OUTPUT n : INT; END_VAR n := fresh;";
  Plant fresh = own;
  fresh.globals = "VAR_GLOBAL shared : DINT := 7; pair : S; fresh : LREAL; END_VAR\n";
  const ir::Image third = image_of(needs.text());
  const ir::Image fourth = image_of(fresh.text());
  const base::Result<ir::Image> refused = linker::merge({original, third, fourth}, {{}, true});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kOtherPart);
}

// --- edits of golden files: one by the controller, one by the engineer ---------------------------

// `from` -> `to`, both without what they have in common at their ends.
struct Patch {
  size_t begin = 0;
  std::string old_text;
  std::string new_text;
};

Patch patch_of(const std::string& from, const std::string& to) {
  size_t begin = 0;
  while (begin < from.size() && begin < to.size() && from[begin] == to[begin]) ++begin;
  size_t end = 0;
  while (end < from.size() - begin && end < to.size() - begin &&
         from[from.size() - 1 - end] == to[to.size() - 1 - end]) {
    ++end;
  }
  return {begin, from.substr(begin, from.size() - end - begin),
          to.substr(begin, to.size() - end - begin)};
}

// Both patches of one text; nullopt where they touch each other.
std::optional<std::string> both(const std::string& text, Patch a, Patch b) {
  if (a.begin > b.begin) std::swap(a, b);
  if (a.begin + a.old_text.size() >= b.begin) return std::nullopt;
  std::string out = text;
  out.replace(b.begin, b.old_text.size(), b.new_text);
  out.replace(a.begin, a.old_text.size(), a.new_text);
  return out;
}

// The same edit on both sides is one edit, and the text with both patches has it twice.
bool has_part_of(const std::vector<ir::PartEdit>& rows) {
  return std::ranges::any_of(
      rows, [](const ir::PartEdit& row) { return row.state == PartState::kHasIt; });
}

// A caller that is not edited goes on calling a function that the edit has made short enough for
// the compiler to take in. Where nothing is taken in, the code is the same too.
bool is_same_without_inlining(const std::string& text, const std::string& next,
                              const std::string& own, const std::string& both) {
  const uint32_t inlining = uint32_t{1} << static_cast<uint32_t>(ir::Pass::kInline);
  const ir::PassSet passes = ir::PassSet::from_bits(~inlining);
  const auto original = compiled(text, nullptr, passes);
  const auto edited = compiled(next, nullptr, passes);
  const auto target = compiled(own, nullptr, passes);
  const auto expected = compiled(both, &*target, passes);
  const base::Result<ir::Image> result = linker::merge({*original, *edited, *target}, {});
  return result.ok() && description(*result) == description(*expected);
}

TEST(Merge, E09_EqualsTheCompilerOnSourcesWithBothEdits) {
  uint32_t merged = 0;
  uint32_t refused = 0;
  uint32_t number = 0;
  for (const std::string& path : test::sources_below("tests/golden")) {
    if (++number % kOneOf != 0) continue;
    const std::string text = test::read_file(path);
    // An edit of what is not compiled is in no image, and becomes one by another edit of its condition.
    if (text.find("{IF") != std::string::npos) continue;
    const std::optional<ir::Image> original = compiled(text);
    if (!original) continue;
    test::Random random(test::seed_of(path));
    for (int round = 0; round < 4; ++round) {
      const std::string next = test::edited(text, random);
      const std::string own = test::edited(text, random);
      const std::optional<std::string> wanted =
          both(text, patch_of(text, next), patch_of(text, own));
      if (!wanted) continue;
      const std::optional<ir::Image> edited = compiled(next);
      const std::optional<ir::Image> target = compiled(own);
      const std::optional<ir::Image> expected = compiled(*wanted, target ? &*target : nullptr);
      if (!edited || !target || !expected) continue;
      if (has_part_of(linker::merge_parts({*original, *edited, *target}))) continue;
      const base::Result<ir::Image> result = linker::merge({*original, *edited, *target}, {});
      if (!result.ok()) {
        const base::Refusal code = result.error().refusal;
        if (code == base::Refusal::kNoChange) continue;  // the engineer edited a comment
        EXPECT_TRUE(code == base::Refusal::kOtherPart || code == base::Refusal::kCannotRelink)
            << path << ": " << base::to_string(result.error());
        ++refused;
        continue;
      }
      if (description(*result) != description(*expected) &&
          !is_same_without_inlining(text, next, own, *wanted)) {
        EXPECT_EQ(description(*result), description(*expected)) << path << "\n--- engineer\n"
                                                                << next << "\n--- controller\n"
                                                                << own;
      }
      if (::testing::Test::HasFailure()) return;
      ++merged;
    }
  }
  RecordProperty("merged", static_cast<int>(merged));
  RecordProperty("refused", static_cast<int>(refused));
  EXPECT_GT(merged, 100u / kOneOf);  // otherwise little was tested
  EXPECT_GT(refused, 20u / kOneOf);
}

}  // namespace
