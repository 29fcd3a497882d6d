// An edit made in another program than the one that it was made on (E-09, E-10; D3). Given what was
// edited, before and after, the parts that differ are put into a third program; all others stay
// what they are there, byte for byte.
//   An edit on one controller, sent to others that have changes of their own: original, edited,
// and what each of them runs. To take an edit out of the middle of several: what it made, what it
// was made on, and what runs now.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/part_edits.h"
#include "linker/layout.h"

namespace linker {

struct MergeInput {
  const ir::Image& original;  // all three are verified
  const ir::Image& edited;
  const ir::Image& target;
};

// What ir::part_edits() says of them.
std::vector<ir::PartEdit> merge_parts(const MergeInput& input);

struct MergeOptions {
  Slack slack;
  bool matching = false;  // leaves out the units that are missing or others there (E-13)
  // Takes only this step of the edit (ir::of_step), where it comes in several (E-25).
  std::optional<std::string> step = std::nullopt;
};

// The target with the edit in it, linked on top of the target. kOtherPart where a part is missing
// or another one there; kCannotRelink where something that stays cannot go with the edit, or the
// edit not with that; the text names all of them. kNoChange: the target has all of it.
base::Result<ir::Image> merge(const MergeInput& input, const MergeOptions& options);

}  // namespace linker
