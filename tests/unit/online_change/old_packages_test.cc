// Change packages that older versions made (tests/old_images), on the images that they were made
// for.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "ir/bytecode/symbols.h"
#include "online_change/apply/change.h"
#include "tests/source_path.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/io.h"

namespace {

using online_change::Change;
using online_change::Strategy;

base::Bytes bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void expect_changes(const std::filesystem::path& version, Strategy strategy) {
  const auto image = ir::verify(bytes_of(version / "press_1.image"));
  ASSERT_TRUE(image.ok()) << base::to_string(image.error());
  vm::VirtualClock clock;
  vm::NullIo io;
  auto controller = vm::Controller::start(*image, {}, clock, io);
  ASSERT_TRUE(controller.ok()) << base::to_string(controller.error());
  const auto run = [&](int scans) {
    for (int i = 0; i < scans; ++i) (*controller)->cycle();
  };
  const auto value = [&](const char* path) {
    const auto found = (*controller)->get(path);
    return found.ok() ? *found : found.error().text;
  };
  run(20);
  EXPECT_EQ(value("Main.axes[1].turns"), "20");
  Change change(**controller);
  const base::Status staged = change.stage(bytes_of(version / "press.package"), strategy);
  ASSERT_TRUE(staged.ok()) << base::to_string(staged.error());
  const base::Status armed = change.arm(true, true);
  ASSERT_TRUE(armed.ok()) << base::to_string(armed.error());
  const auto report = change.switch_now();
  ASSERT_TRUE(report.ok()) << base::to_string(report.error());
  EXPECT_EQ(value("Main.axes[2].limits.low"), "20");
  EXPECT_EQ(value("Main.axes[2].limits.centre"), "30.0");
  run(10);
  EXPECT_EQ(value("Main.axes[1].moves"), "30");
  EXPECT_EQ(value("Main.axes[1].place"), "180");
  EXPECT_EQ(value("Main.axes[4].moves"), "0");
  const auto undone = change.undo();
  ASSERT_TRUE(undone.ok()) << base::to_string(undone.error());
  run(1);
  EXPECT_EQ(value("Main.axes[1].turns"), "31");
  EXPECT_EQ(value("Main.p"), "Main.axes[1].turns");
}

TEST(OldPackages, AreCarriedOut) {
  int versions = 0;
  const std::filesystem::path folder = tests::source_path("tests/old_images");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    ++versions;
    SCOPED_TRACE(entry.path().filename().string());
    expect_changes(entry.path(), Strategy::kInPlace);
    expect_changes(entry.path(), Strategy::kStandby);
  }
  EXPECT_GT(versions, 0);
}

}  // namespace
