// Inside of the resident front end: what it knows of each body and file.
#pragma once

#include "frontend/analysis.h"
#include "frontend/resident.h"

namespace frontend {

// What grows when something is needed for the first time. Numbers are given in that order, so a
// body that was the first to need something cannot change alone.
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
  bool first = false;
  uint32_t first_constant = 0;  // its constants lie side by side
  uint32_t end_constant = 0;
  bool other_lines = false;  // BodyLog
  std::vector<uint32_t> marks;
  std::vector<uint32_t> callees;  // as PouInfo's
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

// A file with other statements, read.
struct Resident::Edit {
  uint32_t file = 0;
  uint32_t text = 0;
  BodyEdits bodies;
  std::vector<CodePlace> now;  // in the new text; places of bodies.changed are valid
  std::vector<PouDecl> pous;   // what `now` points into
};

}  // namespace frontend
