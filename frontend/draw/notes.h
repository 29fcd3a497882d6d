// What stands beside an operand in a picture: its address, and the comment at its declaration.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "frontend/parse/tree.h"

namespace frontend::draw {

struct Note {
  std::string address;  // %IX0.3; empty: none is declared
  std::string comment;  // in one line
  bool empty() const { return address.empty() && comment.empty(); }
};

class Notes {
 public:
  // Of names without case: `Start`, and of a global also `List.Start`. The last one counts.
  void set(std::string_view name, Note note);
  // Of an operand that is the name of a variable; null when nothing is known of it.
  const Note* find(std::string_view operand) const;

 private:
  std::unordered_map<std::string, Note> notes_;  // by folded name
};

// Of what a body of `pou` sees: its own variables, those of `owner` (null: it has none), globals.
// `sources` holds the texts that the tree was parsed from.
Notes notes_of(const Tree& tree, const base::SourceMap& sources, const PouDecl& pou,
               const PouDecl* owner);

}  // namespace frontend::draw
