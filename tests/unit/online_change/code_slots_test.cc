// Code slots (D1, D2, D5): an edited POU is written to its unused slot, everything else stays where
// it is; growth is checked.
#include <algorithm>
#include <cstring>
#include <map>

#include "tests/unit/online_change/plant.h"
#include "tests/unit/sanitized.h"

namespace online_change {
namespace {

using base::Refusal;
using plant::Plant;
using plant::Settings;

std::string source(const std::string& body) {
  return "FUNCTION_BLOCK Edited VAR n : INT; END_VAR " + body +
         " END_FUNCTION_BLOCK FUNCTION_BLOCK Other VAR n : INT; END_VAR n := n + 2; "
         "END_FUNCTION_BLOCK PROGRAM Main VAR a : Edited; b : Other; END_VAR a(); b(); "
         "END_PROGRAM";
}

std::string repeated(const char* statement, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += statement;
  return text;
}

std::map<std::string, const ir::Unit*> addresses(Plant& plant) {
  std::map<std::string, const ir::Unit*> out;
  const vm::Generation& running = plant.controller().generation();
  for (size_t i = 0; i < running.pous().size(); ++i) {
    out[running.image().pous[i].name] = running.pous()[i].code;
  }
  return out;
}

TEST(CodeSlots, D1_D2_one_edited_pou_is_one_slot) {
  Plant plant(source("n := n + 1;"));
  plant.run(1);
  const auto first = addresses(plant);
  const uint64_t written = plant.controller().code_slots().written();
  plant.change(source("n := n + n + 1;"));
  EXPECT_EQ(plant.controller().code_slots().written(), written + 1);
  for (const auto& [name, code] : addresses(plant)) {
    EXPECT_EQ(code == first.at(name), name != "Edited") << name;
  }
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "3");
  plant.undo();  // D3: the entry is put back
  EXPECT_EQ(addresses(plant), first);
  EXPECT_EQ(plant.controller().code_slots().written(), written + 1);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "4");
}

// The same where types change with the code, so that all code is made anew and compared.
TEST(CodeSlots, D1_D2_one_edited_pou_with_other_variables_is_one_slot) {
  const auto with = [](const char* variable, const char* step) {
    return "FUNCTION_BLOCK Edited VAR n : INT; " + std::string(variable) + " END_VAR n := n + " +
           step +
           "; END_FUNCTION_BLOCK FUNCTION_BLOCK Other VAR n : INT; END_VAR n := n + 2; "
           "END_FUNCTION_BLOCK PROGRAM Main VAR a : Edited; b : Other; END_VAR a(); b(); "
           "END_PROGRAM";
  };
  Plant plant(with("", "1"));
  plant.run(1);
  const auto first = addresses(plant);
  const auto length = [&] {
    for (const ir::LinkedPou& pou : plant.controller().image().pous) {
      if (pou.name == "Edited") return pou.unit_count;
    }
    return 0u;
  };
  const uint32_t before = length();
  const uint64_t written = plant.controller().code_slots().written();
  plant.change(with("more : LREAL;", "7"));
  ASSERT_EQ(length(), before) << "by its length it is the same";
  EXPECT_EQ(plant.controller().code_slots().written(), written + 1);
  for (const auto& [name, code] : addresses(plant)) {
    EXPECT_EQ(code == first.at(name), name != "Edited") << name;
  }
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "8");
  EXPECT_EQ(plant.get("Main.b.n"), "4");
}

// New constants go behind those that are there, so that no other POU's code names other places.
TEST(CodeSlots, D2_an_edit_with_new_constants_is_one_slot) {
  Plant plant(source("n := n + 12345;"));
  for (int i = 1; i <= 40; ++i) {
    const auto before = addresses(plant);
    const uint64_t written = plant.controller().code_slots().written();
    const std::string number = std::to_string(20'000 + i * 7);
    plant.change(source("IF n > " + number + " THEN n := " + number + " - n; END_IF"));
    EXPECT_EQ(plant.controller().code_slots().written(), written + 1) << i;
    for (const auto& [name, code] : addresses(plant)) {
      EXPECT_EQ(code == before.at(name), name != "Edited") << name << " " << i;
    }
    plant.accept();
  }
}

// What other POUs name: types in what they copy and refer to, bounds, ranges.
std::string typed_source(const std::string& types, const std::string& variables,
                         const std::string& body) {
  return types +
         "TYPE Row : STRUCT a : INT; b : ARRAY[0..3] OF REAL; END_STRUCT END_TYPE "
         "TYPE Few : INT(0..9); END_TYPE "
         "FUNCTION_BLOCK Edited VAR n : INT; " +
         variables + " END_VAR " + body +
         " END_FUNCTION_BLOCK "
         "FUNCTION_BLOCK Other VAR rows : ARRAY[1..5] OF Row; one : Row; i : INT; f : Few; "
         "r : REF_TO Row; END_VAR i := i MOD 4 + 1; rows[i] := one; f := i; one.b[i - 1] := 2.0; "
         "r := REF(rows[i]); r^.a := f; END_FUNCTION_BLOCK "
         "PROGRAM Main VAR a : Edited; b : Other; many : ARRAY[0..2] OF Other; END_VAR "
         "a(); b(); many[1](); END_PROGRAM";
}

// New types, bounds and ranges take free numbers, and so the tables do not grow with the edits.
TEST(CodeSlots, D2_an_edit_with_new_types_is_one_slot) {
  Plant plant(typed_source("", "", "n := n + 1;"));
  plant.run(1);
  size_t types = 0;
  for (int i = 1; i <= 40; ++i) {
    const auto before = addresses(plant);
    const uint64_t written = plant.controller().code_slots().written();
    const std::string number = std::to_string(i);
    const std::string name = "New" + number;
    // Some edits bring two types and some none, so that numbers become free and are taken again.
    std::string types_text =
        "TYPE " + name + " : STRUCT x : INT(0.." + number + "); END_STRUCT " + "END_TYPE ";
    std::string variables = "v : ARRAY[0.." + number + "] OF " + name + "; ";
    std::string body = "v[n MOD 2].x := 1;";
    if (i % 3 == 1) variables += "w : ARRAY[1..2] OF STRING[" + number + "];";
    if (i % 5 == 0) types_text = variables = body = "";
    plant.change(typed_source(types_text, variables, body + " n := n + " + number + ";"), true);
    EXPECT_EQ(plant.controller().code_slots().written(), written + 1) << i;
    for (const auto& [pou, code] : addresses(plant)) {
      EXPECT_EQ(code == before.at(pou), pou != "Edited") << pou << " " << i;
    }
    plant.run(3);
    plant.accept();
    const ir::Image& image = plant.controller().image();
    if (i == 1) types = image.types.size();
    EXPECT_LE(image.types.size(), types) << i;
    EXPECT_LE(image.bounds.size(), 8u);
    EXPECT_LE(image.ranges.size(), 8u);
  }
  EXPECT_EQ(plant.get("Main.b.i"), "1");
}

// A change back to what runs is none, also where numbers are free.
TEST(CodeSlots, D2_free_type_numbers_stay_free) {
  const std::string with = typed_source("TYPE A : STRUCT x : INT; END_STRUCT END_TYPE ",
                                        "v : ARRAY[0..7] OF A; k : INT;", "v[k].x := n;");
  const std::string without = typed_source("", "", "n := n + 1;");
  Plant plant(with);
  plant.run(2);
  const size_t types = plant.controller().image().types.size();
  plant.change(without, true);
  EXPECT_EQ(plant.controller().image().types.size(), types) << "the others are behind it";
  plant.accept();
  EXPECT_EQ(plant.refused(without), Refusal::kNoChange);
  plant.change(with);
  EXPECT_EQ(plant.controller().image().types.size(), types);
  plant.undo();
  plant.run(1);
}

// However alike they begin, each constant is found again.
TEST(CodeSlots, case53_many_constants_that_begin_alike) {
  std::string text = "PROGRAM Main VAR s : STRING[40]; n : INT; END_VAR n := n + 1;\n";
  for (int i = 0; i < 60; ++i) {
    text += "IF n = " + std::to_string(i) + " THEN s := 'the same beginning, end " +
            std::to_string(i) + "'; END_IF\n";
  }
  text += "END_PROGRAM";
  Plant plant(text);
  EXPECT_EQ(plant.refused(text), Refusal::kNoChange);
  plant.change(text.substr(0, text.size() - 11) +
               "IF n = 99 THEN s := 'another one'; END_IF END_PROGRAM");
  plant.accept();
  const size_t size = plant.controller().image().pool.size();
  plant.change(text);
  EXPECT_EQ(plant.controller().image().pool.size(), size);
}

TEST(CodeSlots, D2_constants_that_nothing_needs_go_in_the_end) {
  Plant plant(source("n := n + 12345;"));
  size_t largest = 0;
  for (int i = 1; i <= 1200; ++i) {
    plant.change(source("n := n + " + std::to_string(20'000 + i) + ";"));
    plant.accept();
    largest = std::max(largest, plant.controller().image().pool.size());
  }
  EXPECT_GT(largest, 4000u);
  EXPECT_LT(largest, 4200u);
  EXPECT_LT(plant.controller().image().pool.size(), largest) << "it began anew";
}

TEST(CodeSlots, D5_inside_the_slack_a_slot_stays) {
  Plant plant(source(repeated("n := n + 1; ", 40)));
  plant.change(source(repeated("n := n + 1; ", 41)));
  plant.accept();
  const uint64_t units = plant.controller().code_slots().total_units();
  plant.change(source(repeated("n := n + 1; ", 43)));
  plant.accept();
  EXPECT_EQ(plant.controller().code_slots().total_units(), units);
  plant.change(source(repeated("n := n + 1; ", 400)));
  plant.accept();
  EXPECT_GT(plant.controller().code_slots().total_units(), units);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "400");
}

TEST(CodeSlots, D5_the_slack_is_what_the_project_says) {
  uint64_t units[3];
  for (size_t i = 0; i < 3; ++i) {
    Settings settings;
    settings.options.code_slack_percent = i * 100;
    Plant plant(source(repeated("n := n + 1; ", 100)), settings);
    units[i] = plant.controller().code_slots().total_units();
    // Of one and a half times the length: inside of a slack of 100 %.
    plant.change(source(repeated("n := n + 1; ", 101)));
    plant.accept();
    const uint64_t both = plant.controller().code_slots().total_units();
    plant.change(source(repeated("n := n + 1; ", 150)));
    plant.accept();
    EXPECT_EQ(plant.controller().code_slots().total_units() > both, i == 0);
    plant.run(1);
    EXPECT_EQ(plant.get("Main.a.n"), "150");
  }
  EXPECT_EQ(units[2] - units[1], units[1] - units[0]);
  EXPECT_GT(units[1], units[0] + units[0] / 2);
}

// What is longer than its slot by one unit gets another one; what fits to the last unit does not.
TEST(CodeSlots, D5_nothing_is_written_behind_the_end_of_a_slot) {
  vm::CodeSlots slots(1u << 20);
  uint32_t number = 0;
  const ir::Unit* running = nullptr;
  const auto place = [&](size_t size) {
    const ir::Unit unit = ir::Unit::extension(++number, 0);
    const std::vector<ir::Unit> code(size, unit);
    running = *slots.place(0, "F", code, running, {});
    EXPECT_EQ(std::memcmp(running, code.data(), size * sizeof(ir::Unit)), 0);
    return running;
  };
  const ir::Unit* const first = place(100);
  const uint64_t capacity = slots.total_units();
  EXPECT_GE(capacity, 125u);
  const ir::Unit* const second = place(100);
  ASSERT_EQ(slots.total_units(), 2 * capacity);
  EXPECT_EQ(place(capacity), first);
  EXPECT_EQ(place(capacity), second);
  EXPECT_EQ(slots.total_units(), 2 * capacity);
  place(capacity + 1);
  EXPECT_GT(slots.total_units(), 2 * capacity + 1);
}

TEST(CodeSlots, D5_beyond_the_limit_is_refused_with_the_amounts) {
  Settings settings;
  settings.options.code_limit = 8192;
  Plant plant(source("n := n + 1;"), settings);
  plant.run(2);
  const base::Digest before = plant.hash();
  const auto first = addresses(plant);
  const base::Status staged = plant.stage(plant.package(source(repeated("n := n + 1; ", 2000))));
  ASSERT_FALSE(staged.ok());
  EXPECT_EQ(staged.error().refusal, Refusal::kTooLarge);
  EXPECT_NE(staged.error().text.find("`Edited` needs a code slot"), std::string::npos)
      << staged.error().text;
  EXPECT_NE(staged.error().text.find("8192"), std::string::npos) << staged.error().text;
  EXPECT_EQ(plant.driver().state(), State::kIdle);
  EXPECT_EQ(plant.hash(), before);
  EXPECT_EQ(addresses(plant), first);
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "3");
  plant.change(source("n := n + 10;"));
  plant.run(1);
  EXPECT_EQ(plant.get("Main.a.n"), "13");
}

// What a slot was before it grew is free again, and the limit is of what there is then.
TEST(CodeSlots, D5_the_limit_can_be_used_to_its_last_byte) {
  const std::string small = source("n := n + 1;");
  const std::string large = source(repeated("n := n + 1; ", 400));
  Plant at_once(small);
  at_once.change(large);
  const uint64_t units = at_once.controller().code_slots().total_units();
  for (const uint64_t missing : {0, 1}) {
    Settings settings;
    settings.options.code_limit = (units - missing) * sizeof(ir::Unit);
    Plant plant(small, settings);
    plant.change(source(repeated("n := n + 1; ", 200)));
    plant.accept();
    plant.change(small);
    plant.accept();
    EXPECT_LT(plant.controller().code_slots().total_units(), units);
    const base::Status staged = plant.stage(plant.package(large));
    ASSERT_EQ(staged.ok(), missing == 0);
    if (staged.ok()) {
      EXPECT_EQ(plant.controller().code_slots().total_units(), units);
    } else {
      EXPECT_EQ(staged.error().refusal, Refusal::kTooLarge);
      EXPECT_NE(staged.error().text.find(std::to_string(sizeof(ir::Unit)) + " too few are free"),
                std::string::npos)
          << staged.error().text;
    }
  }
}

TEST(CodeSlots, D5_case49_ten_thousand_edits_take_no_more_room) {
  const std::string versions[] = {source(repeated("n := 5 - n; ", 3)),
                                  source(repeated("n := 7 - n; ", 30))};
  Plant plant(versions[0]);
  std::map<base::Digest, base::Bytes> packages;
  uint64_t units = 0;
  for (int round = 1; round <= static_cast<int>(10'000 / kOneOf); ++round) {
    base::Bytes& package = packages[plant.controller().verified().digest()];
    if (package.empty()) package = plant.package(versions[round % 2]);
    ASSERT_TRUE(plant.stage(package).ok());
    ASSERT_TRUE(plant.driver().arm(false).ok());
    ASSERT_TRUE(plant.driver().switch_now().ok());
    plant.accept();
    if (round == 2) units = plant.controller().code_slots().total_units();
  }
  EXPECT_EQ(plant.controller().code_slots().total_units(), units);
  EXPECT_LE(packages.size(), 4u);
}

}  // namespace
}  // namespace online_change
