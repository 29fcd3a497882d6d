// stc fmt: lays sources out, in place.
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "base/limits.h"
#include "frontend/format/format.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/terminal.h"
#include "tools/stc/commands.h"
#include "tools/stc/difference.h"
#include "tools/stc/format_settings.h"
#include "tools/stc/importer.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr tools::OptionRow kFormatOptions[] = {
    {"--check", nullptr,
     "write nothing; list the files that would change, exit 1 when there are any"},
    {"--diff", nullptr, "write nothing; show what would change, exit 1 when there is anything"},
    {"--stdin", nullptr, "read one source from standard input, write it to standard output"},
    {"--format", "FORM", "text (default) or json: how --check reports", "text|json"},
    TOOLS_COMPILE_OPTIONS,
};
constexpr tools::Command kFormatCommand{
    "fmt", "PATHS...", "Lays sources out, in place; [format] of stc.toml says how.", kFormatOptions,
    0};

class Formatter {
 public:
  explicit Formatter(const tools::Options& options)
      : check_(options.has("--check")),
        diff_(options.has("--diff")),
        json_(options.text("--format") == "json") {
    if (json_) out_.begin_object().key("files").begin_array();
  }

  base::Status format_path(const std::string& path);
  base::Status format_stdin();
  int finish();

 private:
  base::Status format_file(const std::string& path, const frontend::FormatOptions& settings);
  base::Status replace(const std::string& path, const std::string& old, const std::string& text);
  void report(const base::SourceMap& sources, base::Diagnostics& diagnostics);
  void note(const std::string& path, const char* status);  // "changed", "unchanged", "error"

  bool check_;
  bool diff_;
  bool json_;
  uint32_t changed_ = 0;
  uint32_t failed_ = 0;
  uint32_t files_ = 0;
  tools::JsonWriter out_;
};

void Formatter::note(const std::string& path, const char* status) {
  if (json_) out_.begin_object().field("file", path).field("status", status).end_object();
}

void Formatter::report(const base::SourceMap& sources, base::Diagnostics& diagnostics) {
  diagnostics.sort();
  bool colour = tools::has_colour(STDERR_FILENO);
  std::fputs(base::render(diagnostics, sources, base::DiagnosticFormat::kText, colour).c_str(),
             stderr);
}

base::Status Formatter::format_path(const std::string& path) {
  base::Result<std::vector<std::string>> files = source_files(path);
  if (!files.ok()) return files.error();
  base::Result<frontend::FormatOptions> settings = format_settings(path);
  if (!settings.ok()) return settings.error();
  for (const std::string& file : *files) {
    if (needs_import(file)) {  // an export with drawings
      if (tools::is_folder(path)) continue;
      return base::Error{base::Refusal::kUsage,
                         file + ": it is no text alone; `stc import` makes sources of it"};
    }
    base::Status status = format_file(file, *settings);
    if (!status.ok()) return status;
  }
  return base::Ok{};
}

base::Status Formatter::format_file(const std::string& path,
                                    const frontend::FormatOptions& settings) {
  base::Result<std::string> old = tools::read_text(path, base::kMaxSourceBytes);
  if (!old.ok()) return old.error();
  if (old->find('\0') != std::string::npos) {
    return base::Error{base::Refusal::kFileUnreadable, path + ": not a source text"};
  }
  ++files_;
  base::SourceMap sources;
  sources.add(path, *old);
  base::Diagnostics diagnostics;
  base::Result<std::string> text = frontend::format(sources, 0, settings, diagnostics);
  if (!text.ok()) {
    if (text.error().refusal != base::Refusal::kSourceErrors) return text.error();
    ++failed_;
    note(path, "error");
    report(sources, diagnostics);
    return base::Ok{};
  }
  bool changed = *text != *old;
  note(path, changed ? "changed" : "unchanged");
  if (!changed) return base::Ok{};
  ++changed_;
  if (check_ && !json_) std::printf("%s\n", path.c_str());
  if (diff_) std::fputs(difference(path, *old, *text).c_str(), stdout);
  return check_ || diff_ ? base::Ok{} : replace(path, *old, *text);
}

// A symbolic link stays one; what somebody else wrote meanwhile is not overwritten.
base::Status Formatter::replace(const std::string& path, const std::string& old,
                                const std::string& text) {
  std::error_code error;
  std::filesystem::path real = std::filesystem::canonical(path, error);
  std::string target = error ? path : real.string();
  base::Result<std::string> now = tools::read_text(target, base::kMaxSourceBytes);
  if (!now.ok()) return now.error();
  if (*now != old) {
    return base::Error{base::Refusal::kFileUnwritable,
                       path + ": changed while it was being formatted; run it again"};
  }
  return tools::write_file(target, base::as_bytes(text));
}

base::Status Formatter::format_stdin() {
  base::Result<std::string> old = tools::read_text("/dev/stdin", base::kMaxSourceBytes);
  if (!old.ok()) return old.error();
  base::Result<frontend::FormatOptions> settings = format_settings(".");
  if (!settings.ok()) return settings.error();
  base::SourceMap sources;
  sources.add("<stdin>", *old);
  base::Diagnostics diagnostics;
  base::Result<std::string> text = frontend::format(sources, 0, *settings, diagnostics);
  if (!text.ok()) {
    report(sources, diagnostics);
    return text.error();
  }
  if (*text != *old) ++changed_;
  if (diff_) {
    std::fputs(difference("<stdin>", *old, *text).c_str(), stdout);
  } else if (!check_) {
    std::fwrite(text->data(), 1, text->size(), stdout);
    changed_ = 0;
  }
  return base::Ok{};
}

int Formatter::finish() {
  if (json_) {
    out_.end_array();
    out_.field("changed", changed_).field("errors", failed_).end_object();
    std::fputs(out_.finish().c_str(), stdout);
  } else if (failed_ != 0) {
    std::fprintf(stderr, "stc: %u of %u file(s) have errors and were left as they are\n", failed_,
                 files_);
  }
  bool findings = failed_ != 0 || ((check_ || diff_) && changed_ != 0);
  return findings ? tools::kFindings : tools::kOk;
}

base::Status usage(const tools::Options& options) {
  std::string form = options.text("--format", "text");
  std::string text;
  if (form != "text" && form != "json") {
    text = "fmt: unknown format `" + form + "`; known are text, json";
  } else if (options.has("--stdin") && !options.arguments().empty()) {
    text = "fmt: --stdin takes no paths";
  } else if (!options.has("--stdin") && options.arguments().empty()) {
    text = "fmt: needs PATHS... or --stdin";
  } else if (form == "json" && (options.has("--diff") || options.has("--stdin"))) {
    text = "fmt: --format json goes with --check, not with --diff or --stdin";
  } else {
    return base::Ok{};
  }
  return base::Error{base::Refusal::kUsage, text};
}

// The layout is the same for all of them, but a mistake in one is a mistake.
base::Status check_compile_options(const tools::Options& options) {
  Project unused;
  return apply_compile_options(options, unused);
}

int run_format(const tools::Options& options) {
  base::Status status = usage(options);
  if (status.ok()) status = check_compile_options(options);
  if (!status.ok()) return tools::refuse("stc", status.error());
  Formatter formatter(options);
  if (options.has("--stdin")) {
    status = formatter.format_stdin();
    if (!status.ok()) return tools::refuse("stc", status.error());
  }
  for (const std::string& path : options.arguments()) {
    status = formatter.format_path(path);
    if (!status.ok()) return tools::refuse("stc", status.error());
  }
  return formatter.finish();
}

}  // namespace

const Entry kFormat{&kFormatCommand, run_format};

}  // namespace stc
