// The compiler as a straight line: sources -> program -> objects -> image. Every
// command of stc that needs a program comes through here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"
#include "tools/stc/project.h"

namespace stc {

struct Compiled {
  ir::Program program;
  std::vector<ir::Object> objects;  // of its POUs; of several resources, those that it can reach
};

// kSourceErrors, with their number.
base::Error source_errors(const base::Diagnostics& diagnostics);

// kSourceErrors when `diagnostics` got errors; they are the message.
base::Result<Compiled> compile(const Project& project, base::Diagnostics& diagnostics);

struct Version {
  ir::Image image;
  base::Bytes bytes;  // encoded
};

struct BuildOptions {
  const ir::Image* base = nullptr;
  bool move_all = false;
  bool matching = false;  // of a fleet file: only the units that fit (E-13)
  std::optional<size_t> step = std::nullopt;  // of a fleet file that comes in several (E-25)
};
// One resource: the one that the project's options name, else that of the base, else the first.
base::Result<Version> build(const Project& project, const BuildOptions& options,
                            base::Diagnostics& diagnostics);

// Each resource, or only the one that the options name or the base is of.
struct ResourceVersion {
  std::string resource;  // "" where the project has one at most
  base::SourceSpan declared;
  Version version;
};
base::Result<std::vector<ResourceVersion>> build_resources(const Project& project,
                                                           const BuildOptions& options,
                                                           base::Diagnostics& diagnostics);

// The TEST blocks of a project, one program instance each (frontend/compile.h).
struct TestVersion {
  Version version;
  std::vector<frontend::TestCase> cases;
};
base::Result<TestVersion> build_tests(const Project& project, base::Diagnostics& diagnostics);
// The only task of a test image runs the tests.
std::vector<ir::Device> without_lost_tasks(std::vector<ir::Device> devices);

// An error of linking, with the place of the device that it is about.
base::Error with_place(base::Error error, const std::vector<ProjectDevice>& devices);

base::Result<Version> read_image(const std::string& path);
// Is this file an image (by its magic)?
bool is_image(const std::string& path);

}  // namespace stc
