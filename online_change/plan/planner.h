// One run of plan(): walks the matched instances and turns type differences into
// steps and fate rows.
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "online_change/diff/areas.h"
#include "online_change/diff/initial_data.h"
#include "online_change/diff/instance_match.h"
#include "online_change/diff/type_diff.h"
#include "online_change/plan/fate_rows.h"
#include "online_change/plan/migration_calls.h"
#include "online_change/plan/plan.h"

namespace online_change {

class Planner {
 public:
  // `renamed`: as TypeDiffer has it.
  Planner(const ir::Image& old_image, const ir::Image& new_image, TypeDiffer::Direction direction,
          bool renamed);
  base::Result<Plan> run();

 private:
  struct Carried {  // an instance that lives on
    uint32_t old_id = 0;
    uint32_t new_id = 0;
    uint32_t from = 0;
    uint32_t to = 0;
    const TypeDiff* diff = nullptr;
    std::string key;  // of its pair of types
    bool moved() const { return from != to; }
  };

  void carry(uint32_t old_id, uint32_t new_id);
  bool nothing_differs(const Carried& instance) const;
  bool stays_whole(const Carried& instance) const;
  bool moves_whole(const Carried& instance);
  void apply(const Carried& instance, const DiffOp& op);
  void apply_same(const Carried& instance, const DiffOp& op);
  void apply_slots(const Carried& instance, const DiffOp& op);
  void apply_in_outs(const Carried& instance, const DiffOp& op);
  void initialise(const Carried& instance, const DiffOp& op, uint32_t fate);
  void copy(const Carried& instance, const DiffOp& op, uint32_t fate);
  void convert(const Carried& instance, const DiffOp& op);
  void enter(const Carried& instance, const DiffOp& op);
  void migrate(const Carried& instance, const DiffOp& op);
  void add_dropped_rows(const Carried& instance);
  void add_instance(uint32_t new_id);
  void drop_instance(uint32_t old_id);

  // planner_rows.cc: row numbers in fates_. What several instances share is one row.
  template <class MakeRow>
  uint32_t share(const std::string& key, uint64_t leaves, MakeRow make);
  uint32_t repeated(const std::string& key, uint64_t leaves);  // kNoRow: there is none yet
  uint32_t first_of(const std::string& key, uint64_t leaves, FateRow row);
  uint32_t row_of(const Carried& instance, uint32_t diff_row, uint64_t leaves,
                  bool other_initial = false);
  uint32_t constant_row(const Carried& instance, const DiffOp& op);
  void name_old_place(const Carried& instance, FateRow& row) const;
  void rename_row(const Carried& instance, bool whole);
  std::string rename_note(const Carried& instance, const DiffOp& op) const;
  std::string initial_note(const Carried& instance, const DiffOp& op, std::string_view path) const;
  uint32_t note_row(const Carried& instance, const DiffOp& op);
  std::string rename_hint(uint32_t new_id);
  std::string program_hint(ir::TypeId type) const;
  std::string type_rename_hint(ir::TypeId before, ir::TypeId after) const;
  uint32_t moved_row(const Carried& instance, const DiffOp& op);
  uint32_t added_row(uint32_t new_id, uint64_t leaves);
  uint32_t dropped_row(uint32_t old_id, uint64_t leaves);
  void find_live();

  bool initial_equal(const Carried& instance, const DiffOp& op) const;
  bool initial_converts(const DiffOp& op, uint32_t from, uint32_t to) const;
  void put(UpdateStep step);
  void put_initial(UpdateStep step, base::Bytes bytes);  // says whether it may come early
  void finish_area();

  const ir::Image& old_;
  const ir::Image& new_;
  bool renamed_;
  bool back_;
  InitialData old_data_;
  InitialData new_data_;
  Areas old_areas_;
  InstanceMatch match_;
  Migrations migrations_;
  TypeDiffer differ_;
  Plan plan_;
  MigrationCalls calls_;  // their code is the new version's, on the way back too
  FateRows fates_;
  std::vector<uint32_t> row_of_new_;  // of added instances, by ID
  std::vector<uint32_t> row_of_old_;  // of dropped ones
  // By old ID: is there a variable in it, or in an instance in it, that the program could write?
  // Empty when no instance goes.
  std::vector<bool> live_inside_;
  std::unordered_set<uint32_t> used_here_;  // rows that the instance at hand already has a part in
  std::vector<UpdateStep> area_;            // steps of the area at hand
  bool too_many_ = false;                   // steps
};

}  // namespace online_change
