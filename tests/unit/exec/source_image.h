// From source to an image, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "linker/link.h"

namespace sample {

enum class Optimised { kNo, kYes };

// Errors fail the test. `base`: the version before, whose places stay.
inline ir::Image build(const std::string& source, const ir::Image* base = nullptr,
                       Optimised optimised = Optimised::kNo) {
  base::SourceMap sources;
  sources.add("test.st", source);
  base::Diagnostics diagnostics;
  auto program = frontend::compile(sources, {}, diagnostics);
  EXPECT_TRUE(program.has_value()) << source;
  if (!program) return {};
  if (optimised == Optimised::kYes) {
    EXPECT_TRUE(ir::optimise(*program, ir::PassSet::all(), false).ok());
  }
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program->pous.size(); ++i) {
    auto object = ir::lower(*program, ir::PouId(i));
    EXPECT_TRUE(object.ok()) << (object.ok() ? "" : object.error().text);
    if (object.ok()) objects.push_back(std::move(*object));
  }
  linker::Options options;
  options.base = base;
  auto image = linker::link(*program, objects, options);
  EXPECT_TRUE(image.ok()) << (image.ok() ? "" : image.error().text);
  return image.ok() ? std::move(*image) : ir::Image{};
}

}  // namespace sample
