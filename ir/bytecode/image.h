// An image: everything a controller needs to run one version of a program, and
// everything a later version needs to be planned against it (types, layouts,
// instance tree), so a lost build folder never forces a stop.
//
// Data memory is one range of 32-bit offsets (memory map below). Offset 0..63 is
// never used. Areas (globals, program and FB instances) lie in
// [kDataBegin, data_capacity); what no area owns is in `free`. Constant pools of
// the two generations and the stack lie beyond, at fixed places.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "base/shared.h"
#include "ir/bytecode/code.h"
#include "ir/bytecode/devices.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"
#include "ir/types/constants.h"
#include "ir/types/layout.h"
#include "ir/types/types.h"

namespace ir {

inline constexpr uint32_t kDataBegin = 64;
inline constexpr uint32_t kConstPoolA = 0xf0000000u;  // even generations
inline constexpr uint32_t kConstPoolB = 0xf4000000u;  // odd generations
inline constexpr uint32_t kConstPoolLimit = 0x04000000u;
inline constexpr uint32_t kStackBegin = 0xf8000000u;
inline constexpr uint32_t kStackLimit = 0x04000000u;

// The TYPE field of linked code: type number in bits 0-27, dim in bits 28-31.
constexpr uint32_t region_field(Region region) {
  return region.type.index | static_cast<uint32_t>(region.dim) << 28;
}
constexpr Region region_of_field(uint32_t field) {
  return {TypeId(field & 0x0fffffffu), static_cast<uint8_t>(field >> 28)};
}

// Frame slot of linked code.
struct FrameSlot {
  uint32_t offset = 0;
  SlotKind kind = SlotKind::kTemp;  // kParam, kLocal or kTemp
  LocalKind local = LocalKind::kTemp;
  bool aggregate = false;
  Class cls = Class::kB;
  Region region;
  std::string name;
};

struct LinkedPou {
  std::string name;
  PouKind kind = PouKind::kFunction;
  TypeId self;
  uint32_t recursion_depth = 0;  // activations at once; 0: it is in no circle of calls
  std::string file;
  base::Digest identity{};  // of the object (E1)
  uint32_t frame_size = 0;  // multiple of 8
  uint32_t first_unit = 0;  // in Image::code
  uint32_t unit_count = 0;
  base::SharedVector<FrameSlot> slots;  // sorted by offset; params first
  base::SharedVector<Merge> merges;     // units relative to first_unit; `slots` index FrameSlots
  base::SharedVector<LineEntry> lines;
};

// What the sources say of a POU, whatever the compiler made of it (E-02, E-03); 0: they say
// nothing.
struct PouContent {
  base::Digest identity{};
  friend bool operator==(const PouContent&, const PouContent&) = default;
};

struct HeldPart {
  uint32_t pou = 0;  // in Image::pous
  HeldName what;
  friend auto operator<=>(const HeldPart&, const HeldPart&) = default;
};

// A POU whose unit is neither its own nor that of its block (E-01): several that a project joins,
// or a PROGRAM's action as a section by itself.
struct UnitMember {
  std::string name;  // of the POU, for all that is in it, or "PROGRAM.ACTION"
  std::string unit;
  friend bool operator==(const UnitMember&, const UnitMember&) = default;
};

struct LinkedBound {
  int64_t low = 0;
  uint64_t count = 0;
  uint32_t stride = 0;
  Region from;  // region that is indexed; `to` follows: dim + 1, or the element type
  std::string name;
};

// Row of the instance information table (A9). Row 0 is the globals area.
struct Instance {
  TypeId type;
  uint32_t data = 0;        // offset of its area
  uint32_t pou = 0;         // index into Image::pous; unused for row 0
  uint32_t parent = 0;      // instance that holds the slot; 0: a program, or in globals
  uint32_t generation = 0;  // counts the reuses of this ID
  bool live = false;        // false: the ID is free
  std::string name;         // "Prog1", "inst2", "arr[3]", "s.fb": path from the parent
  OldNameId old_name;       // of a program; others are renamed with their variables
};

struct Extent {
  uint32_t offset = 0;
  uint32_t size = 0;
  friend bool operator==(const Extent&, const Extent&) = default;
};

struct DataRun {  // initial bytes; whatever no run covers is zero
  uint32_t offset = 0;
  base::Bytes bytes;
};

struct ImageTask {
  std::string name;
  int64_t period_ns = 0;
  int64_t watchdog_ns = 0;
  uint32_t priority = 0;
  uint32_t event = 0;  // data offset of the BOOL whose edges release it; 0: none (ir::Task)
  std::vector<uint32_t> programs = {};  // instance IDs, in order of execution
  bool once = false;                    // at cold start, before the first scan; period 0
  TaskPolicy policy = {};
};

// CALL_VIRTUAL of POU `prototype` runs POU `target` on instances of `type`.
struct LinkedOverride {
  TypeId type;
  uint32_t prototype = 0;
  uint32_t target = 0;
};

// Binds a located variable to the process image (A BOOL takes one bit there).
struct IoBinding {
  DirectAddress address;
  uint32_t data = 0;  // offset of the variable
  TypeId type;
  friend bool operator==(const IoBinding&, const IoBinding&) = default;
};

// What some bits of the process image become when their task stops, and when everything does:
// a value, or what they are, or that for a time. Outputs without a row become 0.
enum class SafeKind : uint8_t { kValue, kHold, kHoldThenValue };
struct SafeOutput {
  uint32_t bit_offset = 0;  // of %Q
  uint32_t bits = 0;        // 1, or whole bytes up to 64
  SafeKind kind = SafeKind::kValue;
  uint64_t value = 0;
  int64_t hold_ns = 0;
};

struct RetainRange {
  uint32_t data = 0;
  uint32_t size = 0;
};

// As in ir::Migration; the parameters are frame slots of those names.
struct LinkedMigration {
  TypeId type;
  uint32_t pou = 0;
  bool inverse = false;
  bool from_other = false;  // only then
  std::string from = {};
  std::vector<MigratedName> values;
};

// The net of the chart that is the body of a POU; for what later versions may do with its steps
// (online_change/apply/chart_net.h). Numbers count members of the POU's instance type.
struct LinkedChart {
  uint32_t pou = 0;
  std::vector<ChartMove> moves;
  friend bool operator==(const LinkedChart&, const LinkedChart&) = default;
};

// A TypeTable that versions have in common.
class ImageTypes : public base::Shared<TypeTable> {
 public:
  using Shared::Shared;
  TypeId elementary(Kind kind) const { return (*this)->elementary(kind); }
  bool knows(OldNameId id) const { return (*this)->knows(id); }
  const std::string& old_name(OldNameId id) const { return (*this)->old_name(id); }
  const std::vector<std::string>& old_names() const { return (*this)->old_names(); }
  bool is_scalar(TypeId id) const { return (*this)->is_scalar(id); }
  Scalar scalar(TypeId id) const { return (*this)->scalar(id); }
  Kind root_kind(TypeId id) const { return (*this)->root_kind(id); }
  bool has_members(TypeId id) const { return (*this)->has_members(id); }
  bool is_reference(TypeId id) const { return (*this)->is_reference(id); }
  bool overlaps(TypeId id) const { return (*this)->overlaps(id); }
  bool is_instance(TypeId id) const { return (*this)->is_instance(id); }
  bool is_a(TypeId id, TypeId wanted) const { return (*this)->is_a(id, wanted); }
  int32_t find_member(TypeId id, std::string_view name) const {
    return (*this)->find_member(id, name);
  }
  std::string text(TypeId id) const { return (*this)->text(id); }
};

// A copy shares its large tables with the original until either changes them.
struct Image {
  std::string name;
  ImageTypes types;
  base::Shared<ConstTable> constants;  // initial values, for planning later versions
  base::Shared<Layouts> layouts;
  TypeId globals;
  std::vector<LinkedPou> pous;
  std::vector<Unit> code;
  base::Bytes pool;  // constant pool
  base::SharedVector<LinkedBound> bounds;
  base::SharedVector<Range> ranges;
  std::vector<LinkedOverride> overrides;  // sorted by type, then prototype; no pair twice
  base::SharedVector<Instance> instances;
  std::vector<Extent> free;  // sorted, disjoint, never adjacent
  std::vector<ImageTask> tasks;
  std::vector<AccessPath> access;
  std::vector<LinkedMigration> migrations;
  std::vector<IoBinding> io;
  std::vector<SafeOutput> safe;  // sorted by bit_offset, disjoint
  std::vector<RetainRange> retain;
  std::vector<SharedGlobal> shared;  // by member
  std::vector<LinkedChart> charts;   // sorted by POU; none in images before version 9
  base::SharedVector<DataRun> data;  // sorted by offset
  uint32_t data_capacity = 0;
  uint32_t stack_bytes = 0;  // for the deepest chain, over all priorities
  uint32_t call_depth = 0;
  uint32_t input_bytes = 0;  // process image sizes
  uint32_t output_bytes = 0;
  std::vector<Device> devices;
  std::vector<PouContent> contents;   // by POU; none in images before version 11
  base::SharedVector<HeldPart> held;  // sorted, none twice; none in images before version 13
  // Sorted by folded name, none twice; none in images before version 19.
  std::vector<UnitMember> unit_members;
  Schedule schedule = Schedule::kSendFirst;

  // Live program instances in declaration order.
  std::vector<uint32_t> program_ids() const;
  // "Main.fb.arr[3]"; "" for row 0.
  std::string instance_path(uint32_t id) const;
};

// Initial bytes of data memory at `offset`; what no run covers is zero. O(log runs).
void read_initial(const Image& image, uint32_t offset, std::span<uint8_t> out);
// For an ID slot: the instance that it names from the start and for as long as it lives.
uint32_t initial_id(const Image& image, uint32_t slot);

// The stored form: magic, version, length, SHA-256 of the rest, sections.
base::Bytes encode(const Image& image);
// Checks form only (V1, V2); what runs must go through verify().
base::Result<Image> decode(base::ByteSpan bytes);
// Where the layout of an encoded image (program facts, types, initial values, offsets) ends and its
// program (POUs, code, tables, data) begins; its size when it is cut off before.
size_t layout_end(base::ByteSpan encoded);
inline constexpr std::string_view kImageMagic = "STCIMAGE";
// Does the file begin as an image does? For tools that take images and sources.
bool has_image_magic(base::ByteSpan bytes);
// The digest in the header: the name of this version everywhere.
base::Digest digest(base::ByteSpan encoded);

std::string disassemble(const Image& image, const LinkedPou& pou);

}  // namespace ir
