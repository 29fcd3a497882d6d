// stc package: a running image and a new version -> change package.
#include <unistd.h>

#include "base/sha256.h"
#include "online_change/package/package.h"
#include "online_change/plan/pou_edits.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/stc/commands.h"
#include "tools/stc/edit_version.h"
#include "tools/stc/session.h"
#include "tools/stc/watch_packages.h"

namespace stc {
namespace {

constexpr tools::OptionRow kPackageOptions[] = {
    TOOLS_COMPILE_OPTIONS,
    tools::kFormatOption,
    STC_CODE_OPTIONS,
    STC_EMBED_OPTION,
    {"--base", "IMAGE", "the running version (required)"},
    {"--output|-o", "FILE", "package to write (required without --watch)"},
    tools::kRestrictedOption,
    tools::kMatchingOption,
    {"--step", "N", "of a fleet file that starts each unit by itself: the N-th of its steps"},
    {"--move-all", nullptr, "give every instance a new place (a test of changes)"},
    {"--watch", nullptr, "stay, and make one at each save, for `stvm change --watch`", "",
     "--format"},
};
constexpr tools::Command kPackageCommand{
    "package", "NEW...", "Makes the change package from a running version to a new one.",
    kPackageOptions, 1};

struct MadePackage {
  base::Digest base{};
  base::Digest next{};
  base::Bytes bytes;
};

base::Result<MadePackage> make(const tools::Options& options) {
  if (!options.has("--base") || !options.has("--output")) {
    return base::Error{base::Refusal::kUsage, "package: --base and --output are required"};
  }
  const std::vector<std::string>& paths = options.arguments();
  const bool of_fleet = paths.size() == 1 && is_fleet_file(paths[0]);
  for (const char* const name : {"--matching", "--step"}) {
    if (of_fleet || !options.has(name)) continue;
    return base::Error{base::Refusal::kUsage,
                       std::string(name) + " is for a fleet file (stc fleet): leave it out"};
  }
  std::optional<size_t> step;
  if (options.has("--step")) {
    base::Result<uint64_t> number = options.number("--step", 0);
    if (!number.ok()) return number.error();
    if (*number == 0) return base::Error{base::Refusal::kUsage, "--step counts from 1"};
    step = *number - 1;
  }
  base::Result<Version> old_version = read_image(options.text("--base"));
  if (!old_version.ok()) return old_version.error();
  const BuildOptions build_options{&old_version->image, options.has("--move-all"),
                                   options.has("--matching"), step};
  base::Result<Version> next = open_version(options, paths, build_options);
  if (!next.ok()) return next.error();
  if (options.has("--restricted")) {
    base::Status kept =
        online_change::check_restricted(online_change::pou_edits(old_version->image, next->image));
    if (!kept.ok()) return kept.error();
  }
  auto package = online_change::make_package(old_version->bytes, next->bytes);
  if (!package.ok()) return package.error();
  MadePackage made{ir::digest(old_version->bytes), ir::digest(next->bytes),
                   online_change::encode(*package)};
  base::Status written = tools::write_file(options.text("--output"), made.bytes);
  if (!written.ok()) return written.error();
  return made;
}

std::string json_of(const std::string& file, const MadePackage& made) {
  tools::JsonWriter json;
  json.begin_object().field("file", file);
  json.field("digest", base::to_hex(base::sha256(made.bytes)));
  json.field("bytes", uint64_t{made.bytes.size()});
  json.field("base", base::to_hex(made.base)).field("next", base::to_hex(made.next));
  json.end_object();
  return json.finish();
}

int follow(const tools::Options& options) {
  if (!options.has("--base") || options.has("--output")) {
    return tools::refuse(
        "stc", {base::Refusal::kUsage, "package --watch: --base is required, --output has no use"});
  }
  base::Result<Version> running = read_image(options.text("--base"));
  if (!running.ok()) return tools::refuse("stc", running.error());
  WatchedPackages target(STDOUT_FILENO, options.has("--restricted"));
  base::Status begun = target.begin(std::move(running->bytes));
  if (!begun.ok()) return tools::refuse("stc", begun.error());
  return watch(options, options.has("--move-all"), base::DiagnosticFormat::kText, target);
}

int run_package(const tools::Options& options) {
  if (options.has("--watch")) return follow(options);
  base::Result<MadePackage> made = make(options);
  if (!made.ok()) return tools::refuse("stc", made.error());
  if (options.text("--format") == "json") {
    std::fputs(json_of(options.text("--output"), *made).c_str(), stdout);
  }
  return tools::kOk;
}

}  // namespace

const Entry kPackage{&kPackageCommand, run_package};

}  // namespace stc
