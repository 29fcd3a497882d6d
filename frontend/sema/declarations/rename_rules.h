// `{renamed from := 'old'}` in front of a declaration: the running program's `old` is meant, and
// its value goes on (X2). Here is checked what can be told from the sources alone; which rules
// apply depends on what runs (ir/bytecode/renames.h).
#pragma once

#include "base/diagnostics.h"
#include "frontend/parse/tree.h"

namespace frontend {

// Charts are declared already.
void check_renames(const Tree& tree, base::Diagnostics& diagnostics);

// Old names in one rule.
inline constexpr size_t kMostOldNames = 16;

// The old names that a checked rule gives (ir/types/old_names.h); "" when there is none.
std::string renamed_from(const Tree& tree, Range32 attributes);
// Rules for parts of what is declared: {renamed '.x' from := 'old'}.
std::vector<const Attribute*> part_rules(const Tree& tree, Range32 attributes);

// `.name` is a whole name that has no list and no namespace in front.
std::string_view without_dot(std::string_view old_name);
// The old names of what is called `name` now, with everything in front of its last dot; an old name
// with dots is a whole one.
std::string whole_old_names(std::string_view name, std::string_view rule);

}  // namespace frontend
