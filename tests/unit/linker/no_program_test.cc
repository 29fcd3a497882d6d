// case56: what a controller holds when no stored program is intact.
#include "ir/bytecode/no_program.h"
#include "tests/unit/linker/linked.h"

namespace linker {
namespace {

TEST(NoProgram, case56_IsWhatTheLinkerMakesOfNothing) {
  ir::Program nothing;
  nothing.name = "no program";
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  nothing.globals = nothing.types.declare(std::move(globals));
  Options options;
  options.slack = {0, 0, 0, 0, 0, 0, 0, 0};
  const base::Result<ir::Image> image = link(nothing, {}, options);
  ASSERT_TRUE(image.ok()) << base::to_string(image.error());
  EXPECT_EQ(ir::encode(*image), ir::no_program().encoded());
  EXPECT_TRUE(ir::is_no_program(*image));
}

}  // namespace
}  // namespace linker
