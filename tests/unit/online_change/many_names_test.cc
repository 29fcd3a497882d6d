// Names of images with many variables (ir/bytecode/name_index.h).
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <iterator>

#include "ir/bytecode/leaf_walk.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/variable_names.h"
#include "tests/source_path.h"
#include "tests/unit/online_change/instructions.h"
#include "tests/unit/online_change/plant.h"

namespace {

using plant::Plant;

std::string text_of(const std::string& file) {
  std::ifstream in(tests::source_path(file));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

void expect_same(const ir::NameIndex& names, const std::string& path) {
  const base::Result<ir::Symbol> walked = ir::find_symbol(names.image(), path);
  const base::Result<ir::Symbol> looked = ir::find_symbol(names, path);
  ASSERT_EQ(walked.ok(), looked.ok()) << path;
  if (!walked.ok()) {
    EXPECT_EQ(walked.error().text, looked.error().text);
    return;
  }
  EXPECT_TRUE(ir::same_place(*walked, *looked)) << path;
  EXPECT_EQ(walked->type, looked->type) << path;
  EXPECT_EQ(walked->constant, looked->constant) << path;
}

// Lists, static variables, overlapping addresses, access paths, programs that are called, large
// types: whatever has a name of its own kind.
TEST(Names, AreFoundInTheTableAsByAWalk) {
  std::string large = "TYPE Large : STRUCT ";
  for (int i = 0; i < 40; ++i) large += "m" + std::to_string(i) + " : INT; ";
  large +=
      "END_STRUCT END_TYPE PROGRAM Main VAR a : Large; b : ARRAY[1..2] OF Large; END_VAR "
      "a.m39 := 1; END_PROGRAM";
  std::vector<std::string> sources = {large, text_of("tests/fuzz/every_table.st")};
  // `global_lists.x` is a variable of the list that is this file.
  std::string lists = text_of("tests/golden/run/global_lists.st");
  for (size_t at = lists.find("global_lists"); at != lists.npos; at = lists.find("global_lists")) {
    lists.replace(at, 12, "test");
  }
  sources.push_back(lists);
  for (const char* file : {"static_variables", "overlapping_addresses",
                           "shared_by_instances", "union_extends"}) {
    sources.push_back(text_of("tests/golden/run/" + std::string(file) + ".st"));
  }
  size_t found = 0;
  for (const std::string& source : sources) {
    // The table of two versions in one file: the first.
    Plant plant(source.substr(0, source.find("// --- v2")));
    const ir::Image& image = plant.controller().image();
    const ir::NameIndex names(image);
    ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol&) {
      ++found;
      for (std::string wanted : {path, upper(path), path + ".x", path + "[1]", path + "q"}) {
        expect_same(names, wanted);
        for (size_t end = wanted.find_last_of(".["); end != wanted.npos && end != 0;
             end = wanted.find_last_of(".[", end - 1)) {
          expect_same(names, wanted.substr(0, end));
        }
      }
    });
    for (const ir::AccessPath& access : image.access) {
      expect_same(names, access.name);
      expect_same(names, upper(access.name));
    }
    for (const char* wrong : {"", ".", "[", "nothing", "nothing.at.all", "a..b", "Main", "Main."}) {
      expect_same(names, wrong);
    }
  }
  EXPECT_GT(found, 200u);
}

// What looking for one name takes does not grow with the names.
TEST(Names, OneOfManyCostsNoWalk) {
  const auto instructions = [](int globals) {
    std::string source = "VAR_GLOBAL ";
    for (int i = 0; i < globals; ++i) source += "level_" + std::to_string(i) + " : INT; ";
    Plant plant(source + "END_VAR PROGRAM Main level_0 := 1; END_PROGRAM");
    const ir::NameIndex& names = plant.controller().verified().names();
    const std::string last = "level_" + std::to_string(globals - 1);
    return plant::count_instructions([&] { (void)ir::named_symbol(names, last).ok(); });
  };
  const auto few = instructions(200);
  const auto many = instructions(8000);
  if (!few || !many) GTEST_SKIP() << "one process may not trace another here";
  EXPECT_LT(*many, 2 * *few);
}

}  // namespace
