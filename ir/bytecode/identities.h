// What an image is made of, each part with an identity of what it says (E-02 to E-04): so two
// programs that were compiled apart, with other addresses, other numbers and another compiler, can
// be compared part by part. Everything refers to everything else by name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "ir/bytecode/image.h"

namespace ir {

enum class PartKind : uint8_t {
  kUnit,      // a function, function block, program or interface, with its methods (E-01); or what
              // the project has made of several of these
  kType,      // a structure, enumeration, subrange or other name for a type
  kBlock,     // the variables of a function block or program, inherited and hidden ones too
  kGlobal,    // a global variable
  kTask,      //
  kProgram,   // an instance of a program
  kAccess,    // a name of VAR_ACCESS
  kAddress,   // of a variable of one instance (VAR_CONFIG)
  kDevice,    // with its map
  kSafe,      // the safe value of an output
  kSchedule,  // of the control cycle; its name is empty
};
inline constexpr uint32_t kPartKindCount = 11;
// "function block", as people say it.
std::string_view part_kind_name(PartKind kind);

struct Part {
  PartKind kind = PartKind::kUnit;
  std::string name;
  base::Digest identity{};
};

using UnitMembers = std::vector<UnitMember>;  // as Image::unit_members

// Sorted by kind, then by name without case; no two of one kind and name. `members`: which POUs are
// a unit. Where versions are compared, all of them have the units of the edited one.
std::vector<Part> parts_of(const Image& image, const UnitMembers& members);
inline std::vector<Part> parts_of(const Image& image) {
  return parts_of(image, image.unit_members);
}
// Null: there is none.
const Part* find_part(const std::vector<Part>& parts, PartKind kind, std::string_view name);

// Number of the global whose rising edges release the task; kNoEvent: none do.
uint32_t event_global(const Image& image, const ImageTask& task);
// "%QX4.0": where it begins.
std::string safe_name(const SafeOutput& row);
// The name of the unit that a POU belongs to: its own, that of its block, or what `members` says.
// Empty: the POU is no part of the sources, or its number is unused.
std::string unit_name(const Image& image, uint32_t pou, const UnitMembers& members);
inline std::string unit_name(const Image& image, uint32_t pou) {
  return unit_name(image, pou, image.unit_members);
}
// Of a POU with its members, or of a section: `name` itself where no row has it.
const std::string& unit_of(const UnitMembers& members, const std::string& name);
// Null: no row has it.
const UnitMember* find_unit_member(const UnitMembers& members, const std::string& name);
// In the order of Image::unit_members.
void sort_by_name(UnitMembers& members);

}  // namespace ir
