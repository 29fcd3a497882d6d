// Inside of the resident front end: what it knows of each body and file.
#pragma once

#include "frontend/analysis.h"
#include "frontend/resident.h"

namespace frontend {

// What grows when something is needed for the first time. Numbers are given in that order: an
// edited body must add the same types in the same order, and may have added nothing else.
struct Resident::Sizes {
  uint32_t types = 0;
  uint32_t variables = 0;
  uint32_t pous = 0;
  uint32_t globals = 0;
  uint32_t addresses = 0;
  friend bool operator==(const Sizes&, const Sizes&) = default;
};

struct Resident::BodyRecord {
  Sizes before;  // when it was lowered in its turn
  Sizes behind;
  bool in_turn = false;         // all types that came with it were interned
  uint32_t first_constant = 0;  // its constants lie side by side
  uint32_t end_constant = 0;
  bool other_lines = false;  // BodyLog
  std::vector<uint32_t> marks;
  std::vector<uint32_t> callees;      // as PouInfo's
  std::vector<ir::PouId> for_others;  // called_for_others()
  std::vector<OutputWrite> writes;
  std::vector<ir::PouId> prototypes;  // of virtual calls
  Messages messages;
};

struct Resident::File {
  uint32_t text = 0;  // number of its last text in the resident sources
  bool has_places = false;
  std::vector<CodePlace> places;
  std::vector<base::SourceMap::Piece> pieces;  // of its texts, as they stand in the last one
};

// What a body was before it was lowered anew, for the case that the edit is not taken.
struct Resident::Undo {
  struct Code {
    uint32_t pou = 0;
    BodyRecord record;
    ir::Pou code;
    Values constants;
  };
  struct Statements {
    PouDecl* pou;
    Range32 body;
    base::SourceSpan code;
    ir::SourceContent content;
  };
  Sizes sizes;
  bool complete = true;  // false: constants of others were overwritten
  std::vector<std::pair<uint32_t, File>> files;
  std::vector<Statements> statements;
  std::vector<Code> codes;
  Messages behind;
};

// A file with other statements, read.
struct Resident::Edit {
  uint32_t file = 0;
  uint32_t text = 0;
  BodyEdits bodies;
  std::vector<CodePlace> now;  // in the new text; places of bodies.changed are valid
  std::vector<PouDecl> pous;   // what `now` points into
};

}  // namespace frontend
