// A compiler that stays: sources -> image as `stc build` makes it from nothing, byte for byte, with
// the same messages, but after an edit only what the edit concerns is done again.
//
// One IncrementalBuild serves one project and keeps sources, tree, program, objects and image of
// the last build (about as much memory as a build takes). When an edit is of another kind than the
// front end can follow (frontend/resident.h), everything is built anew; `counts` says what
// happened. Not for projects with several RESOURCEs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/resident.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "ir/opt/optimise.h"
#include "linker/relink.h"

namespace workspace {

struct Settings {
  frontend::CompileOptions compile;
  ir::PassSet passes = ir::PassSet::all();
  uint32_t jobs = 1;
  linker::Options link;  // its base stays where it is as long as the build, or continue_from()
};

// Since the build was made.
struct Counts {
  uint64_t whole = 0;    // builds from nothing
  uint64_t edits = 0;    // others
  uint64_t lowered = 0;  // bodies checked and lowered by these
};

class IncrementalBuild {
 public:
  explicit IncrementalBuild(Settings settings);

  // The image of these sources; valid until the next call. kSourceErrors when `diagnostics` got
  // errors: they are the message, and the next build may still begin where the last good one ended.
  // kUsage, and no message, for several RESOURCEs.
  base::Result<const ir::Image*> build(const base::SourceMap& sources,
                                       base::Diagnostics& diagnostics);
  // Builds where only these files may differ from the sources of the last call.
  base::Result<const ir::Image*> build(const base::SourceMap& sources,
                                       const std::vector<uint32_t>& saved,
                                       base::Diagnostics& diagnostics);
  // What the last build() gave runs now: builds from nothing are linked against `base`, which is
  // equal to it, from now on. Edits are followed as before, since they move nothing.
  void continue_from(std::shared_ptr<const ir::Image> base) { next_base_ = std::move(base); }
  // The tests of the last good build, with CompileOptions::tests.
  const std::vector<frontend::TestCase>& test_cases() const { return kept_->frontend.test_cases(); }
  // The front end of the last good build; null: there was none.
  frontend::Resident* frontend() { return kept_ == nullptr ? nullptr : &kept_->frontend; }
  const Counts& counts() const { return counts_; }

 private:
  struct Kept {
    frontend::Resident frontend;
    ir::Program* program = nullptr;
    std::vector<ir::Object> objects;  // by PouId
    std::vector<bool> inlined;        // by PouId: functions whose callers may hold their body
    std::optional<linker::LinkState> linked;
    linker::Options link;                   // of the last link
    std::shared_ptr<const ir::Image> base;  // its base, if it is ours
  };

  bool has_files_of(const base::SourceMap& sources) const;
  base::Result<const ir::Image*> build_whole(const base::SourceMap& sources,
                                             base::Diagnostics& diagnostics);
  bool follow(const base::SourceMap& sources, const std::vector<uint32_t>& files,
              base::Diagnostics& diagnostics);
  bool optimise_with_callers(std::vector<ir::PouId>& pous);
  void move_constants(const frontend::Resident::Constants& moved);
  void move_lines(const std::vector<frontend::Resident::FileLines>& files);

  Settings settings_;
  base::SourceMap sources_;       // of the last good build
  std::set<uint32_t> differing_;  // files that may differ from them
  std::unique_ptr<Kept> kept_;
  std::shared_ptr<const ir::Image> next_base_;  // null: that of the settings
  Counts counts_;
};

}  // namespace workspace
