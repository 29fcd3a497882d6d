#include "tools/stc/watch.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <thread>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/stc/image_output.h"
#include "tools/stc/importer.h"
#include "tools/stc/session.h"
#include "workspace/incremental_build.h"

namespace stc {
namespace {

using Clock = std::chrono::steady_clock;

// Looking takes a tenth of the time at most, and happens often enough for people.
constexpr auto kLookEvery = std::chrono::milliseconds(30);
constexpr int kRest = 10;

// What tells one content of a file from the next.
struct Stamp {
  int64_t seconds = -1;  // -1: there is no such file
  int64_t ns = 0;
  int64_t bytes = 0;
  uint64_t file = 0;
  friend bool operator==(const Stamp&, const Stamp&) = default;
};
using Stamps = std::map<std::string, Stamp>;

Stamp stamp_of(const std::string& path) {
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_size, found.st_ino};
}

class Watch {
 public:
  Watch(const tools::Options& options, Project project, const BuildOptions& build_options,
        base::DiagnosticFormat format)
      : options_(options),
        project_(std::move(project)),
        build_options_(build_options),
        format_(format) {}

  int run() {
    stamps_ = look();
    begin_anew();
    for (;;) {
      build();
      wait();
    }
  }

 private:
  bool with_line() const {
    return format_ == base::DiagnosticFormat::kText && !options_.has("--quiet");
  }

  // Every file that a build may read: those of the project, and what has come into its folders.
  Stamps look() const {
    Stamps found;
    const auto add = [&](const base::Result<std::vector<std::string>>& files) {
      if (!files.ok()) return;
      for (const std::string& file : *files) found.emplace(file, stamp_of(file));
    };
    for (const std::string& path : options_.arguments()) {
      found.emplace(path, stamp_of(path));
      if (!std::filesystem::is_directory(path)) continue;
      found[path] = {};  // a folder's own time says nothing about its files
      const std::string settings = (std::filesystem::path(path) / "stc.toml").string();
      found.emplace(settings, stamp_of(settings));
      add(source_files(path));
      add(importable_files(path, false));
    }
    for (uint32_t file = 0; file < project_.sources.file_count(); ++file) {
      const std::string name(project_.sources.file_name(file));
      if (!found.contains(name)) found.emplace(name, stamp_of(name));
    }
    return found;
  }

  // Until something has changed, and the project is what the files say now.
  void wait() {
    for (;;) {
      const auto begin = Clock::now();
      Stamps now = look();
      if (now != stamps_) {
        saved_ = begin;
        const Stamps before = std::exchange(stamps_, std::move(now));
        if (!take_texts(before)) reload();
        return;
      }
      const auto rest = std::max<Clock::duration>(kLookEvery, kRest * (Clock::now() - begin));
      std::this_thread::sleep_for(rest);
    }
  }

  // The new texts of source files that are known; false: something else has changed.
  bool take_texts(const Stamps& before) {
    std::map<std::string, std::string> texts;
    for (const auto& [path, stamp] : stamps_) {
      const auto old = before.find(path);
      if (old == before.end() || is_importable(path)) return false;
      if (old->second == stamp) continue;
      base::Result<std::string> text = tools::read_text(path);
      if (!text.ok() || text->find('\0') != std::string::npos) return false;
      texts.emplace(path, std::move(*text));
    }
    if (stamps_.size() != before.size()) return false;
    saved_files_.clear();
    for (uint32_t file = 0; file < project_.sources.file_count(); ++file) {
      const auto found = texts.find(std::string(project_.sources.file_name(file)));
      if (found == texts.end() || !project_.sources.is_source(file)) continue;
      project_.sources.replace(file, std::move(found->second));
      saved_files_.push_back(file);
    }
    return saved_files_.size() == texts.size();
  }

  // Settings, or which files there are.
  void reload() {
    base::Result<Project> project = open_project(options_, options_.arguments());
    broken_ = !project.ok();
    if (broken_) {
      tools::refuse("stc", project.error());
      return;
    }
    project_ = std::move(*project);
    stamps_ = look();
    begin_anew();
  }

  void begin_anew() {
    workspace::Settings settings;
    settings.compile = project_.compile;
    settings.passes = project_.passes;
    settings.jobs = project_.jobs;
    settings.link.slack = project_.slack;
    settings.link.base = build_options_.base;
    settings.link.move_all = build_options_.move_all;
    settings.link.safe = project_.safe.rows;
    settings.link.jobs = project_.jobs;
    auto devices = devices_of(project_.devices, {}, {});
    broken_ = !devices.ok();
    if (broken_) {
      tools::refuse("stc", devices.error());
      return;
    }
    settings.link.devices = std::move(*devices);
    several_ = false;
    build_ = std::make_unique<workspace::IncrementalBuild>(std::move(settings));
  }

  void build() {
    if (broken_) return;
    const workspace::Counts before = build_->counts();
    base::Diagnostics diagnostics;
    const base::Status done = build_into(diagnostics);
    report(project_, diagnostics, format_);
    if (!done.ok()) {
      tools::refuse("stc", done.error());
      return;
    }
    if (!with_line()) return;
    const workspace::Counts& now = build_->counts();
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - saved_).count();
    const uint64_t bodies = now.lowered - before.lowered;
    const std::string what = now.edits == before.edits ? "everything"
                             : bodies == 1             ? "1 POU"
                                                       : std::to_string(bodies) + " POUs";
    std::fprintf(stderr, "built %s in %.0f ms\n", what.c_str(), ms);
  }

  base::Status build_into(base::Diagnostics& diagnostics) {
    add_findings(diagnostics, project_.imported, false);
    if (!diagnostics.has_errors() && !several_) {
      auto image = build_->build(project_.sources, saved_files_, diagnostics);
      if (image.ok()) return write(**image);
      several_ = image.error().refusal == base::Refusal::kUsage;
      if (!several_) return with_place(image.error(), project_.devices);
    }
    base::Diagnostics anew;  // the findings are among them
    auto versions = build_resources(project_, build_options_, anew);
    diagnostics = std::move(anew);
    if (!versions.ok()) return versions.error();
    return write_images(*versions, output(), project_.name, with_line());
  }

  std::string output() const { return options_.text("--output", project_.name + ".img"); }

  base::Status write(const ir::Image& image) {
    base::Status safe = check_safe_settings(project_.safe, image.output_bytes);
    if (!safe.ok()) return safe;
    base::Bytes bytes = ir::encode(image);
    if (bytes == written_) return base::Ok{};
    base::Result<std::string> path = image_path(output(), {}, project_.name);
    if (!path.ok()) return path.error();
    base::Status written = write_image(*path, image, bytes, with_line());
    if (written.ok()) written_ = std::move(bytes);
    return written;
  }

  const tools::Options& options_;
  Project project_;
  BuildOptions build_options_;
  base::DiagnosticFormat format_;
  std::unique_ptr<workspace::IncrementalBuild> build_;
  Stamps stamps_;
  std::vector<uint32_t> saved_files_;  // since the last build, when it was not begun anew
  base::Bytes written_;
  Clock::time_point saved_ = Clock::now();
  bool several_ = false;  // RESOURCEs
  bool broken_ = false;   // the files cannot be read as a project; what is wrong was said
};

}  // namespace

int watch(const tools::Options& options, Project project, const BuildOptions& build_options,
          base::DiagnosticFormat format) {
  return Watch(options, std::move(project), build_options, format).run();
}

}  // namespace stc
