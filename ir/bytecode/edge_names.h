// What an edge in a drawing remembers is a variable of the POU, `operand#rising#target`
// (frontend/parse/diagram.h). Where the contact acts on something else in the new version, or the
// drawing puts something between, the target is another one, and the edge is the same: no button
// that is held is pressed again (case 39).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "ir/types/types.h"

namespace ir {

// `operand#rising` or `operand#falling` of such a name; "" of others.
std::string_view edge_of_name(std::string_view name);

// Do two versions' types differ in the names of such variables? By sums of hashes, so a collision
// would hide a difference. Cost: each name of a member of a POU, and nothing for one and the same
// table.
bool edges_differ(const TypeTable& old_types, const TypeTable& types);

// Adds to `sources`, for each member of `next` the one of `old` that it was (RenameRules::kNone):
// each edge that is known by its name in one version only goes on as one of the same operand, in
// their order.
void pair_edges(const Type& old, const TypeTable& types, const Type& next,
                std::vector<uint32_t>& sources);

}  // namespace ir
