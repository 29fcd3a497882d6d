// The check of one POU's code: a single pass that keeps, for every scalar slot of
// the frame, whether it holds a value, and for the next frame, what was put there.
//
// A handler (TRY) is a merge: what held at the TRY holds there too, since slots keep their class
// and get no lesser addr while the try is open. Which tries are open is known at every unit.
//
// At a merge unit the state is what the merge says and nothing else; every jump
// there must bring it. So nothing is iterated: typing is by slot (its class and
// region never change), and of an addr only two facts flow: whether what it points to
// may be written, and whether it points into the next frame (then it is good for the
// call in preparation only, and never survives a merge).
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ir/bytecode/code.h"
#include "ir/bytecode/verify_checks.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {

// What an addr or a string reference in a slot points to, as far as it flows.
struct Pointer {
  Region region;           // of addrs
  bool read_only = false;  // %I, CONSTANT or constant pool
  uint32_t outgoing = 0;   // not 0: into the next frame, entry outgoing - 1 of CodeVerifier::ways
};

// In entries of CodeRoom::frame and CodeRoom::own; 0: no scalar begins there.
constexpr uint32_t number_of(Class cls) { return static_cast<uint32_t>(cls) + 1; }
// Entries of CodeRoom::frame: the slot that covers the offset, and the number of the class.
inline constexpr uint32_t kNoSlot = 0xffffff;
inline constexpr uint32_t kClassShift = 24;
// Entries of CodeRoom::own: the number of the class, and this flag.
inline constexpr uint32_t kReadOnly = 0x80;

// The room that the check of one POU takes, and leaves for the next: most POUs are small, and
// allocating would cost as much as checking. For one thread.
struct CodeRoom {
  // A slot with what is known of the value in it.
  struct SlotState {
    uint32_t written = 0;  // when it is the epoch: the slot holds a value
    uint32_t outgoing = 0;
    bool read_only = false;
  };
  // Something that was put into the next frame, or pointed to there.
  struct Outgoing {
    uint32_t offset = 0;     // in the next frame
    bool aggregate = false;  // `region`, or (capacity not kNone) a string
    Class cls = Class::kB;
    Region region;
    uint32_t capacity = kNone;
    bool read_only = false;
    uint32_t size = 0;
  };
  enum class ResultsOf : uint8_t { kNobody, kFunction, kNative };
  struct Results {
    ResultsOf of = ResultsOf::kNobody;
    uint32_t number = 0;
    friend bool operator==(const Results&, const Results&) = default;
  };
  struct Arrival {  // at merge number i
    bool reached = false;
    uint32_t scope = 0;  // tries that are open there
    bool loop_head = false;
    bool calls_inside = false;  // a loop head whose loop calls something
    size_t slots = 0;           // where its slots begin in `arrives_read_only`
    Results results;
  };
  // Open tries as a tree: an entry is a try inside that of `parent`, with its handler's merge.
  // 0: none is open.
  struct Scope {
    uint32_t parent = 0;
    uint32_t handler = kNone;
    uint32_t depth = 0;
  };

  std::vector<uint32_t> frame;  // by offset, where slots fill the frame; else empty
  std::vector<uint8_t> own;     // by offset in the own instance; empty where that is large
  std::vector<SlotState> slots;
  std::vector<Outgoing> ways;           // targets of pointers into the next frame
  std::vector<Outgoing> pending;        // arguments of the call in preparation
  std::vector<bool> given;              // slots of its callee
  std::vector<Arrival> arrivals;        // by merge
  std::vector<bool> arrives_read_only;  // by merge and its slots
  std::vector<Scope> scopes;
  std::vector<uint32_t> merge_of;  // by unit; kNone
  std::vector<uint32_t> results;   // slots that hold a value at every return
  std::vector<uint32_t> calls;     // units
  std::vector<uint32_t> loops;
};

class CodeVerifier {
 public:
  // Borrows all.
  CodeVerifier(const Context& context, CodeRoom& room, uint32_t pou, std::span<const Unit> code);
  base::Result<CodeFacts> run();

 private:
  using Outgoing = CodeRoom::Outgoing;
  using ResultsOf = CodeRoom::ResultsOf;
  using Results = CodeRoom::Results;
  using Arrival = CodeRoom::Arrival;
  using Scope = CodeRoom::Scope;
  struct Place {  // of a BC32 or P32 field
    Base base = Base::kFrame;
    uint32_t offset = 0;
  };

  // verify_flow.cc
  void list_slots();
  void list_own_scalars();
  void list_parameters();
  bool scan_instructions();
  bool find_loops();
  bool check_merges();
  bool step(uint32_t unit, const OpcodeChecks& checks);
  bool control(uint32_t next);
  bool enter_merge(uint32_t unit);
  bool arrive(uint32_t merge, bool backwards);
  bool jump(uint32_t next, bool backwards);
  bool check_switch(uint32_t next);
  bool check_table(uint32_t unit);
  bool check_return();

  // verify_tries.cc
  bool check_try(uint32_t next);
  bool check_end_try();
  bool outlives_traps(uint32_t slot, const Pointer& pointer);
  uint32_t merge_at(uint32_t unit) const {
    return unit < room_.merge_of.size() ? room_.merge_of[unit] : kNone;
  }
  // Texts are put together here, so that what checks has none of that in it. False.
  [[gnu::cold]] bool fail(Refusal refusal, const std::string& why);
  [[gnu::cold]] bool fail(Refusal refusal, const char* why);
  [[gnu::cold]] bool fail_at(Refusal refusal, const char* what, uint32_t offset,
                             const char* behind = "");
  [[gnu::cold]] bool fail_without_slot(Refusal refusal, Class cls, uint32_t offset);

  // verify_operands.cc
  bool check_unused(const OpcodeChecks& checks);
  bool plain(const OpcodeChecks& checks);
  bool near_operand(const Field& field, Base base, uint32_t offset, bool write) {
    return operand(field.cls, base, offset, write);
  }
  bool operand(Class cls, Base base, uint32_t offset, bool write);
  bool scalar_access(Place place, Class cls, bool write);
  bool frame_scalar(uint32_t offset, Class cls, bool write);
  bool leaf_access(Region region, uint32_t offset, Class cls, bool write, const char* base);
  bool pool_scalar(uint32_t offset, Class cls);
  bool check_access(const ScalarPlace& there, Class cls, bool write);
  uint32_t slot_at(uint32_t offset) const;                 // that covers it; kNone
  uint32_t scalar_slot(uint32_t offset, Class cls) const;  // that starts there; kNone
  bool is_written(uint32_t slot) const { return states_[slot].written == epoch_; }
  void mark_written(uint32_t slot, bool read_only, uint32_t outgoing);
  std::optional<Pointer> read_pointer(uint32_t offset, Class cls);
  bool write_pointer(uint32_t offset, Class cls, const Pointer& pointer);
  std::optional<Pointer> point_to(Place place, Region wanted);
  std::optional<Leaf> string_at(Region region, uint32_t offset, Class cls, uint32_t capacity) const;
  std::optional<Pointer> point_to_string(Place place, Class cls, uint32_t capacity);
  bool pool_region(Region region, uint32_t offset, uint32_t depth);
  bool pool_string(uint32_t offset, Class cls, uint32_t capacity);
  std::optional<Region> root_region(Place& place);

  // verify_memory.cc: the instructions that compute or follow addresses
  bool special(const OpcodeRow& row);
  bool check_lea();
  bool check_index(bool from_place);
  bool check_load(const Field& dest);
  bool check_store(const Field& source);
  bool check_copy();
  bool check_handle();
  bool check_resolve();
  bool next_has_no_handle();
  bool check_string(bool from_place, Class cls);
  bool check_string_copy(Class cls);
  bool check_reference_load(bool from_place);
  bool check_reference_store();
  TypeId instance_slot(bool from_place);
  bool use(const Pointer& pointer, bool write);

  // verify_next_frame.cc: arguments and results
  bool next_scalar(uint32_t offset, Class cls, bool write);
  bool put_pointer(uint32_t offset, Class cls, const Pointer& pointer);
  bool put(Outgoing out);
  bool overlaps_pending(uint64_t begin, uint64_t end) const;
  const FrameSlot* callee_slot(const LinkedPou& callee, uint32_t offset) const;
  bool is_result(const Outgoing& wanted) const;
  bool fits(const Outgoing& out, const FrameSlot& slot) const;
  bool check_frame();
  bool pass_arguments(uint32_t pou);
  bool check_call();
  bool check_native();
  bool check_call_instance(bool from_place);
  bool check_call_reference();
  bool check_instance_frame();
  bool add_instance_call(TypeId type);
  bool end_of_arguments(const char* where);

  // Constants that the answer relies on (proof.h).
  void uses_pool(uint32_t offset, uint64_t size);
  void join_constants();
  bool check_bounds(uint32_t number);

  // verify_methods.cc
  bool is_method(uint32_t pou) const;
  bool runs_on(uint32_t pou, TypeId type) const;
  bool check_call_own();
  bool check_call_method(bool from_place);
  bool check_call_method_reference();
  bool check_call_virtual();
  bool check_is_type();

  const Context& context_;
  const Image& image_;
  const LinkedPou& pou_;
  const std::vector<FrameSlot>& slots_;  // its
  const uint32_t globals_begin_;
  const std::array<OpcodeChecks, kOpcodeCount>& checks_ = opcode_checks();
  std::span<const Unit> code_;
  CodeRoom& room_;
  std::span<const uint32_t> frame_;  // of the room
  std::span<const uint8_t> own_;
  CodeFacts facts_;
  std::optional<base::Error> error_;

  uint32_t unit_ = 0;  // of the current instruction
  Unit u_;
  Unit extension_;
  bool falls_through_ = true;
  uint32_t table_end_ = 0;  // of the last SWITCH: the unit after its table
  size_t next_merge_ = 0;
  uint32_t next_merge_unit_ = kNone;

  uint32_t epoch_ = 1;
  std::span<CodeRoom::SlotState> states_;  // by slot
  std::vector<Outgoing>& ways_;
  std::vector<Outgoing>& pending_;
  uint64_t pending_begin_ = ~uint64_t{0};
  uint64_t pending_end_ = 0;
  Results results_;
  std::vector<Arrival>& arrivals_;
  std::vector<bool>& arrives_read_only_;
  std::vector<Scope>& scopes_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> scope_numbers_;  // by parent and handler
  uint32_t scope_ = 0;
};

// As scalar_access(), which has the last word: what most operands are is found in a table.
inline bool CodeVerifier::operand(Class cls, Base base, uint32_t offset, bool write) {
  if (base == Base::kFrame && offset < frame_.size()) {
    const uint32_t entry = frame_[offset];
    if (entry >> kClassShift == number_of(cls)) {
      CodeRoom::SlotState& state = states_[entry & kNoSlot];
      if (write) state = {epoch_, 0, false};
      if (state.written == epoch_) return true;
    }
  } else if (base == Base::kSelf && offset < own_.size()) {
    const uint32_t entry = own_[offset];
    if (entry == number_of(cls) || (!write && entry == number_of(cls) + kReadOnly)) return true;
  }
  return scalar_access({base, offset}, cls, write);
}

}  // namespace ir::verification
