// The front end, kept after a compilation: when the sources differ in the statements of some POUs
// and in nothing else, only those are parsed, checked and lowered again. What comes out is what a
// compilation from nothing would give: the same numbers of types, constants and POUs, the same
// lines, the same messages. Wherever that cannot be promised, `follow` says so and the caller
// compiles everything; docs/adr/0025-incremental-builds.md lists the cases.
//
// One Resident serves one project. It owns sources, tree and program; the program's POUs belong to
// the caller as soon as they are made (who optimises them, does it in place).
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/source_edits.h"
#include "ir/program/ir.h"

namespace frontend {

class Sema;
struct Parsed;

class Resident {
 public:
  Resident();
  ~Resident();
  Resident(const Resident&) = delete;
  Resident& operator=(const Resident&) = delete;

  // As frontend::compile; null when any error was reported, and, with no message, when the project
  // has several RESOURCEs: those are built in another way.
  ir::Program* compile(const base::SourceMap& sources, const CompileOptions& options,
                       base::Diagnostics& diagnostics);

  // The tests of the last program, which was compiled with CompileOptions::tests.
  const std::vector<TestCase>& test_cases() const;

  struct FileLines {
    std::string file;
    std::vector<LineShift> shifts;
  };
  // The constants of the program from `first` to `end` are others now, and end at `new_end`; what
  // was after them has moved.
  struct Constants {
    uint32_t first = 0;
    uint32_t end = 0;
    uint32_t new_end = 0;
  };
  struct Update {
    std::vector<ir::PouId> pous;       // made anew, in order
    std::vector<Constants> constants;  // theirs, one after the other
    std::vector<FileLines> lines;      // of all other POUs in these files
  };
  // `sources` differ from the last ones in `files` only; all messages of the whole project go to
  // `diagnostics`. nullopt: compile everything; nothing was reported.
  std::optional<Update> follow(const base::SourceMap& sources, std::span<const uint32_t> files,
                               base::Diagnostics& diagnostics);

  // After nullopt: is there still something to follow, when the errors that were found are mended?
  bool kept() const { return followable_ && found_errors_; }

  // The POU as it was before anybody optimised it. False: compile everything.
  bool lower_again(ir::PouId pou);
  // Every POU's callees.
  std::vector<std::vector<ir::PouId>> callees() const;
  // What is kept of the sources, for questions (questions/questions.h), also where they have
  // mistakes; null: nothing. Edits that could not be followed are not in it.
  Sema* sema() { return sema_.get(); }
  // Bodies that were checked and lowered since this was made.
  uint64_t lowered() const { return lowered_; }

 private:
  struct BodyRecord;
  struct File;
  struct Sizes;
  struct Edit;
  struct Undo;
  using Values = std::vector<ir::ConstValue>;
  using Messages = std::vector<base::Diagnostic>;

  bool can_follow() const;
  void lower_all_bodies();
  void note_files();
  std::optional<Edit> read_edit(uint32_t file, std::string_view text);
  void move_pieces(const Edit& edit);
  void take_edit(Edit& edit, Undo& undo);
  void set_pieces();
  bool lower_edited(const std::vector<Edit>& edits, Update& update, Undo& undo);
  bool check_uses_again();
  void undo_edits(Undo& undo);
  Values constants_between(uint32_t first, uint32_t end) const;
  void set_constants(uint32_t first, const Values& values, uint32_t size);
  bool may_move_constants(uint32_t pou) const;
  void replace_constants(uint32_t pou, Values values);
  Sizes sizes() const;
  void run_body(uint32_t pou, uint32_t next_type, BodyRecord& record);
  bool lower_anew(uint32_t pou, Undo& undo);
  bool is_alike(const BodyRecord& old, const BodyRecord& now, uint32_t pou) const;
  void count_marks(const std::vector<uint32_t>& marks, bool more);
  void report(const base::SourceMap& sources, base::Diagnostics& out) const;
  base::SourceSpan moved(base::SourceSpan span, const base::SourceMap& to) const;

  CompileOptions options_;
  base::Diagnostics diagnostics_;
  std::unique_ptr<Parsed> parsed_;
  std::unique_ptr<Sema> sema_;
  std::vector<BodyRecord> bodies_;   // by number in Declarations::pous
  std::vector<ir::Pou> heads_;       // by PouId: without a body
  std::vector<uint32_t> number_of_;  // by PouId
  std::vector<uint32_t> marks_;      // by mark: bodies that make it, and one more for declarations
  std::vector<File> files_;
  std::set<uint32_t> edited_;      // files with more than one text
  std::vector<uint32_t> origins_;  // file by number of a text in the resident sources
  Messages before_;                // of parser and declarations
  Messages behind_;                // of what needs all bodies
  size_t first_exprs_ = 0;
  uint32_t first_bytes_ = 0;
  bool followable_ = false;
  bool uses_changed_ = false;
  bool found_errors_ = false;
  uint64_t lowered_ = 0;
};

}  // namespace frontend
