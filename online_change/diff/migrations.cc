#include "online_change/diff/migrations.h"

#include <algorithm>

#include "ir/bytecode/variable_names.h"
#include "online_change/diff/value_conversion.h"

namespace online_change {
namespace {

using ir::TypeId;

constexpr uint32_t kNone = 0xffffffffu;

TypeId type_named(const ir::Image& image, ir::Kind kind, const std::string& name) {
  for (uint32_t i = ir::kElementaryCount; i < image.types.size(); ++i) {
    const ir::Type& candidate = image.types[TypeId(i)];
    if (candidate.kind == kind && ir::same_name(candidate.name, name)) return TypeId(i);
  }
  return {};
}

}  // namespace

TypeId same_type_in(const ir::Image& image, const ir::Image& other, TypeId type) {
  const ir::Type& wanted = other.types[type];
  return wanted.kind == ir::Kind::kGlobals ? image.globals
                                           : type_named(image, wanted.kind, wanted.name);
}

Migrations::Migrations(const ir::Image& old_image, const ir::Image& new_image, Way way)
    : old_(old_image),
      new_(new_image),
      way_(way),
      from_(way == Way::kThere ? old_image : new_image),
      to_(way == Way::kThere ? new_image : old_image) {
  for (uint32_t row = 0; row < new_.migrations.size() && !error_; ++row) add(row);
}

bool Migrations::is_carried(const ir::LinkedMigration& row) const {
  const ir::LinkedPou& code = new_.pous[row.pou];
  return std::any_of(old_.migrations.begin(), old_.migrations.end(),
                     [&](const ir::LinkedMigration& other) {
                       const ir::LinkedPou& before = old_.pous[other.pou];
                       return other.inverse == row.inverse && before.identity == code.identity &&
                              ir::same_name(before.name, code.name);
                     });
}

void Migrations::fail(const ir::LinkedMigration& row, std::string why) {
  if (error_) return;
  error_ = base::Error{base::Refusal::kBadMigration,
                       "migration `" + new_.pous[row.pou].name + "`: " + std::move(why)};
}

void Migrations::add(uint32_t number) {
  const ir::LinkedMigration& row = new_.migrations[number];
  const bool carried = is_carried(row);
  if (carried && !row.from_other) return;
  const TypeId old_type = row.from_other ? type_named(old_, new_.types[row.type].kind, row.from)
                                         : same_type_in(old_, new_, row.type);
  if (!old_type.valid()) return;  // nothing lives that could migrate
  const bool there = way_ == Way::kThere;
  if (row.inverse == there) {
    // The way back knows what the way there has made.
    for (const ir::MigratedName& value : row.values) {
      const uint32_t slot = slot_of(row, value.parameter);
      if (there || slot == kNone || new_.pous[row.pou].slots[slot].local == ir::LocalKind::kInput) {
        continue;
      }
      const int32_t member = to_.types.find_member(old_type, value.member);
      if (member >= 0) restored_.insert({row.type, old_type, static_cast<uint32_t>(member)});
    }
    return;
  }
  Migration migration;
  migration.row = number;
  migration.from_type = there ? old_type : row.type;
  migration.to_type = there ? row.type : old_type;
  for (size_t i = 0; i < row.values.size(); ++i) {
    if (add_value(migration, row, i)) continue;
    if (carried) error_.reset();  // the types went on from what it was written for
    return;
  }
  const auto place = static_cast<uint32_t>(rows_.size());
  for (uint32_t i = 0; i < migration.values.size(); ++i) {
    const MigratedValue& value = migration.values[i];
    if (value.place != 0) {
      note_reader(row.values[i].member, new_.pous[row.pou].name);
    } else if (value.input) {
      read_.try_emplace({migration.from_type, migration.to_type, value.member},
                        new_.pous[row.pou].name);
    } else if (!made_
                    .try_emplace({migration.from_type, migration.to_type, value.member},
                                 Source{place, i})
                    .second) {
      return fail(row, "`" + row.values[i].member + "` is given by another migration, too");
    }
  }
  rows_.push_back(std::move(migration));
}

uint32_t Migrations::slot_of(const ir::LinkedMigration& row, const std::string& parameter) const {
  const std::vector<ir::FrameSlot>& slots = new_.pous[row.pou].slots;
  for (uint32_t i = 0; i < slots.size(); ++i) {
    if (slots[i].kind == ir::SlotKind::kParam && slots[i].name == parameter) return i;
  }
  return kNone;
}

bool Migrations::add_value(Migration& migration, const ir::LinkedMigration& row, size_t number) {
  const ir::MigratedName& name = row.values[number];
  const std::vector<ir::FrameSlot>& slots = new_.pous[row.pou].slots;
  MigratedValue value;
  value.slot = slot_of(row, name.parameter);
  if (value.slot == kNone) {
    fail(row, "it has no parameter `" + name.parameter + "`");
    return false;
  }
  value.input = slots[value.slot].local == ir::LocalKind::kInput;
  const ir::Image& image = value.input ? from_ : to_;
  const TypeId type = value.input ? migration.from_type : migration.to_type;
  const char* version = &image == &old_ ? "running" : "new";
  const int32_t member = image.types.find_member(type, name.member);
  if (member >= 0) {
    value.member = static_cast<uint32_t>(member);
    const ir::Member& found = image.types[type].members[value.member];
    value.type = found.section == ir::Section::kInOut ? TypeId() : found.type;
  } else if (!value.input || !find_elsewhere(name.member, value)) {
    const bool globals = type == image.globals;
    fail(row, (globals ? std::string("the globals") : "`" + image.types.text(type) + "`") +
                  " of the " + version + " program " + (globals ? "have" : "has") + " no `" +
                  name.member + "`; take the parameter out, or name another variable");
    return false;
  }
  if (!fits(slots[value.slot], value.type, value.input)) {
    fail(row, "`" + name.member + "` of the " + version + " program is " +
                  (value.type.valid() ? image.types.text(value.type) : "an in-out") + ", `" +
                  name.parameter + "` is " + new_.types.text(slots[value.slot].region.type) +
                  "; declare the parameter with the type of the variable");
    return false;
  }
  migration.values.push_back(value);
  return true;
}

// `Main.ticks`, `GVL.x`: where another area has it.
bool Migrations::find_elsewhere(const std::string& path, MigratedValue& value) const {
  const base::Result<ir::Symbol> symbol =
      ir::named_symbol(from_, path.starts_with('.') ? path.substr(1) : path);
  if (!symbol.ok() || symbol->bit_mask != 0) return false;
  value.place = symbol->data;
  value.type = symbol->type;
  return true;
}

// What of a program or of the globals goes is not lost then.
void Migrations::note_reader(const std::string& path, const std::string& reader) {
  const size_t dot = path.find('.');
  const std::string program = path.substr(0, dot);
  const auto note = [&](TypeId type, const std::string& name) {
    const int32_t member = from_.types.find_member(type, name);
    const TypeId next = member < 0 ? TypeId() : same_type_in(to_, from_, type);
    if (next.valid()) read_.try_emplace({type, next, static_cast<uint32_t>(member)}, reader);
  };
  note(from_.globals, dot == 0 ? path.substr(1) : path);
  for (const uint32_t id : from_.program_ids()) {
    const bool meant = dot != std::string::npos && ir::same_name(from_.instances[id].name, program);
    if (meant) note(from_.instances[id].type, path.substr(dot + 1));
  }
}

// Inputs take what A14 carries over exactly, outputs are of the variable's own type.
bool Migrations::fits(const ir::FrameSlot& slot, TypeId type, bool input) const {
  const ir::Image& image = input ? from_ : to_;
  if (!type.valid() || image.types.is_instance(type)) return false;
  if (ir::same_value_type(image.types, image.layouts, type, new_.types, new_.layouts,
                          slot.region.type)) {
    return true;
  }
  if (!input) return false;
  const Conversion way = classify(image.types, type, new_.types, slot.region.type);
  return way == Conversion::kSame || way == Conversion::kExact;
}

std::optional<Migrations::Source> Migrations::source_of(TypeId from_type, TypeId to_type,
                                                        uint32_t member) const {
  const auto found = made_.find({from_type, to_type, member});
  if (found == made_.end()) return std::nullopt;
  return found->second;
}

std::string Migrations::reader_of(TypeId from_type, TypeId to_type, uint32_t member) const {
  const auto found = read_.find({from_type, to_type, member});
  return found == read_.end() ? std::string() : found->second;
}

bool Migrations::is_restored(TypeId from_type, TypeId to_type, uint32_t member) const {
  return restored_.contains({from_type, to_type, member});
}

std::string Migrations::name_of(uint32_t migration) const {
  return new_.pous[new_.migrations[rows_[migration].row].pou].name;
}

}  // namespace online_change
