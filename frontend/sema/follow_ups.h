// One mistake, one message. A declaration that the parser could not read leaves names undeclared,
// and what is undeclared is used in many places: those messages say nothing new.
//
//   - Where the declarations of a POU are damaged, names unknown in it are silent; where types or
//     global variables are damaged, or a comment swallowed the rest of a file, all unknown names
//     are.
//   - The same unknown name is reported once per POU, an unknown type, member or literal once.
#pragma once

#include <set>
#include <string>
#include <utility>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/parse/tree.h"

namespace frontend {

class FollowUps {
 public:
  // `parsed` holds what lexer and parser reported.
  FollowUps(const base::SourceMap& sources, const Tree& tree, const base::Diagnostics& parsed);

  // Nothing to say? `within` is the POU around the place, or null.
  bool silences(base::DiagnosticCode code, const PouDecl* within, const std::string& text);
  // What was said is to be said again.
  void forget() { said_.clear(); }

 private:
  void note_damage(const base::SourceMap& sources, const Tree& tree, base::SourcePos at);

  bool globals_ = false;  // types, global variables or a whole rest of a file are damaged
  std::set<const PouDecl*> pous_;
  std::set<std::pair<const PouDecl*, std::string>> said_;
};

}  // namespace frontend
