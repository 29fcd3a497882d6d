#include "tools/stc/build.h"

#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "ir/program/verify.h"
#include "linker/link.h"
#include "tools/common/files.h"
#include "tools/stc/importer.h"

namespace stc {

namespace {

base::Error source_errors(const base::Diagnostics& diagnostics) {
  return {base::Refusal::kSourceErrors, std::to_string(diagnostics.error_count()) + " error(s)"};
}

base::Result<Compiled> lower_all(ir::Program program) {
#ifndef NDEBUG
  base::Status sound = ir::verify(program);
  if (!sound.ok()) return sound.error();
#endif
  Compiled out{std::move(program), {}};
  out.objects.reserve(out.program.pous.size());
  for (uint32_t i = 0; i < out.program.pous.size(); ++i) {
    base::Result<ir::Object> object = ir::lower(out.program, ir::PouId(i));
    if (!object.ok()) return object.error();
    out.objects.push_back(std::move(*object));
  }
  return out;
}

base::Result<Version> link(const Compiled& compiled, const Project& project,
                           const BuildOptions& options) {
  linker::Options link_options{project.slack, options.base, options.move_all, project.devices,
                               project.safe.rows};
  base::Result<ir::Image> image = linker::link(compiled.program, compiled.objects, link_options);
  if (!image.ok()) return image.error();
  base::Status safe = check_safe_settings(project.safe, image->output_bytes);
  if (!safe.ok()) return safe.error();
  Version out{std::move(*image), {}};
  out.bytes = ir::encode(out.image);
  return out;
}

}  // namespace

base::Result<Compiled> compile(const Project& project, base::Diagnostics& diagnostics) {
  add_findings(diagnostics, project.imported, false);
  if (diagnostics.has_errors()) return source_errors(diagnostics);
  std::optional<ir::Program> program =
      frontend::compile(project.sources, project.compile, diagnostics);
  if (!program) return source_errors(diagnostics);
  return lower_all(std::move(*program));
}

base::Result<Version> build(const Project& project, const BuildOptions& options,
                            base::Diagnostics& diagnostics) {
  base::Result<Compiled> compiled = compile(project, diagnostics);
  if (!compiled.ok()) return compiled.error();
  return link(*compiled, project, options);
}

base::Result<TestVersion> build_tests(const Project& project, base::Diagnostics& diagnostics) {
  add_findings(diagnostics, project.imported, false);
  if (diagnostics.has_errors()) return source_errors(diagnostics);
  std::optional<frontend::TestProgram> tests =
      frontend::compile_tests(project.sources, project.compile, diagnostics);
  if (!tests) return source_errors(diagnostics);
  base::Result<Compiled> compiled = lower_all(std::move(tests->program));
  if (!compiled.ok()) return compiled.error();
  base::Result<Version> version = link(*compiled, project, {});
  if (!version.ok()) return version.error();
  return TestVersion{std::move(*version), std::move(tests->cases)};
}

base::Result<Version> read_image(const std::string& path) {
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  if (!bytes.ok()) return bytes.error();
  base::Result<ir::Image> image = ir::decode(*bytes);
  if (!image.ok()) {
    return base::Error{image.error().refusal, path + ": " + image.error().text};
  }
  return Version{std::move(*image), std::move(*bytes)};
}

bool is_image(const std::string& path) {
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  return bytes.ok() && ir::has_image_magic(*bytes);
}

}  // namespace stc
