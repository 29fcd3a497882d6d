// Migrations: functions whose parameters are plain values, each bound to a variable, and whose
// calls fit the stack that they run on alone.
#include <algorithm>

#include "ir/bytecode/verify_parts.h"
#include "ir/types/parts.h"

namespace ir::verification {
namespace {

class MigrationVerifier {
 public:
  explicit MigrationVerifier(const Image& image) : image_(image) {}

  base::Status run() const {
    for (const LinkedMigration& row : image_.migrations) {
      if (base::Status s = check(row); !s) return s;
    }
    return base::Ok{};
  }

 private:
  static base::Error bad(const std::string& name, const char* why) {
    return refuse(Refusal::kBadReference, "migration `" + name + "`: " + why);
  }

  base::Status check(const LinkedMigration& row) const {
    const bool code = row.pou < image_.pous.size() &&
                      image_.pous[row.pou].kind == PouKind::kFunction &&
                      image_.pous[row.pou].unit_count != 0;
    if (!code) return bad("", "it is no function");
    const LinkedPou& pou = image_.pous[row.pou];
    if (!is_owner(row.type)) return bad(pou.name, "its values belong to no instance or structure");
    if (row.from_other && row.from.empty()) return bad(pou.name, "the other type has no name");
    if (row.from_other && row.type == image_.globals) {
      return bad(pou.name, "the globals were never of another type");
    }
    for (const MigratedName& value : row.values) {
      const auto same = [&](const MigratedName& other) {
        return other.parameter == value.parameter;
      };
      if (std::count_if(row.values.begin(), row.values.end(), same) != 1) {
        return bad(pou.name, "a parameter has two variables");
      }
    }
    for (const FrameSlot& slot : pou.slots) {
      if (slot.kind == SlotKind::kParam && !is_bound(slot, row)) {
        return bad(pou.name, "a parameter is no plain value, or has no variable");
      }
    }
    return base::Ok{};
  }

  bool is_owner(TypeId type) const {
    if (!image_.types.contains(type)) return false;
    const bool structure = image_.types[type].kind == Kind::kStruct && !image_.types.overlaps(type);
    return structure || image_.types.is_instance(type) || type == image_.globals;
  }

  bool is_bound(const FrameSlot& slot, const LinkedMigration& row) const {
    if (slot.local == LocalKind::kReturn) return true;
    const bool value = slot.local == LocalKind::kInput || slot.local == LocalKind::kOutput;
    const bool plain = image_.types.contains(slot.region.type) && slot.region.dim == 0 &&
                       (slot.aggregate || slot.cls != Class::kA) && is_plain(slot.region.type);
    const bool output = slot.local == LocalKind::kOutput;
    return value && plain &&
           std::any_of(row.values.begin(), row.values.end(), [&](const MigratedName& other) {
             return other.parameter == slot.name && other.output == output;
           });
  }

  // Nothing that names a place: it would mean another one, or none, in the other version.
  bool is_plain(TypeId id) const {
    const TypeTable& types = *image_.types;
    return !any_part(types, id, [&](TypeId part) {
      return types.is_reference(part) || types.is_instance(part) ||
             types[part].kind == Kind::kInterface;
    });
  }

  const Image& image_;
};

}  // namespace

base::Status verify_migrations(const Image& image) { return MigrationVerifier(image).run(); }

}  // namespace ir::verification
