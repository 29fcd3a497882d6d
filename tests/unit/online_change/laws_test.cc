// Laws over pairs of programs: identity, totality, composition, round trip.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "ir/bytecode/symbols.h"
#include "online_change/plan/every_fate.h"
#include "tests/unit/online_change/plant.h"

namespace online_change {
namespace {

using plant::Plant;

// A random program of a fixed shape: each name is there or not, with one of several types.
std::string random_program(uint32_t seed) {
  std::mt19937 random(seed);
  const char* const kTypes[] = {"INT",
                                "DINT",
                                "LREAL",
                                "BOOL",
                                "STRING[8]",
                                "STRING[20]",
                                "ARRAY[0..5] OF INT",
                                "ARRAY[2..9] OF DINT",
                                "Rec",
                                "ARRAY[1..3] OF Rec",
                                "UINT",
                                "TIME"};
  auto vars = [&](const char* prefix, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      if (random() % 4 == 0) continue;
      text += prefix + std::to_string(i) + " : " + kTypes[random() % std::size(kTypes)] + "; ";
    }
    return text;
  };
  std::string rec = random() % 2 ? "a : INT; b : DINT;" : "b : LINT; z : BOOL; a : INT;";
  std::string blocks;
  for (int i = 0; i < 4; ++i) {
    if (random() % 4 == 0) continue;
    blocks += "f" + std::to_string(i) + " : " + (random() % 2 ? "Box" : "Crate") + "; ";
  }
  return "TYPE Rec : STRUCT " + rec + " END_STRUCT; END_TYPE FUNCTION_BLOCK Box VAR n : INT; " +
         vars("x", 4) +
         " END_VAR n := n + 1; END_FUNCTION_BLOCK FUNCTION_BLOCK Crate VAR b : Box; " +
         vars("y", 3) + " END_VAR b(); END_FUNCTION_BLOCK VAR_GLOBAL g : INT; " + vars("g", 4) +
         " END_VAR PROGRAM Main VAR n : DINT; " + vars("v", 8) + blocks +
         " END_VAR n := n + 1; g := g + 1; END_PROGRAM";
}

// Gives every variable a value of its own.
void scramble(Plant& plant, uint32_t seed) {
  std::mt19937 random(seed);
  ir::for_each_leaf(plant.controller().image(), [&](const std::string& path, const ir::Symbol& s) {
    const ir::TypeTable& types = plant.controller().image().types;
    if (s.constant || s.input) return;
    if (!types.is_scalar(s.type)) {
      plant.set(path, "'t" + std::to_string(random() % 1000) + "'");
    } else if (types[s.type].kind == ir::Kind::kBool) {
      plant.set(path, random() % 2 ? "TRUE" : "FALSE");
    } else if (types[s.type].kind == ir::Kind::kTime) {
      plant.set(path, "T#" + std::to_string(random() % 1000) + "ms");
    } else {
      plant.set(path, std::to_string(random() % 30000));
    }
  });
}

std::map<std::string, std::string> values(Plant& plant) {
  std::map<std::string, std::string> all;
  ir::for_each_leaf(plant.controller().image(), [&](const std::string& path, const ir::Symbol& s) {
    all[path] = plant.controller().image().types.text(s.type) + " " + plant.get(path);
  });
  return all;
}

TEST(Laws, identity_moves_and_changes_nothing) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Plant plant(random_program(seed));
    scramble(plant, seed);
    base::Digest before = plant.hash();
    plant.change(random_program(seed), false, true);  // every instance to a new area
    EXPECT_EQ(plant.hash(), before) << seed;
    EXPECT_EQ(plant.plan().counts.converted + plant.plan().counts.initialised +
                  plant.plan().counts.dropped,
              0u);
    plant.accept();
    plant.run(1);
  }
}

TEST(Laws, totality_every_variable_has_one_fate) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Plant plant(random_program(seed));
    plant.change(random_program(seed + 1000), true);
    uint64_t leaves = 0;
    ir::for_each_leaf(plant.controller().image(),
                      [&](const std::string&, const ir::Symbol&) { ++leaves; });
    const FateCounts& counts = plant.plan().counts;
    EXPECT_EQ(counts.kept + counts.moved + counts.converted + counts.initialised, leaves) << seed;
    uint64_t listed = 0;
    std::set<std::string> paths;
    for (const FateRow& row : plant.plan().fates) {
      if (row.fate != Fate::kKept) listed += row.count;
      EXPECT_FALSE(row.path.empty());
      EXPECT_TRUE(paths.insert(row.path + fate_name(row.fate)).second) << row.path;
    }
    EXPECT_EQ(listed, counts.total() - counts.kept) << seed;
  }
}

// X1: one entry for each variable of either version, and they add up to the counts.
TEST(Laws, X1_totality_variable_by_variable) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Plant plant(random_program(seed));
    const ir::VerifiedImage before = plant.controller().verified();
    plant.change(random_program(seed + 1000), true);
    const ir::Image& after = plant.controller().image();
    const EveryFate every(plant.plan(), before.image(), after);
    std::map<Fate, uint64_t> found;
    std::set<std::string> paths;
    std::set<std::string> new_paths;
    every.visit_from(0, [&](const VariableFate& variable) {
      ++found[variable.fate];
      EXPECT_TRUE(paths.insert(variable.path).second) << variable.path;
      if (variable.new_address != 0) new_paths.insert(variable.path);
      if (variable.fate == Fate::kKept) {
        EXPECT_EQ(variable.old_address, variable.new_address) << variable.path;
      }
      return true;
    });
    const FateCounts& counts = plant.plan().counts;
    EXPECT_EQ(found[Fate::kKept], counts.kept) << seed;
    EXPECT_EQ(found[Fate::kMoved], counts.moved) << seed;
    EXPECT_EQ(found[Fate::kConverted], counts.converted) << seed;
    EXPECT_EQ(found[Fate::kInitialised], counts.initialised) << seed;
    uint64_t old_leaves = 0;
    uint64_t gone = 0;
    ir::for_each_leaf(before.image(), [&](const std::string& path, const ir::Symbol&) {
      ++old_leaves;
      gone += new_paths.contains(path) ? 0 : 1;
    });
    EXPECT_EQ(found[Fate::kDropped], gone) << seed;
  }
}

// Pages are what one reading is, wherever they end.
TEST(Laws, X1_pages_of_variables_are_the_whole) {
  Plant plant(random_program(3));
  const ir::VerifiedImage before = plant.controller().verified();
  plant.change(random_program(1003), true);
  const EveryFate every(plant.plan(), before.image(), plant.controller().image());
  std::vector<std::string> whole;
  every.visit_from(0, [&](const VariableFate& variable) {
    whole.push_back(variable.path + fate_name(variable.fate));
    return true;
  });
  ASSERT_GT(whole.size(), 10u);
  for (size_t size = 1; size <= whole.size(); ++size) {
    std::vector<std::string> pages;
    uint64_t next = 0;
    do {
      size_t room = size;
      next = every.visit_from(next, [&](const VariableFate& variable) {
        pages.push_back(variable.path + fate_name(variable.fate));
        return --room != 0;
      });
    } while (next != 0);
    EXPECT_EQ(pages, whole) << size;
  }
}

TEST(Laws, round_trip_restores_every_bit) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    Plant plant(random_program(seed));
    scramble(plant, seed);
    base::Digest before = plant.hash();
    plant.change(random_program(seed + 1000), true);
    plant.undo();
    EXPECT_EQ(plant.hash(), before) << seed;
  }
}

TEST(Laws, unchanged_variables_keep_their_values) {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    Plant plant(random_program(seed));
    scramble(plant, seed);
    std::map<std::string, std::string> before = values(plant);
    plant.change(random_program(seed + 1000), true);
    for (const auto& [path, value] : values(plant)) {
      auto old = before.find(path);
      if (old == before.end()) continue;
      std::string type = value.substr(0, value.find(' '));
      // Same path and type, and no owner of another type on the way.
      bool same = old->second.substr(0, old->second.find(' ')) == type;
      bool initialised = false;
      for (const FateRow& row : plant.plan().fates) {
        if (row.fate == Fate::kInitialised && path.rfind(row.path, 0) == 0) initialised = true;
      }
      if (same && !initialised) {
        EXPECT_EQ(value, old->second) << seed << " " << path;
      }
    }
  }
}

TEST(Laws, composition_equals_the_direct_change) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Plant two_steps(random_program(seed));
    Plant direct(random_program(seed));
    scramble(two_steps, seed);
    scramble(direct, seed);
    // Q has everything that P has, in other places: nothing is lost on the way.
    two_steps.change(random_program(seed), false, true);
    two_steps.accept();
    two_steps.change(random_program(seed + 1000), true);
    direct.change(random_program(seed + 1000), true);
    EXPECT_EQ(two_steps.hash(), direct.hash()) << seed;
  }
}

TEST(Laws, identity_change_at_every_scan_leaves_the_trace_alone) {
  const char* const kSource =
      "FUNCTION_BLOCK Box VAR t : TON; c : CTU; n : INT; END_VAR n := n + 1; "
      "t(IN := n MOD 7 <> 0, PT := T#30ms); c(CU := t.Q, PV := 3); END_FUNCTION_BLOCK "
      "PROGRAM Main VAR b : ARRAY[1..3] OF Box; k : INT; END_VAR "
      "b[1](); b[2](); IF k MOD 2 = 0 THEN b[3](); END_IF k := k + 1; END_PROGRAM";
  Plant reference(kSource);
  Plant plant(kSource);
  for (int scan = 0; scan < 30; ++scan) {
    reference.run(1);
    plant.run(1);
    ASSERT_EQ(plant.hash(), reference.hash()) << scan;
    plant.change(kSource, false, true);
    if (scan % 3 == 0) {
      plant.undo();
    } else {
      plant.accept();
    }
    ASSERT_EQ(plant.hash(), reference.hash()) << scan;
  }
}

}  // namespace
}  // namespace online_change
