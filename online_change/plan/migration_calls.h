// Calls of migrations on their way into a plan: one for each instance, or value of a structure,
// that migrates, however many values it gives.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "online_change/diff/migrations.h"
#include "online_change/diff/type_diff.h"
#include "online_change/plan/plan.h"

namespace online_change {

class MigrationCalls {
 public:
  // From `from` to another version; `code` is the one with the functions. `migrations` has no
  // error.
  MigrationCalls(Plan& plan, const Migrations& migrations, const ir::Image& from,
                 const ir::Image& code)
      : plan_(plan), migrations_(migrations), from_(from), code_(code) {}

  // After the last value of an instance.
  void end_instance() { here_.clear(); }
  // The step for value `index` of a kMigrate operation of the instance that is `instance` in the
  // version that is made, and whose area was at `from` and is at `to`.
  UpdateStep step(const DiffOp& op, uint32_t index, uint32_t instance, uint32_t from, uint32_t to,
                  uint32_t fate);

 private:
  uint32_t call_for(const DiffOp& op, uint32_t instance, uint32_t from, uint32_t to);

  Plan& plan_;
  const Migrations& migrations_;
  const ir::Image& from_;
  const ir::Image& code_;
  // Calls of the instance at hand, by number in migrations_ and place of what is read.
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> here_;
};

// "`Main.tank`", "`Main.path[3]`", "the globals": whose values the call makes. `to` is the version
// that is made.
std::string place_of(const MigrationCall& call, const ir::Image& to);

}  // namespace online_change
