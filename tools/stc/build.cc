#include "tools/stc/build.h"

#include <algorithm>

#include "frontend/compile.h"
#include "ir/bytecode/verify.h"
#include "ir/lower/lower.h"
#include "ir/opt/optimise.h"
#include "ir/program/verify.h"
#include "linker/link.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"
#include "tools/stc/embed.h"
#include "tools/stc/importer.h"
#include "tools/stc/memory_budget.h"

namespace stc {

base::Error source_errors(const base::Diagnostics& diagnostics) {
  return {base::Refusal::kSourceErrors, std::to_string(diagnostics.error_count()) + " error(s)"};
}

namespace {

enum class Bodies { kKept, kDropped };  // of the program, when there are objects

// Without the POUs in `left_out`, by PouId.
base::Result<Compiled> to_objects(ir::Program program, const Project& project, Bodies bodies,
                                  const std::vector<bool>& left_out = {}) {
#ifdef NDEBUG
  constexpr bool verify_each = false;
#else
  constexpr bool verify_each = true;
  base::Status sound = ir::verify(program);
  if (!sound.ok()) return sound.error();
#endif
  base::Status optimised = ir::optimise(program, project.passes, verify_each, project.jobs);
  if (!optimised.ok()) return optimised.error();
  base::Result<std::vector<ir::Object>> objects =
      bodies == Bodies::kKept ? ir::lower_all(program, left_out, project.jobs)
                              : ir::lower_all_away(program, left_out, project.jobs);
  if (!objects.ok()) return objects.error();
  return Compiled{std::move(program), std::move(*objects)};
}

// Safe values of outputs that another resource has are left out when `several` are built.
base::Result<Version> link(const Compiled& compiled, const Project& project,
                           std::vector<ir::Device> devices, bool several,
                           const BuildOptions& options, const Embedding& embedding) {
  linker::Options link_options{project.slack,      options.base,      options.move_all,
                               std::move(devices), project.safe.rows, project.units.members(),
                               project.jobs};
  base::Result<ir::Image> image = linker::link(compiled.program, compiled.objects, link_options);
  if (!image.ok()) return with_place(image.error(), project.devices);
  if (several) {
    image->safe = safe_rows_inside(project.safe, image->output_bytes);
  } else if (base::Status safe = check_safe_settings(project.safe, image->output_bytes);
             !safe.ok()) {
    return safe.error();
  }
  Version out{std::move(*image), {}};
  embedding.name_files(out.image);
  out.bytes = embedding.encode(out.image, nullptr).bytes;
  return out;
}

// "Plant.Line" of several resources.
std::string resource_of(const ir::Image* base) {
  if (base == nullptr) return {};
  const size_t dot = base->name.rfind('.');
  return dot == std::string::npos ? std::string() : base->name.substr(dot + 1);
}

}  // namespace

std::vector<ir::Device> without_lost_tasks(std::vector<ir::Device> devices) {
  for (ir::Device& device : devices) {
    std::erase_if(device.settings, [](const ir::DeviceSetting& setting) {
      return setting.key == "on_loss" && setting.value.starts_with("trap ");
    });
  }
  return devices;
}

base::Error with_place(base::Error error, const std::vector<ProjectDevice>& devices) {
  for (const ProjectDevice& row : devices) {
    const bool about = error.refusal == base::Refusal::kBadMapping &&
                       error.text.starts_with("device `" + row.device.name + "`: ");
    if (about) return {error.refusal, row.where + ": " + error.text};
  }
  return error;
}

base::Result<Compiled> compile(const Project& project, base::Diagnostics& diagnostics) {
  add_findings(diagnostics, project.imported, false);
  if (diagnostics.has_errors()) return source_errors(diagnostics);
  std::optional<ir::Program> program =
      frontend::compile(project.sources, project.compile, diagnostics);
  if (!program) return source_errors(diagnostics);
  return to_objects(std::move(*program), project, Bodies::kKept);
}

base::Result<std::vector<ResourceVersion>> build_resources(const Project& project,
                                                           const BuildOptions& options,
                                                           base::Diagnostics& diagnostics) {
  add_findings(diagnostics, project.imported, false);
  if (diagnostics.has_errors()) return source_errors(diagnostics);
  frontend::CompileOptions compile_options = project.compile;
  compile_options.likely_resource = resource_of(options.base);
  std::optional<frontend::Resources> resources =
      frontend::compile_resources(project.sources, compile_options, diagnostics);
  if (!resources) return source_errors(diagnostics);
  base::Result<Embedding> embedding = Embedding::of(project);
  if (!embedding.ok()) return embedding.error();
  const bool several = !resources->names.empty();
  std::vector<ResourceVersion> versions;
  uint32_t output_bytes = 0;
  for (frontend::ResourceProgram& made : resources->programs) {
    base::Result<Compiled> compiled =
        to_objects(std::move(made.program), project, Bodies::kDropped, made.other_code);
    if (!compiled.ok()) return compiled.error();
    auto devices = devices_of(project.devices, made.resource, resources->names);
    if (!devices.ok()) return devices.error();
    base::Result<Version> version =
        link(*compiled, project, std::move(*devices), several, options, *embedding);
    if (!version.ok()) return version.error();
    output_bytes = std::max(output_bytes, version->image.output_bytes);
    versions.push_back({std::move(made.resource), made.declared, std::move(*version)});
  }
  if (several && versions.size() != resources->names.size()) return versions;
  if (base::Status safe = check_safe_settings(project.safe, output_bytes); several && !safe.ok()) {
    return safe.error();
  }
  std::vector<const ir::Image*> images;
  for (const ResourceVersion& row : versions) images.push_back(&row.version.image);
  if (base::Status units = check_unit_settings(project.units, images); !units.ok()) {
    return units.error();
  }
  return versions;
}

base::Result<Version> build(const Project& project, const BuildOptions& options,
                            base::Diagnostics& diagnostics) {
  auto versions = build_resources(project, options, diagnostics);
  if (!versions.ok()) return versions.error();
  if (versions->size() > 1) {
    const ResourceVersion& other = (*versions)[1];
    diagnostics.add(base::DiagnosticCode::kResourceChosen, other.declared,
                    "RESOURCE `" + versions->front().resource + "` is taken, `" + other.resource +
                        "` is left out",
                    "say which one is meant: --resource NAME");
    if (diagnostics.has_errors()) return source_errors(diagnostics);
  }
  return std::move(versions->front().version);
}

base::Result<TestVersion> build_tests(const Project& project, base::Diagnostics& diagnostics) {
  add_findings(diagnostics, project.imported, false);
  if (diagnostics.has_errors()) return source_errors(diagnostics);
  std::optional<frontend::TestProgram> tests =
      frontend::compile_tests(project.sources, project.compile, diagnostics);
  if (!tests) return source_errors(diagnostics);
  base::Result<Compiled> compiled =
      to_objects(std::move(tests->program), project, Bodies::kDropped);
  if (!compiled.ok()) return compiled.error();
  auto devices = devices_of(project.devices, {}, {});
  if (!devices.ok()) return devices.error();
  base::Result<Version> version =
      link(*compiled, project, without_lost_tasks(std::move(*devices)), false, {}, {});
  if (!version.ok()) return version.error();
  return TestVersion{std::move(*version), std::move(tests->cases)};
}

base::Result<Version> read_image(const std::string& path) {
  base::Result<base::Bytes> bytes = tools::read_content(path);
  if (!bytes.ok()) return bytes.error();
  expect_input(bytes->size());
  const base::Result<ir::VerifiedImage> image = ir::verify(*bytes);
  if (!image.ok()) {
    return base::Error{image.error().refusal, path + ": " + image.error().text};
  }
  return Version{image->image(), std::move(*bytes)};
}

bool is_image(const std::string& path) {
  if (tools::is_signed_as(path, online_change::SignedKind::kImage)) return true;
  base::Result<base::Bytes> first = tools::read_first(path, ir::kImageMagic.size());
  return first.ok() && ir::has_image_magic(*first);
}

}  // namespace stc
