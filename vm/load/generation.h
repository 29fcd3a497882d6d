// A Generation: a verified image made ready to run. Code with operand bases
// resolved into handler numbers, POU table (D1), instance information table (A9),
// constant pool. Immutable once built; at most two exist, running and previous.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "ir/bytecode/bools.h"
#include "ir/bytecode/verify.h"
#include "ir/types/reach.h"
#include "vm/exec/tier.h"
#include "vm/load/code_slots.h"

namespace vm {
namespace native {
class Program;
struct Progress;
}  // namespace native

struct PouEntry {
  const ir::Unit* code = nullptr;  // first unit, decoded
  const ir::Unit* entry =
      nullptr;  // where a call goes: `code`, or a unit that goes on in machine code
  const void* machine = nullptr;  // where a call from machine code goes
  uint32_t frame_size = 0;
  uint32_t recursion_depth = 0;  // 0: never in a circle of calls
};

// Another number for each object, also for a copy and for what is assigned.
struct CodeNumber {
  uint64_t value = next();
  CodeNumber() = default;
  CodeNumber(const CodeNumber&) {}
  CodeNumber& operator=(const CodeNumber&) {
    value = next();
    return *this;
  }
  static uint64_t next();
};

// What executions run. Immutable once made, so that another table of the same generation can be
// prepared beside it and takes its place between two scans by one store (TaskTables::code).
struct CodeTable {
  std::vector<PouEntry> pous;
  std::shared_ptr<const native::Program> native;  // null: everything is interpreted
  bool clean_bools = false;                       // ir::Bools::stay_clean, for machine code
  CodeNumber number = {};                         // what an execution remembers
};

// The newest code of a generation, whose machine code may be made beside it, and after its end.
struct NewestCode {
  std::shared_ptr<const CodeTable> first;
  std::shared_ptr<const CodeTable> with_native;  // made beside
  std::atomic<const std::shared_ptr<const CodeTable>*> newest = &first;
};

// Code of a version, and what it is code of.
struct MadeCode {
  ir::VerifiedImage version;
  std::shared_ptr<const CodeTable> table;
};

struct InstanceEntry {
  uint32_t data = 0;  // 0: the ID is free
  uint32_t pou = 0;
};

// What references check of an area, by instance ID; segment 0: the ID is free.
struct AreaEntry {
  uint32_t segment = 0;  // ir::area_segment
  uint32_t data = 0;
  uint32_t used = 0;        // bytes that variables take
  uint32_t capacity = 0;    // with slack
  uint32_t first_slot = 0;  // in area_slots(): offsets of ID and in-out slots, sorted
  uint32_t slot_count = 0;
  uint32_t type = 0;
  uint32_t first_reach = 0;  // in area_reaches(): of its variables, sorted
  uint32_t reach_count = 0;
};

// An entry of Image::bounds and Image::ranges, without their names.
struct BoundEntry {
  int64_t low = 0;
  uint64_t count = 0;
  uint32_t stride = 0;
};
struct RangeEntry {
  int64_t low = 0;
  int64_t high = 0;
};

// A row of Image::overrides in a table of open addressing.
struct OverrideEntry {
  uint64_t key = ~uint64_t{0};  // type and prototype; all ones: free
  uint32_t target = 0;
};
inline constexpr uint32_t kNoTarget = 0xffffffffu;
struct OverrideTable {
  explicit OverrideTable(const std::vector<ir::LinkedOverride>& all);
  std::vector<OverrideEntry> rows;  // at least one is free
  uint64_t mask = 0;
  uint64_t factor = 0;
  static uint64_t key_of(uint32_t type, uint32_t prototype) {
    return uint64_t{type} << 32 | prototype;
  }
  // Machine code looks there alone and leaves the rest to the interpreter, so most rows are there.
  size_t first_place(uint64_t key) const { return (key * factor >> 32) & mask; }

 private:
  size_t fill(const std::vector<ir::LinkedOverride>& all);
};

// What follows from instances, types and layouts: versions with the same ones share it.
struct DataTables {
  std::vector<InstanceEntry> instances;
  std::vector<AreaEntry> areas;
  std::vector<uint32_t> area_slots;
  std::vector<ir::Reach> area_reaches;
  std::vector<uint32_t> areas_by_data;
  std::vector<uint32_t> stamps;
};

// A cold start's data: `memory` is all zero before.
void write_initial_data(const ir::Image& image, uint8_t* memory);
// The values of all RETAIN ranges, one after the other, in the order and size that the image has.
void write_retained(const ir::Image& image, base::ByteSpan values, uint8_t* memory);

class Generation {
 public:
  // `number` decides the constant pool (even A, odd B). Writes the pool into
  // `memory`, which no running code of the other generation reads.
  static std::unique_ptr<Generation> build(ir::VerifiedImage image, uint32_t number,
                                           uint8_t* memory, const TierOptions& tier = {});
  // Shares `slots` with the generations before it: code that is the same as in `running` (null at
  // first) stays where it is. Of these generations only `running` may run from now on. kTooLarge
  // when there is no room for the code.
  static base::Result<std::unique_ptr<Generation>> build(ir::VerifiedImage image, uint32_t number,
                                                         uint8_t* memory,
                                                         std::shared_ptr<CodeSlots> slots,
                                                         const Generation* running,
                                                         const TierOptions& tier = {});

  const ir::VerifiedImage& verified() const { return image_; }
  const ir::Image& image() const { return image_.image(); }
  uint32_t number() const { return number_; }
  uint32_t pool_offset() const;
  // The constant pool to its place in data memory.
  void write_pool(uint8_t* memory) const;
  // The code of its image as it is: the newest there is. Any thread. It can be held longer than the
  // generation.
  const std::shared_ptr<const CodeTable>& code() const {
    return *code_->newest.load(std::memory_order_acquire);
  }
  const std::shared_ptr<const CodeTable>& first_code() const { return code_->first; }
  const std::vector<PouEntry>& pous() const { return code()->pous; }
  // What makes the machine code that build() left out (Making::kBeside), on any thread, once.
  // Executions go on with the table that they began with. It holds whatever it needs; but no two
  // versions may be built meanwhile on top of another one. `like`: shared where it is the same;
  // its version is the one that this was built on, or one that was built on this.
  std::function<void(native::Progress&)> native_work(const TierOptions& tier,
                                                     std::optional<MadeCode> like) const;
  const std::vector<InstanceEntry>& instances() const { return data_->instances; }
  const std::vector<AreaEntry>& areas() const { return data_->areas; }
  const std::vector<uint32_t>& area_slots() const { return data_->area_slots; }
  const std::vector<ir::Reach>& area_reaches() const { return data_->area_reaches; }
  // IDs of all areas by their place in data memory.
  const std::vector<uint32_t>& areas_by_data() const { return data_->areas_by_data; }
  // Data offset of the stamp of an instance (ir/types/stamps.h), and of the globals' change flag
  // (ID 0); 0: none.
  uint32_t stamp(uint32_t id) const { return data_->stamps[id]; }
  const std::vector<BoundEntry>& bounds() const { return bounds_; }
  const std::vector<RangeEntry>& ranges() const { return ranges_; }
  // POU that stands for the prototype on instances of the type; kNoTarget: none.
  uint32_t target_of(uint32_t type, uint32_t prototype) const {
    const uint64_t key = OverrideTable::key_of(type, prototype);
    for (size_t at = overrides_.first_place(key);; at = (at + 1) & overrides_.mask) {
      if (overrides_.rows[at].key == key) return overrides_.rows[at].target;
      if (overrides_.rows[at].key == ~uint64_t{0}) return kNoTarget;
    }
  }
  const OverrideTable& override_table() const { return overrides_; }
  // Machine code of its POUs; null: everything is interpreted, or not made yet.
  const native::Program* native() const { return code()->native.get(); }
  const ir::Bools& bools() const { return bools_; }
  // Tries that one POU can have open at once, at most.
  uint32_t try_depth() const { return try_depth_; }

 private:
  Generation(ir::VerifiedImage image, const Generation* running)
      : image_(std::move(image)),
        bools_(image_.image(), running == nullptr ? nullptr : &running->bools_),
        overrides_(image_.image().overrides) {}
  base::Status place_code(const Generation* running, const TierOptions& tier, CodeTable& code);
  ir::VerifiedImage image_;
  ir::Bools bools_;
  std::shared_ptr<const DataTables> data_;
  uint32_t number_ = 0;
  std::shared_ptr<CodeSlots> slots_;
  std::shared_ptr<NewestCode> code_ = std::make_shared<NewestCode>();
  std::vector<BoundEntry> bounds_;
  std::vector<RangeEntry> ranges_;
  OverrideTable overrides_;
  uint32_t try_depth_ = 0;
};

}  // namespace vm
