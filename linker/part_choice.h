// Which parts of a merge come from the edit.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ir/bytecode/part_edits.h"

namespace linker {

class PartChoice {
 public:
  // Borrows the edits.
  explicit PartChoice(const std::vector<ir::PartEdit>& edits);

  // Null: the edit does not touch it.
  const ir::PartEdit* edit(ir::PartKind kind, const std::string& name) const;
  // The edit brings it, and the target has it not yet.
  bool takes(ir::PartKind kind, const std::string& name) const;
  // The edit takes it away, and the target still has it.
  bool drops(ir::PartKind kind, const std::string& name) const;
  const std::vector<ir::PartEdit>& edits() const { return edits_; }

 private:
  const std::vector<ir::PartEdit>& edits_;
  std::map<std::pair<ir::PartKind, std::string>, const ir::PartEdit*> by_name_;
};

}  // namespace linker
