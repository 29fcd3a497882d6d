// The bottling line of examples/: a change of the running plant keeps every value that its report
// says it keeps.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "ir/bytecode/symbols.h"
#include "tests/source_path.h"
#include "tests/unit/online_change/plant.h"

namespace plant {
namespace {

std::string sources(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(tests::source_path("examples/" + folder))) {
    if (entry.path().extension() == ".st") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::string all;
  for (const auto& file : files) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    all += text.str() + "\n";
  }
  return all;
}

std::map<std::string, std::string> values(Plant& plant) {
  std::map<std::string, std::string> out;
  std::istringstream state(
      ir::state_text(plant.controller().image(), plant.controller().memory().view()));
  for (std::string line; std::getline(state, line);) {
    size_t equals = line.find('=');
    out[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return out;
}

TEST(BottlingLine, A1_A14_X1_change_keeps_what_its_report_says) {
  Plant plant(sources("bottling_line"));
  plant.run(4000);
  std::map<std::string, std::string> before = values(plant);
  base::Digest hash = plant.hash();
  ASSERT_NE(before["BottlesFilled"], "0") << "bottles must move";
  plant.change(sources("bottling_line_v2"), true);
  std::map<std::string, std::string> after = values(plant);

  const online_change::FateCounts& counts = plant.plan().counts;
  uint64_t same = 0;
  uint64_t other = 0;
  for (const auto& [path, value] : after) {
    auto found = before.find(path);
    if (found == before.end()) continue;
    (found->second == value ? same : other) += 1;
    if (found->second == value) continue;
    // Only a retyped variable may look different: 250 became 250.0.
    EXPECT_DOUBLE_EQ(std::stod(found->second), std::stod(value)) << path;
  }
  EXPECT_LE(other, counts.converted);
  EXPECT_GE(same, counts.kept + counts.moved);
  EXPECT_EQ(same + other, counts.kept + counts.moved + counts.converted);
  EXPECT_EQ(after.size(), counts.kept + counts.moved + counts.converted + counts.initialised);
  EXPECT_EQ(before.size(), counts.kept + counts.moved + counts.converted + counts.dropped);

  plant.undo();
  EXPECT_EQ(plant.hash(), hash) << "undone at once, every bit is back (D3)";
  plant.change(sources("bottling_line_v2"), true);
  plant.run(500);
  plant.undo();
  plant.run(500);
  EXPECT_GE(std::stoi(plant.get("BottlesFilled")), std::stoi(before["BottlesFilled"]));
}

}  // namespace
}  // namespace plant
