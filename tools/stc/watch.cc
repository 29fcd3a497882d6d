#include "tools/stc/watch.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/heap.h"
#include "tools/stc/file_events.h"
#include "tools/stc/file_stamp.h"
#include "tools/stc/importer.h"
#include "tools/stc/session.h"
#include "tools/stc/unfinished.h"
#include "workspace/incremental_build.h"

namespace stc {
namespace {

using Clock = std::chrono::steady_clock;

namespace fs = std::filesystem;

// Looking takes a tenth of the time at most, and happens often enough for people.
constexpr auto kLookEvery = std::chrono::milliseconds(30);
constexpr int kRest = 10;
// Where the system says what is saved, for what it does not know itself.
constexpr auto kLookRarely = std::chrono::seconds(2);
constexpr auto kQuiet = std::chrono::milliseconds(4);  // between files that are saved together
constexpr auto kLongestLook = std::chrono::seconds(10);
constexpr const char* kSettings = "stc.toml";

using Next = WatchTarget::Next;

class Watch {
 public:
  Watch(const tools::Options& options, bool move_all, base::DiagnosticFormat format,
        WatchTarget& target)
      : options_(options), move_all_(move_all), format_(format), target_(target) {}

  int run() {
    std::optional<base::Status> opened;
    while (!opened) {
      stamps_ = look();
      opened = open();
    }
    if (!opened->ok()) return tools::refuse("stc", opened->error());
    for (;;) {
      const Next next = build();
      tools::keep_large_pieces();  // from now on there are edits
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
    Stamps found = look_at_folders();
    add_files_of(project_, found);
    return found;
  }

  Stamps look_at_folders() const {
    Stamps found;
    const auto add = [&](const base::Result<std::vector<std::string>>& files) {
      if (!files.ok()) return;
      for (const std::string& file : *files) found.emplace(file, stamp_of(file));
    };
    for (const std::string& path : options_.arguments()) {
      found.emplace(path, stamp_of(path));
      if (!tools::is_folder(path)) continue;
      found[path] = {};  // a folder's own time says nothing about its files
      const std::string settings = (fs::path(path) / kSettings).string();
      found.emplace(settings, stamp_of(settings));
      add(source_files(path));
      add(importable_files(path, false));
    }
    return found;
  }

  static void add_files_of(const Project& project, Stamps& found) {
    for (uint32_t file = 0; file < project.sources.file_count(); ++file) {
      const std::string name(project.sources.file_name(file));
      if (!found.contains(name)) found.emplace(name, stamp_of(name));
    }
  }

  // Until something has changed, and the project is what the files say now. False: nobody waits
  // for it any more.
  bool wait() {
    for (;;) {
      const auto begin = Clock::now();
      if (look_again()) return true;
      if (events_.has_more_to_take() && look_at_events()) return true;
      const auto looked = Clock::now();
      const Clock::duration rest =
          told_ ? kLookRarely : std::max<Clock::duration>(kLookEvery, kRest * (looked - begin));
      // However much the system says meanwhile: it does not say everything.
      for (;;) {
        const Clock::duration left = std::min(looked + rest, look_at_) - Clock::now();
        if (left <= Clock::duration::zero()) break;
        const WatchTarget::Rest rested = target_.rest(left, events_.descriptor());
        if (rested == WatchTarget::Rest::kEnd) return false;
        if (rested == WatchTarget::Rest::kOver) break;
        if (look_at_events()) return true;
      }
    }
  }

  // Folders first, so that nothing is missed between them and the first look.
  void watch_folders() {
    std::set<std::string> folders;
    const auto add = [&](const fs::path& folder) {
      if (tools::is_folder(folder.empty() ? "." : folder.string())) folders.insert(folder.string());
    };
    std::error_code error;
    bool links = false;  // what they lead to is in other folders
    for (const auto& [path, stamp] : look()) {
      links |= fs::is_symlink(path, error);
      add(fs::path(path).parent_path());
    }
    error.clear();
    for (const std::string& path : options_.arguments()) {
      if (!tools::is_folder(path)) continue;
      add((fs::path(path) / kSettings).parent_path());  // without a slash at its end
      fs::recursive_directory_iterator walk(path, error);
      for (; !error && walk != fs::recursive_directory_iterator(); walk.increment(error)) {
        if (tools::is_folder(walk->path().string())) folders.insert(walk->path().string());
      }
    }
    told_ = events_.watch(folders) && !links && !error;
  }

  // What the system has said, without a look at all the others.
  bool look_at_events() {
    std::optional<std::set<std::string>> files = events_.take(kQuiet);
    if (files && files->empty()) return false;
    if (!files) watch_folders();
    if (!files || broken_ || left_ || is_new_begun()) return look_again();
    const auto begin = Clock::now();
    Stamps now = stamps_;
    for (const std::string& file : *files) {
      const auto known = now.find(file);
      if (known == now.end() && may_belong(file)) return look_again();
      if (known != now.end()) known->second = stamp_of(file);
    }
    return take(std::move(now), begin);
  }

  // Is a file that is not known being written?
  bool is_new_begun() const {
    return std::any_of(events_.begun().begin(), events_.begun().end(), [&](const auto& begun) {
      return !stamps_.contains(begun.first) && may_belong(begun.first);
    });
  }

  // To the project, by its name.
  static bool may_belong(const std::string& file) {
    return is_source_name(file) || is_importable(file) || fs::path(file).filename() == kSettings;
  }

  bool look_again() {
    const auto begin = Clock::now();
    return take(look(), begin);
  }

  bool take(Stamps now, Clock::time_point begin) {
    events_.read();  // after the look: what is being written at it is known
    const bool differs = now != stamps_;
    const auto complete = unfinished_.until(stamps_, now, {events_.begun(), events_.lost()}, begin);
    look_at_ = complete.value_or(Clock::time_point::max());
    left_ = complete && differs;
    if (left_ || !differs) return false;
    seen_ = begin;
    Stamps before = std::exchange(stamps_, std::move(now));
    saved_ = save_of(before);
    if (!broken_ && take_texts(before)) return true;
    const std::optional<base::Status> opened = open();
    if (!opened) {
      stamps_ = std::move(before);
      look_at_ = Clock::now() + kLookEvery;
      return false;
    }
    if (!opened->ok()) tools::refuse("stc", opened->error());
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
      if (old == before.end() || needs_import(path)) return false;
      if (old->second == stamp) continue;
      base::Result<std::string> text = tools::read_text(path);
      if (!text.ok() || text->find('\0') != std::string::npos) return false;
      if (stamp_of(path) != stamp) return false;
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

  // Settings, or which files there are. Nullopt: they are being written at this moment.
  std::optional<base::Status> open() {
    base::Result<Project> project = open_project(options_, options_.arguments());
    Stamps found = look_at_folders();
    Stamps known = found;
    add_files_of(project_, known);
    if (known != stamps_) return std::nullopt;
    broken_ = !project.ok();
    if (broken_) return base::Status(project.error());
    project_ = std::move(*project);
    project_.compile.tests = target_.is_for_tests();
    add_files_of(project_, found);
    stamps_ = std::move(found);
    watch_folders();
    begin_anew();
    return base::Status(base::Ok{});
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
    settings.link.unit_members = project_.units.members();
    settings.link.jobs = project_.jobs;
    auto devices = devices_of(project_.devices, {}, {});
    broken_ = !devices.ok();
    if (broken_) {
      tools::refuse("stc", devices.error());
      return;
    }
    settings.link.devices =
        target_.is_for_tests() ? without_lost_tasks(std::move(*devices)) : std::move(*devices);
    several_ = false;
    build_ = std::make_unique<workspace::IncrementalBuild>(std::move(settings));
  }

  Next build() {
    if (broken_) return Next::kWait;
    silence_warnings(project_);
    base::Diagnostics diagnostics = diagnostics_of(project_);
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
        if (image.ok()) target_.check(**image, project_, diagnostics);
        report(project_, diagnostics, format_);
        if (!image.ok()) return with_place(image.error(), project_.devices);
        if (diagnostics.has_errors()) return source_errors(diagnostics);  // warnings that are
        base::Status safe = check_safe_settings(project_.safe, (*image)->output_bytes);
        if (!safe.ok()) return safe.error();
        const ir::Image* const program = &**image;
        base::Status units = check_unit_settings(project_.units, {&program, 1});
        if (!units.ok()) return units.error();
        const auto* tests = target_.is_for_tests() ? &build_->test_cases() : nullptr;
        return target_.take(**image, project_,
                            {built_since(before), saved_, seen_, Clock::now(), tests});
      }
    }
    base::Diagnostics anew = diagnostics_of(project_);  // the findings are among them
    if (target_.is_for_tests()) {
      auto tests = build_tests(project_, anew);
      report(project_, anew, format_);
      if (!tests.ok()) return tests.error();
      return target_.take(tests->version.image, project_,
                          {"everything", saved_, seen_, Clock::now(), &tests->cases});
    }
    const std::shared_ptr<const ir::Image> base = target_.base();
    auto versions = build_resources(project_, {base.get(), move_all_}, anew);
    if (versions.ok()) target_.check(*versions, project_, anew);
    report(project_, anew, format_);
    if (!versions.ok()) return versions.error();
    if (anew.has_errors()) return source_errors(anew);
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
  Unfinished unfinished_{FileEvents::longest_pause()};
  Clock::time_point look_at_ = Clock::time_point::max();  // at the latest
  bool left_ = false;  // something that was saved, until other files are complete
  FileEvents events_;
  bool told_ = false;                  // by them, of whatever is written to files of the project
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

WatchTarget::Rest WatchTarget::rest(std::chrono::nanoseconds time, int descriptor) {
  pollfd event = {descriptor, POLLIN, 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(time);
  return ::poll(&event, 1, static_cast<int>(ms.count())) > 0 ? Rest::kEvent : Rest::kOver;
}

int watch(const tools::Options& options, bool move_all, base::DiagnosticFormat format,
          WatchTarget& target) {
  return Watch(options, move_all, format, target).run();
}

}  // namespace stc
