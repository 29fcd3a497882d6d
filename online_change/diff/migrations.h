// X2: migrations in Structured Text. A function of the new version that makes the values of some
// variables of a program, function block, the globals or a structure from those of the old version;
// or, for undo, those of the old one from the new one's. Which of them apply to two versions, and
// to which variables.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"

namespace online_change {

// A parameter of a migration, resolved against both versions.
struct MigratedValue {
  uint32_t slot = 0;  // of the function's frame
  bool input = false;
  uint32_t member = 0;  // inputs: of the version that is read; outputs: of the one that is made
  // An input from another area, by its path: in data memory of the version that is read; 0: none.
  uint32_t place = 0;
  ir::TypeId type = {};  // there
};

struct Migration {
  uint32_t row = 0;      // in Image::migrations of the version with the code
  ir::TypeId from_type;  // of instances and values in the version that is read
  ir::TypeId to_type;    // in the one that is made
  std::vector<MigratedValue> values;
};

class Migrations {
 public:
  enum class Way : uint8_t { kThere, kBack };
  // `old_image` has the new version's names (ir/bytecode/renames.h). A migration that the old
  // version carries already, of the same name and code, does not apply again, unless it is from
  // another type: that is applied once for each variable, when its type changes.
  Migrations(const ir::Image& old_image, const ir::Image& new_image, Way way);

  // A migration that cannot be carried out between these versions (kBadMigration).
  const std::optional<base::Error>& error() const { return error_; }
  const std::vector<Migration>& rows() const { return rows_; }
  // The migration, by number, and its value that gives `member` of `to_type`, where that is made
  // from a value of `from_type`: a structure may also take the place of another one, by A14.
  struct Source {
    uint32_t migration = 0;
    uint32_t value = 0;
  };
  std::optional<Source> source_of(ir::TypeId from_type, ir::TypeId to_type, uint32_t member) const;
  // The name of a migration that reads the member of `from_type`; "" for none.
  std::string reader_of(ir::TypeId from_type, ir::TypeId to_type, uint32_t member) const;
  // On the way back: is it a member of `to_type` that the way there made anew, so that only the
  // value from before can be right?
  bool is_restored(ir::TypeId from_type, ir::TypeId to_type, uint32_t member) const;
  std::string name_of(uint32_t migration) const;

 private:
  using Key = std::tuple<ir::TypeId, ir::TypeId, uint32_t>;  // from, to, and a member of one
  void add(uint32_t row);
  bool is_carried(const ir::LinkedMigration& row) const;
  uint32_t slot_of(const ir::LinkedMigration& row, const std::string& parameter) const;
  bool add_value(Migration& migration, const ir::LinkedMigration& row, size_t number);
  bool fits(const ir::FrameSlot& slot, ir::TypeId type, bool input) const;
  bool find_elsewhere(const std::string& path, MigratedValue& value) const;
  void note_reader(const std::string& path, const std::string& reader);
  void fail(const ir::LinkedMigration& row, std::string why);

  const ir::Image& old_;
  const ir::Image& new_;
  Way way_;
  const ir::Image& from_;
  const ir::Image& to_;
  std::vector<Migration> rows_;
  std::map<Key, Source> made_;
  std::map<Key, std::string> read_;
  std::set<Key> restored_;
  std::optional<base::Error> error_;
};

// The type of that kind and name; invalid: none.
ir::TypeId same_type_in(const ir::Image& image, const ir::Image& other, ir::TypeId type);

}  // namespace online_change
