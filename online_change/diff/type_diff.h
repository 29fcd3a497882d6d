// What becomes of a value (or of an area) of an old type when it takes a new
// type: relative operations, computed once per pair of types and then applied to
// every variable and instance of that pair, so a million elements cost as much as
// one (A16). Variables meet by name, elements by index, never by position.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "online_change/diff/fates.h"
#include "online_change/diff/migrations.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {

enum class DiffKind : uint8_t {
  kSame,        // the value, unchanged; possibly at another offset
  kConvert,     // one scalar or string by A14
  kInitialise,  // the new initial value
  kSlot,        // instance ID of a function block; its area is a matter of its own
  kEnter,       // a step: from `from`, or from `from_stride` where the step there is active
  kMigrate,     // made by a migration, from the structure or area at `from`
  kInOut,       // address slot, bound again by every call
};

inline constexpr uint32_t kWholeVariable = 0xffffffffu;  // DiffOp::row: no row of its own

// `count` values: from + i * from_stride -> to + i * to_stride. Offsets are
// relative to the value or area.
struct DiffOp {
  DiffKind kind = DiffKind::kSame;
  bool has_source = true;  // kSlot, kInOut: the old version had it
  bool stamp = false;      // kInitialise, in an instance that lives on: it has been made
  bool constant = false;   // kSame: CONSTANT, initialised when its value changed
  uint32_t from = 0;
  uint32_t to = 0;
  uint32_t size = 0;  // bytes in the new version
  uint32_t count = 1;
  uint32_t from_stride = 0;
  uint32_t to_stride = 0;
  ir::TypeId old_type;            // kConvert
  ir::TypeId new_type;            // kConvert, kMigrate
  Migrations::Source migration;   // kMigrate
  uint32_t within = 0;            // kMigrate: of the value in the structure or area that is made
  uint32_t row = kWholeVariable;  // into TypeDiff::rows
  uint64_t leaves = 0;            // scalars and strings, over all `count`
};

struct TypeDiff {
  std::vector<DiffOp> ops;    // sorted by `to`
  std::vector<FateRow> rows;  // paths relative to the value: "", ".member", "[0..9].x"
  bool same = false;          // byte for byte the same layout and meaning
  bool has_rule = true;       // false: A14 knows no way; initialise the whole
  uint64_t leaves = 0;        // of the new type
  bool renamed = false;       // some row says that a variable was renamed
  // Paths of rows whose variables were moved here or away (moved_parts.h).
  std::set<std::string> moved;
  // For function blocks that are new here: what they may have been called, by folded name.
  std::map<std::string, std::string> hints;
};

// Where a variable of a program goes and a global of the same name and type comes, or the other way
// round, the report says how the value goes on. `image`: of the new version.
void propose_reading(const ir::Image& image, std::vector<FateRow>& rows);

class TypeDiffer {
 public:
  enum class Direction : uint8_t { kForward, kBack };  // kBack: for the undo of new -> old
  // `renamed`: the old image is one with the names of the new one (ir/bytecode/renames.h); on the
  // way back, the new one with those of the old one.
  // `migrations` outlives it.
  TypeDiffer(const ir::Image& old_image, const ir::Image& new_image, Direction direction,
             bool renamed, const Migrations& migrations)
      : old_(old_image),
        new_(new_image),
        migrations_(migrations),
        back_(direction == Direction::kBack),
        renamed_(renamed) {}

  // The members of two instance types, two structures or the two globals. Every op of an area
  // that moves has its row in `rows`, one per variable.
  const TypeDiff& area(ir::TypeId old_type, ir::TypeId new_type);
  // A value inside something. The references stay valid.
  const TypeDiff& value(ir::TypeId old_type, ir::TypeId new_type);

  // Scalars and strings in a value, instances not entered.
  uint64_t leaves(const ir::Image& image, ir::TypeId type);

  // Types nested deeper than any verified image has, or more pieces than a change may have.
  bool failed() const { return failed_; }
  bool forward() const { return !back_; }

 private:
  using Key = std::pair<ir::TypeId, ir::TypeId>;
  TypeDiff compare_values(ir::TypeId old_type, ir::TypeId new_type);
  TypeDiff compare_members(ir::TypeId old_type, ir::TypeId new_type, bool is_area);
  TypeDiff compare_arrays(ir::TypeId old_type, ir::TypeId new_type);
  TypeDiff compare_overlapping(ir::TypeId old_type, ir::TypeId new_type);
  void add_views(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type) const;
  TypeDiff compare_leaves(ir::TypeId old_type, ir::TypeId new_type);
  TypeDiff without_conversion(ir::TypeId old_type, ir::TypeId new_type);
  void add_member(TypeDiff& diff, const ir::Member& old_member, uint32_t from,
                  const ir::Member& new_member, uint32_t to, bool is_area);
  void add_new_member(TypeDiff& diff, const ir::Member& member, uint32_t to, const char* reason);
  void add_dropped_member(TypeDiff& diff, ir::TypeId old_type, uint32_t number,
                          ir::TypeId new_type);
  bool add_step(TypeDiff& diff, ir::TypeId old_type, const ir::Member& old_member, uint32_t from,
                ir::TypeId new_type, const ir::Member& new_member, uint32_t to);
  bool add_migrated(TypeDiff& diff, const ir::Member* old_member, ir::TypeId old_type,
                    ir::TypeId new_type, uint32_t member);
  void add_in_out(TypeDiff& diff, const ir::Member* old_member, uint32_t from,
                  const ir::Member& new_member, uint32_t to);
  void append_value(TypeDiff& diff, const TypeDiff& value, const ir::Member& old_member,
                    uint32_t from, const ir::Member& new_member, uint32_t to, bool is_area,
                    std::string note);
  void move_parts(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type);
  uint64_t count_leaves(const ir::Image& image, ir::TypeId type);
  std::string rename_note(const ir::Member& old_member, const ir::Member& new_member) const;
  void explain_rules(TypeDiff& diff, ir::TypeId old_area, ir::TypeId new_area) const;
  void propose_renames(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type) const;
  void propose_migration(TypeDiff& diff, ir::TypeId old_type, ir::TypeId new_type) const;
  Conversion conversion_of(ir::TypeId old_type, ir::TypeId new_type) const;

  const ir::Image& old_;
  const ir::Image& new_;
  const Migrations& migrations_;
  bool back_;
  bool renamed_;
  std::map<Key, std::unique_ptr<TypeDiff>> areas_;
  std::map<Key, std::unique_ptr<TypeDiff>> values_;
  std::map<std::pair<const ir::Image*, ir::TypeId>, uint64_t> leaves_;
  uint32_t depth_ = 0;
  bool failed_ = false;
};

// "; if it is `x` renamed, write ...": of what comes where `x` goes.
std::string rename_proposal(const std::string& old_name);
// "; {migration of := 'B', from := 'A'} FUNCTION A_to_B ...": what keeps values where another type
// takes the place, for the reason of a row.
std::string migration_hint(const ir::Type& before, const ir::Type& after);

// A function block or program of the same name, or one that a migration of either version says the
// other was: instances live on.
bool same_instance_type(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                        ir::TypeId new_type);

}  // namespace online_change
