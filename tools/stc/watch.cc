#include "tools/stc/watch.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/stc/file_stamp.h"
#include "tools/stc/importer.h"
#include "tools/stc/session.h"
#include "workspace/incremental_build.h"

namespace stc {
namespace {

using Clock = std::chrono::steady_clock;

// Looking takes a tenth of the time at most, and happens often enough for people.
constexpr auto kLookEvery = std::chrono::milliseconds(30);
constexpr int kRest = 10;
constexpr auto kLongestLook = std::chrono::seconds(10);

using Stamps = std::map<std::string, FileStamp>;
using Next = WatchTarget::Next;

class Watch {
 public:
  Watch(const tools::Options& options, Project project, bool move_all,
        base::DiagnosticFormat format, WatchTarget& target)
      : options_(options),
        project_(std::move(project)),
        move_all_(move_all),
        format_(format),
        target_(target) {}

  int run() {
    stamps_ = look();
    begin_anew();
    for (;;) {
      const Next next = build();
      if (next == Next::kEnd) return tools::kOk;
      if (next == Next::kBase) build_->continue_from(target_.base());
      if (next == Next::kOtherBase) begin_anew();
      if (next == Next::kAgain || next == Next::kOtherBase) {
        saved_files_.clear();
        look_again();
      } else if (!wait()) {
        return tools::kOk;
      }
    }
  }

 private:
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

  // Until something has changed, and the project is what the files say now. False: nobody waits
  // for it any more.
  bool wait() {
    for (;;) {
      const auto begin = Clock::now();
      if (look_again()) return true;
      const auto rest = std::max<Clock::duration>(kLookEvery, kRest * (Clock::now() - begin));
      if (!target_.rest(rest)) return false;
    }
  }

  bool look_again() {
    const auto begin = Clock::now();
    Stamps now = look();
    if (now == stamps_) return false;
    seen_ = begin;
    const Stamps before = std::exchange(stamps_, std::move(now));
    saved_ = save_of(before);
    if (broken_ || !take_texts(before)) reload();
    return true;
  }

  // When the last of the files that differ was saved, as far as that can be known.
  Clock::time_point save_of(const Stamps& before) const {
    int64_t last = 0;
    for (const auto& [path, stamp] : stamps_) {
      const auto old = before.find(path);
      if (old == before.end() || old->second != stamp) last = std::max(last, changed_ns(path));
    }
    const int64_t now =
        std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
    const std::chrono::nanoseconds ago(now - last);
    const bool likely = ago >= Clock::duration::zero() && ago < kLongestLook;
    return likely ? Clock::now() - ago : seen_;
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
    base_ = target_.base();
    settings.link.base = base_.get();
    settings.link.move_all = move_all_;
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

  Next build() {
    if (broken_) return Next::kWait;
    base::Diagnostics diagnostics;
    base::Result<Next> next = build_into(diagnostics);
    if (next.ok()) return *next;
    tools::refuse("stc", next.error());
    return Next::kWait;
  }

  // Everything that there is to say of the sources is said before the target has the image.
  base::Result<Next> build_into(base::Diagnostics& diagnostics) {
    add_findings(diagnostics, project_.imported, false);
    if (!diagnostics.has_errors() && !several_) {
      const workspace::Counts before = build_->counts();
      auto image = build_->build(project_.sources, saved_files_, diagnostics);
      several_ = !image.ok() && image.error().refusal == base::Refusal::kUsage;
      if (!several_) {
        report(project_, diagnostics, format_);
        if (!image.ok()) return with_place(image.error(), project_.devices);
        base::Status safe = check_safe_settings(project_.safe, (*image)->output_bytes);
        if (!safe.ok()) return safe.error();
        return target_.take(**image, project_, {built_since(before), saved_, seen_, Clock::now()});
      }
    }
    base::Diagnostics anew;  // the findings are among them
    const std::shared_ptr<const ir::Image> base = target_.base();
    auto versions = build_resources(project_, {base.get(), move_all_}, anew);
    report(project_, anew, format_);
    if (!versions.ok()) return versions.error();
    return target_.take(*versions, project_, {"everything", saved_, seen_, Clock::now()});
  }

  std::string built_since(const workspace::Counts& before) const {
    const workspace::Counts& now = build_->counts();
    const uint64_t bodies = now.lowered - before.lowered;
    if (now.edits == before.edits) return "everything";
    return bodies == 1 ? "1 POU" : std::to_string(bodies) + " POUs";
  }

  const tools::Options& options_;
  Project project_;
  bool move_all_;
  base::DiagnosticFormat format_;
  WatchTarget& target_;
  std::shared_ptr<const ir::Image> base_;  // of build_
  std::unique_ptr<workspace::IncrementalBuild> build_;
  Stamps stamps_;
  std::vector<uint32_t> saved_files_;  // since the last build, when it was not begun anew
  Clock::time_point saved_ = Clock::now();
  Clock::time_point seen_ = saved_;
  bool several_ = false;  // RESOURCEs
  bool broken_ = false;   // the files cannot be read as a project; what is wrong was said
};

}  // namespace

void Built::print() const {
  const double ms = std::chrono::duration<double, std::milli>(Clock::now() - seen).count();
  std::fprintf(stderr, "built %s in %.0f ms\n", what.c_str(), ms);
}

int watch(const tools::Options& options, Project project, bool move_all,
          base::DiagnosticFormat format, WatchTarget& target) {
  return Watch(options, std::move(project), move_all, format, target).run();
}

}  // namespace stc
