#include "tools/common/all_system_edits.h"

#include "ir/bytecode/renames.h"
#include "ir/types/address_text.h"
#include "vm/load/left_outputs.h"

namespace tools {

SystemEdits all_system_edits(const ir::Image& old_image, const ir::Image& new_image) {
  SystemEdits edits = online_change::system_edits(old_image, new_image);
  const ir::OldUnderNewNames old(old_image, new_image);
  for (const vm::LeftOutput& output : vm::left_outputs(old.image(), new_image)) {
    edits.push_back({"output", ir::address_text(output.address),
                     "`" + output.path + "` is no longer written by any code"});
  }
  return edits;
}

}  // namespace tools
