// A project: a folder or a list of files, with an optional stc.toml in the folder
// or above it (docs/PROJECT.md). Everything works without it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/xml/imported.h"
#include "base/result.h"
#include "base/source.h"
#include "base/warning_policy.h"
#include "frontend/compile.h"
#include "ir/opt/optimise.h"
#include "linker/layout.h"
#include "tools/stc/device_tables.h"
#include "tools/stc/project_sources.h"
#include "tools/stc/read_file.h"
#include "tools/stc/safe_settings.h"
#include "tools/stc/unit_settings.h"

namespace stc {

struct Project {
  std::string name;
  base::SourceMap sources;             // also documents that were imported (kQuoted)
  std::vector<xml::Finding> imported;  // what was found in them; errors too
  xml::Kept kept;                      // of them, for an export
  frontend::CompileOptions compile;
  base::WarningPolicy warnings;                    // what the sources silence is in it, too
  std::vector<base::Diagnostic> warning_mistakes;  // in pragmas of them
  ir::PassSet passes = ir::PassSet::all();
  uint32_t jobs = 1;  // threads at most; nothing but the time depends on it
  linker::Slack slack;
  std::vector<ProjectDevice> devices;
  SafeSettings safe;
  UnitSettings units;

  // For sources that travel with the image (embed.h).
  bool embed_sources = false;
  bool named = false;                      // by its settings
  std::vector<std::string> paths;          // as typed
  std::string settings_above;              // a stc.toml above them that concerns them; "": none
  std::vector<std::string> build_options;  // as typed: what is not in the settings
  std::vector<ReadFile> other_files;
  uint32_t read_sources = 0;  // so many of `sources` were read; the rest was made of documents

  // What the folder of the project has to hold.
  std::vector<std::string> held_paths() const;
  // Every file that was read: no output takes its place.
  std::vector<std::string> read_files() const;
};

// Reads every source: files as given, folders recursively (*.st and objects of TwinCAT, sorted by
// path); what other tools wrote is imported. File names in messages are the paths as typed. Errors:
// kFileNotFound, kFileUnreadable, kBadProject, kBadMapping, kTooMany (kMaxSourceBytes).
base::Result<Project> load_project(const std::vector<std::string>& paths,
                                   std::optional<frontend::Dialect> dialect);

}  // namespace stc
