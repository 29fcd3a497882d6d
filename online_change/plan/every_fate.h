// The fate of every single variable in a plan (X1, totality): fate rows stand for what many have in
// common, this has one entry for each scalar and string of either version, with its places.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/name_index.h"
#include "ir/bytecode/symbols.h"
#include "online_change/diff/areas.h"
#include "online_change/plan/plan.h"

namespace online_change {

struct VariableFate {
  Fate fate = Fate::kKept;
  std::string path;           // in the new version; of kDropped: in the old one
  std::string old_path;       // where it had another one
  uint32_t old_address = 0;   // in data memory; 0: the old version has no such variable
  uint32_t new_address = 0;   // 0: the new one has not
  ir::TypeId old_type;        // invalid as old_address
  ir::TypeId new_type;
  bool loses = false;  // it had a value, and that has no place in the new version
  std::string reason;
  const UpdateStep* step = nullptr;  // that writes it; null: nothing does
  const Gather* gather = nullptr;   // of a step that gathers
  uint32_t index = 0;                // of its value in the step
};

class EveryFate {
 public:
  // `old_image` has the names of the new one (ir/bytecode/renames.h). Borrows all three. Cost: each
  // value of the plan, and each variable of the new version.
  EveryFate(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image);

  // The variables of the new version in declaration order, then those that it has no more; from
  // number `first` on, until `visit` is false. Returns the number to go on with; 0: that was all.
  using Visit = std::function<bool(const VariableFate& variable)>;
  uint64_t visit_from(uint64_t first, const Visit& visit) const;

 private:
  struct Written {  // one value of a step
    uint32_t from = 0;
    uint32_t to = 0;
    uint32_t size = 0;
    uint32_t step = 0;
    uint32_t index = 0;
  };
  const Written* writes(uint32_t address) const;
  const Written* reads(uint32_t address) const;
  const Gather* gather_of(const UpdateStep& step) const;  // null: no step that gathers
  std::optional<uint32_t> gathered_from(const Written& value, uint32_t address) const;
  VariableFate of_new(const std::string& path, const ir::Symbol& symbol) const;
  bool goes_on(const std::string& path, const ir::Symbol& symbol) const;
  void name_old(VariableFate& out, uint32_t address) const;
  std::string reason_of(uint32_t row) const;

  const Plan& plan_;
  const ir::Image& old_;
  const ir::Image& new_;
  ir::NameIndex old_names_;
  ir::NameIndex new_names_;
  Areas old_areas_;
  Areas new_areas_;
  std::vector<Written> by_target_;
  std::vector<Written> by_source_;
  uint64_t new_count_ = 0;
  TakenBits taken_;
};

}  // namespace online_change
