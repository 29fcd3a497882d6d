#include "ir/bytecode/identities.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"
#include "ir/bytecode/image_fields.h"
#include "ir/bytecode/located_paths.h"

namespace ir {
namespace {

bool has_own_variables(Kind kind) {
  return kind == Kind::kFunctionBlock || kind == Kind::kProgram || kind == Kind::kInterface;
}

class Parts {
 public:
  Parts(const Image& image, const UnitMembers& members)
      : image_(image), members_(members), types_(*image.types) {}

  std::vector<Part> run() {
    units();
    types();
    for (const Member& member : types_[image_.globals].members) {
      base::ByteWriter out;
      write_member(out, member);
      add(PartKind::kGlobal, member.name, out);
    }
    tasks();
    programs();
    for (const LocatedPath& row : located_paths(image_)) {
      base::ByteWriter out;
      write_address(out, row.address);
      add(PartKind::kAddress, row.path, out);
    }
    for (const AccessPath& row : image_.access) {
      base::ByteWriter out;
      out.text(fold_name(row.path));
      out.boolean(row.writable);
      add(PartKind::kAccess, row.name, out);
    }
    others();
    std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
      return std::pair(a.kind, fold_name(a.name)) < std::pair(b.kind, fold_name(b.name));
    });
    return std::move(parts_);
  }

 private:
  void add(PartKind kind, const std::string& name, const base::ByteWriter& out) {
    parts_.push_back({kind, name, base::sha256(out.bytes())});
  }

  // What the sources say of each POU; of an image that does not know, what its code is.
  void units() {
    std::map<std::string, std::map<std::string, uint32_t>> units;
    std::map<std::string, std::string> names;
    for (uint32_t i = 0; i < image_.pous.size(); ++i) {
      const std::string name = unit_name(image_, i, members_);
      if (name.empty()) continue;
      names.emplace(fold_name(name), name);
      units[fold_name(name)].emplace(fold_name(image_.pous[i].name), i);
    }
    for (const auto& [key, pous] : units) {
      base::ByteWriter out;
      for (const auto& [pou, number] : pous) {
        out.text(pou);
        out.u8(static_cast<uint8_t>(image_.pous[number].kind));
        out.raw(image_.contents.empty() ? image_.pous[number].identity
                                        : image_.contents[number].identity);
      }
      add(PartKind::kUnit, names[key], out);
    }
  }

  void types() {
    for (uint32_t i = kElementaryCount; i < types_.size(); ++i) {
      const Type& type = types_[TypeId(i)];
      if (type.name.empty() || type.kind == Kind::kGlobals) continue;
      base::ByteWriter out;
      write_type(out, TypeId(i));
      add(has_own_variables(type.kind) ? PartKind::kBlock : PartKind::kType, type.name, out);
    }
  }

  void write_type_name(base::ByteWriter& out, TypeId id) {
    out.text(id.valid() ? fold_name(types_.text(id)) : "");
  }

  void write_member(base::ByteWriter& out, const Member& member) {
    out.text(fold_name(member.name));
    write_type_name(out, member.type);
    out.u8(static_cast<uint8_t>(member.section));
    out.boolean(member.constant);
    out.boolean(member.retain);
    write_canonical(out, types_, image_.constants, member.type, member.init);
    write_address(out, member.address);
  }

  static void write_address(base::ByteWriter& out, const DirectAddress& address) {
    out.u8(static_cast<uint8_t>(address.area));
    out.u32(address.bit_offset);
    out.u32(address.bit_size);
  }

  void write_type(base::ByteWriter& out, TypeId id) {
    const Type& type = types_[id];
    out.u8(static_cast<uint8_t>(type.kind));
    write_type_name(out, type.base);
    out.i64(type.low);
    out.i64(type.high);
    out.u32(type.capacity);
    out.boolean(type.overlap);
    out.u32(static_cast<uint32_t>(type.dims.size()));
    for (const Dimension& dimension : type.dims) {
      out.i64(dimension.low);
      out.i64(dimension.high);
    }
    out.u32(static_cast<uint32_t>(type.members.size()));
    for (const Member& member : type.members) write_member(out, member);
    out.u32(static_cast<uint32_t>(type.literals.size()));
    for (const EnumLiteral& literal : type.literals) {
      out.text(fold_name(literal.name));
      out.i64(literal.value);
    }
    out.u32(static_cast<uint32_t>(type.interfaces.size()));
    for (const TypeId interface : type.interfaces) write_type_name(out, interface);
    // Elements of the initial value are numbered as the members are.
    write_canonical(out, types_, image_.constants, id, type.init);
  }

  void tasks() {
    for (const ImageTask& task : image_.tasks) {
      ImageWriter fields(256);
      fields(task.period_ns);
      fields(task.watchdog_ns);
      fields(task.priority);
      fields(task.once);
      policy_fields(fields, task.policy);
      base::ByteWriter out;
      out.blob(fields.take());
      const uint32_t event = event_global(image_, task);
      const std::vector<Member>& globals = types_[image_.globals].members;
      out.text(event == kNoEvent ? "" : fold_name(globals[event].name));
      add(PartKind::kTask, task.name, out);
    }
  }

  // With the tasks that it runs in, as a whole or by its blocks.
  void programs() {
    for (const uint32_t id : image_.program_ids()) {
      base::ByteWriter out;
      write_type_name(out, image_.instances[id].type);
      for (const ImageTask& task : image_.tasks) {
        for (const uint32_t run : task.programs) {
          const bool block = run != id && image_.instances[run].parent == id;
          if (run != id && !block) continue;
          out.text(fold_name(task.name));
          out.text(block ? fold_name(image_.instances[run].name) : "");
        }
      }
      add(PartKind::kProgram, image_.instances[id].name, out);
    }
  }

  void others() {
    for (const Device& device : image_.devices) {
      ImageWriter fields(256);
      device_fields(fields, device);
      base::ByteWriter out;
      out.raw(fields.take());
      add(PartKind::kDevice, device.name, out);
    }
    for (const SafeOutput& row : image_.safe) {
      ImageWriter fields(64);
      safe_fields(fields, row);
      base::ByteWriter out;
      out.raw(fields.take());
      add(PartKind::kSafe, safe_name(row), out);
    }
    base::ByteWriter out;
    out.u8(static_cast<uint8_t>(image_.schedule));
    add(PartKind::kSchedule, "", out);
  }

  const Image& image_;
  const UnitMembers& members_;
  const TypeTable& types_;
  std::vector<Part> parts_;
};

}  // namespace

std::string_view part_kind_name(PartKind kind) {
  constexpr std::string_view kNames[kPartKindCount] = {
      "unit",   "type",       "variables of", "global",        "task",    "program",
      "access", "address of", "device",       "safe value of", "schedule"};
  return kNames[static_cast<size_t>(kind)];
}

uint32_t event_global(const Image& image, const ImageTask& task) {
  if (task.event == 0) return kNoEvent;
  const uint32_t at = task.event - image.instances.all()[0].data;
  const std::vector<uint32_t>& offsets = image.layouts[image.globals].member_offsets;
  for (uint32_t i = 0; i < offsets.size(); ++i) {
    const Member& member = image.types[image.globals].members[i];
    if (offsets[i] == at && image.types.is_scalar(member.type)) return i;
  }
  return kNoEvent;
}

std::string safe_name(const SafeOutput& row) {
  return "%QX" + std::to_string(row.bit_offset / 8) + "." + std::to_string(row.bit_offset % 8);
}

std::string unit_name(const Image& image, uint32_t pou, const UnitMembers& members) {
  const LinkedPou& row = image.pous[pou];
  const bool made = !image.contents.empty() && image.contents[pou] == PouContent{};
  if (row.name.empty() || made) return "";
  if (row.kind != PouKind::kMethod) return unit_of(members, row.name);
  const UnitMember* const section = find_unit_member(members, row.name);
  return section != nullptr ? section->unit : unit_of(members, (*image.types)[row.self].name);
}

const UnitMember* find_unit_member(const UnitMembers& members, const std::string& name) {
  if (members.empty()) return nullptr;
  const std::string folded = fold_name(name);
  const auto found = std::lower_bound(members.begin(), members.end(), folded,
                                      [](const UnitMember& row, const std::string& wanted) {
                                        return fold_name(row.name) < wanted;
                                      });
  return found != members.end() && fold_name(found->name) == folded ? &*found : nullptr;
}

void sort_by_name(UnitMembers& members) {
  std::sort(members.begin(), members.end(), [](const UnitMember& a, const UnitMember& b) {
    return fold_name(a.name) < fold_name(b.name);
  });
}

const std::string& unit_of(const UnitMembers& members, const std::string& name) {
  const UnitMember* const row = find_unit_member(members, name);
  return row == nullptr ? name : row->unit;
}

std::vector<Part> parts_of(const Image& image, const UnitMembers& members) {
  return Parts(image, members).run();
}

const Part* find_part(const std::vector<Part>& parts, PartKind kind, std::string_view name) {
  const std::string key = fold_name(std::string(name));
  const auto found =
      std::lower_bound(parts.begin(), parts.end(), std::pair(kind, key),
                       [](const Part& part, const std::pair<PartKind, std::string>& wanted) {
                         return std::pair(part.kind, fold_name(part.name)) < wanted;
                       });
  const bool there = found != parts.end() && found->kind == kind && same_name(found->name, name);
  return there ? &*found : nullptr;
}

}  // namespace ir
