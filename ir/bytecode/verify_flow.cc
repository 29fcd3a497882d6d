#include <algorithm>

#include "ir/bytecode/verify_code.h"

namespace ir::verification {
namespace {

constexpr size_t kBytesOfSlot = 64;
constexpr uint32_t kMostOwnBytes = 2048;

}  // namespace

CodeVerifier::CodeVerifier(const Context& context, CodeRoom& room, uint32_t pou,
                           std::span<const Unit> code)
    : context_(context),
      image_(context.image),
      pou_(image_.pous[pou]),
      slots_(pou_.slots),
      globals_begin_(image_.instances[0].data),
      code_(code),
      room_(room),
      ways_(room.ways),
      pending_(room.pending),
      arrivals_(room.arrivals),
      arrives_read_only_(room.arrives_read_only),
      scopes_(room.scopes) {
  room.slots.assign(slots_.size(), {});
  states_ = room.slots;
  ways_.clear();
  pending_.clear();
  arrivals_.assign(pou_.merges.size(), {});
  scopes_.assign(1, Scope{});
  list_slots();
  list_own_scalars();
  if (!pou_.merges.empty()) next_merge_unit_ = pou_.merges[0].unit;
}

// Not of frames that are large without reason: the cost stays linear in the image.
void CodeVerifier::list_slots() {
  std::vector<uint32_t>& frame = room_.frame;
  frame.clear();
  if (pou_.frame_size > kBytesOfSlot * slots_.size() || slots_.size() >= kNoSlot) return;
  frame.resize(pou_.frame_size, kNoSlot);
  for (uint32_t i = 0; i < slots_.size(); ++i) {
    const uint32_t end = i + 1 == slots_.size() ? pou_.frame_size : slots_[i + 1].offset;
    for (uint32_t at = slots_[i].offset; at < end; ++at) frame[at] = i;
    if (!slots_[i].aggregate && slots_[i].offset < end) {
      frame[slots_[i].offset] |= number_of(slots_[i].cls) << kClassShift;
    }
  }
  frame_ = frame;
}

void CodeVerifier::list_own_scalars() {
  std::vector<uint8_t>& own = room_.own;
  own.clear();
  if (!pou_.self.valid()) return;
  const std::span<const ScalarPlace> scalars = context_.regions.scalars(pou_.self);
  if (scalars.empty() || scalars.back().offset >= kMostOwnBytes) return;
  own.resize(scalars.back().offset + 1);
  for (const ScalarPlace& scalar : scalars) {
    const bool read_only = scalar.flags.input || scalar.flags.constant;
    own[scalar.offset] = static_cast<uint8_t>(number_of(scalar.cls) + (read_only ? kReadOnly : 0));
  }
  own_ = own;
}

bool CodeVerifier::fail(Refusal refusal, const std::string& why) {
  std::string where = "POU `" + pou_.name + "`, unit " + std::to_string(unit_);
  if (u_.opcode_number() < kOpcodeCount) where += " " + std::string(opcode_row(u_.opcode()).name);
  error_ = refuse(refusal, where + ": " + why);
  return false;
}

bool CodeVerifier::fail(Refusal refusal, const char* why) {
  return fail(refusal, std::string(why));
}

bool CodeVerifier::fail_at(Refusal refusal, const char* what, uint32_t offset, const char* behind) {
  return fail(refusal, std::string(what) + " at offset " + std::to_string(offset) + behind);
}

bool CodeVerifier::fail_without_slot(Refusal refusal, Class cls, uint32_t offset) {
  const std::string what = "the frame has no slot of class " + std::string(class_name(cls));
  return fail_at(refusal, what.c_str(), offset);
}

base::Result<CodeFacts> CodeVerifier::run() {
  if (!scan_instructions()) return *error_;
  list_parameters();
  for (uint32_t unit = 0; unit < code_.size();) {
    unit_ = unit;
    const OpcodeChecks& checks = checks_[code_[unit].opcode_number()];
    if (!step(unit, checks)) return *error_;
    unit += checks.extended ? 2 : 1;
  }
  if (falls_through_) {
    fail(Refusal::kNoReturn, "the code ends without a return");
    return *error_;
  }
  if (next_merge_ != pou_.merges.size()) {
    fail(Refusal::kBadJump,
         "merge at unit " + std::to_string(pou_.merges[next_merge_].unit) + " is no instruction");
    return *error_;
  }
  join_constants();
  return std::move(facts_);
}

// What a caller gives is there from the beginning; what he gets must be there at the end.
void CodeVerifier::list_parameters() {
  room_.results.clear();
  for (uint32_t i = 0; i < slots_.size(); ++i) {
    const FrameSlot& slot = slots_[i];
    if (slot.kind != SlotKind::kParam || slot.aggregate) continue;
    switch (slot.local) {
      case LocalKind::kInput:
      case LocalKind::kInOut:
        mark_written(i, false, 0);
        break;
      case LocalKind::kOutput:
      case LocalKind::kReturn:
        room_.results.push_back(i);
        break;
      default:
        break;
    }
  }
}

// Opcodes, extensions and the merge table; where the loops are.
bool CodeVerifier::scan_instructions() {
  std::vector<uint32_t>& calls = room_.calls;
  std::vector<uint32_t>& loops = room_.loops;
  calls.clear();
  loops.clear();
  for (uint32_t unit = 0; unit < code_.size(); ++unit) {
    const Unit u = code_[unit];
    unit_ = unit;
    if (u.opcode_number() >= kOpcodeCount) {
      u_ = u;
      return fail(Refusal::kBadOpcode, "opcode " + std::to_string(u.opcode_number()));
    }
    const Opcode op = u.opcode();
    const OpcodeChecks& checks = checks_[u.opcode_number()];
    if (checks.calls) calls.push_back(unit);
    // Where a handler begins, no results are left, as after a call.
    if (op == Opcode::TRY) calls.push_back(unit + 1 + u.bc());
    if (op == Opcode::LOOP) loops.push_back(unit);
    u_ = u;
    if (checks.extended && ++unit == code_.size()) {
      unit_ = unit;
      return fail(Refusal::kBadOpcode, "its second unit is missing");
    }
  }
  return check_merges() && find_loops();
}

bool CodeVerifier::check_merges() {
  std::vector<uint32_t>& merge_of = room_.merge_of;
  merge_of.assign(code_.size(), kNone);
  size_t slots = 0;
  for (size_t i = 0; i < pou_.merges.size(); ++i) {
    const Merge& merge = pou_.merges[i];
    unit_ = merge.unit;
    if (i != 0 && pou_.merges[i - 1].unit >= merge.unit) {
      return fail(Refusal::kBadTyping, "merges are out of order");
    }
    for (size_t s = 0; s < merge.slots.size(); ++s) {
      const bool good = merge.slots[s] < pou_.slots.size() && !slots_[merge.slots[s]].aggregate &&
                        (s == 0 || merge.slots[s - 1] < merge.slots[s]);
      if (!good) return fail(Refusal::kBadTyping, "merge names a slot that it cannot");
    }
    if (merge.unit < merge_of.size()) merge_of[merge.unit] = static_cast<uint32_t>(i);
    arrivals_[i].slots = slots;
    slots += merge.slots.size();
  }
  arrives_read_only_.assign(slots, false);
  return true;
}

bool CodeVerifier::find_loops() {
  std::vector<uint32_t>& calls = room_.calls;
  if (!room_.loops.empty()) std::sort(calls.begin(), calls.end());
  for (const uint32_t loop : room_.loops) {
    unit_ = loop;
    u_ = code_[unit_];
    const uint32_t head = merge_at(unit_ + 1 + u_.bc());
    if (head == kNone || pou_.merges[head].unit > unit_) {
      return fail(Refusal::kBadJump, "jumps to unit " + std::to_string(unit_ + 1 + u_.bc()));
    }
    const auto inside = std::lower_bound(calls.begin(), calls.end(), pou_.merges[head].unit);
    arrivals_[head].loop_head = true;
    arrivals_[head].calls_inside |= inside != calls.end() && *inside <= unit_;
  }
  return true;
}

// Fields that an instruction does not use are zero, and no operand has a base that
// the interpreter lacks (V3).
inline bool CodeVerifier::check_unused(const OpcodeChecks& checks) {
  const uint32_t bases = u_.op >> 10;
  if ((checks.bases >> bases & 1) == 0) {
    return fail(Refusal::kBadOpcode, "an operand has a base that it cannot have");
  }
  const uint64_t bits = (bits_of(u_) & checks.first) | (bits_of(extension_) & checks.second);
  return bits == 0 || fail(Refusal::kBadOpcode, "a field that it does not use is not zero");
}

bool CodeVerifier::step(uint32_t unit, const OpcodeChecks& checks) {
  u_ = code_[unit];
  if (unit <= table_end_ && !check_table(unit)) return false;
  if (unit >= next_merge_unit_ && !enter_merge(unit)) return false;
  if (!falls_through_) return fail(Refusal::kUnreachable, "nothing leads here");
  extension_ = checks.extended ? code_[unit + 1] : Unit{};
  if (!check_unused(checks)) return false;
  falls_through_ = !checks.ends;
  if (checks.plain) return plain(checks);
  return control(unit + (checks.extended ? 2 : 1));
}

// Or what is none, then special().
bool CodeVerifier::control(uint32_t next) {
  switch (u_.opcode()) {
    case Opcode::JMP:
      return jump(next, false);
    case Opcode::LOOP:
      return jump(next, true);
    case Opcode::JT:
    case Opcode::JF:
      return operand(Class::kB, u_.base_a(), u_.a, false) && jump(next, false);
    case Opcode::SWITCH_8:
    case Opcode::SWITCH_16:
    case Opcode::SWITCH_32:
    case Opcode::SWITCH_64:
      return check_switch(next);
    case Opcode::TRY:
      return check_try(next);
    case Opcode::END_TRY:
      return check_end_try();
    case Opcode::RET:
      return check_return();
    default:
      return special(opcode_row(u_.opcode()));
  }
}

// At a merge the state is exactly the merge's, whichever way was taken.
bool CodeVerifier::enter_merge(uint32_t unit) {
  const Merge& merge = pou_.merges[next_merge_];
  if (merge.unit < unit) {
    return fail(Refusal::kBadJump,
                "merge at unit " + std::to_string(merge.unit) + " is no instruction");
  }
  const uint32_t number = static_cast<uint32_t>(next_merge_++);
  next_merge_unit_ = next_merge_ == pou_.merges.size() ? kNone : pou_.merges[next_merge_].unit;
  if (falls_through_ && !arrive(number, false)) return false;
  const Arrival& arrival = arrivals_[number];
  if (!arrival.reached) return fail(Refusal::kUnreachable, "nothing leads here");
  ++epoch_;
  for (size_t i = 0; i < merge.slots.size(); ++i) {
    mark_written(merge.slots[i], arrives_read_only_[arrival.slots + i], 0);
  }
  // What a loop calls may not leave results that its start expects.
  results_ = arrival.loop_head && arrival.calls_inside ? Results{} : arrival.results;
  arrivals_[number].results = results_;
  scope_ = arrival.scope;
  falls_through_ = true;
  return true;
}

// The state here must bring what the merge promises.
bool CodeVerifier::arrive(uint32_t number, bool backwards) {
  const Merge& merge = pou_.merges[number];
  Arrival& arrival = arrivals_[number];
  if (!end_of_arguments("a jump target")) return false;
  if (!arrival.reached && !backwards) arrival.scope = scope_;
  if (arrival.scope != scope_) {
    return fail(Refusal::kBadJump,
                "other tries are open at the merge at unit " + std::to_string(merge.unit));
  }
  for (size_t i = 0; i < merge.slots.size(); ++i) {
    const uint16_t slot = merge.slots[i];
    const auto name = [&] { return "slot at " + std::to_string(slots_[slot].offset); };
    const CodeRoom::SlotState& state = states_[slot];
    if (state.written != epoch_ || state.outgoing != 0) {
      return fail(Refusal::kBadTyping,
                  name() + " holds no value for the merge at unit " + std::to_string(merge.unit));
    }
    if (backwards && state.read_only && !arrives_read_only_[arrival.slots + i]) {
      return fail(Refusal::kBadTyping, name() + " is read-only in a later turn of the loop");
    }
    if (!backwards && state.read_only) arrives_read_only_[arrival.slots + i] = true;
  }
  if (backwards) {
    if (arrival.results.of != ResultsOf::kNobody && arrival.results != results_) {
      return fail(Refusal::kBadCall, "results differ in a later turn of the loop");
    }
    return true;
  }
  if (!arrival.reached) arrival.results = results_;
  if (arrival.results != results_) arrival.results = Results{};
  arrival.reached = true;
  return true;
}

bool CodeVerifier::jump(uint32_t next, bool backwards) {
  const int64_t target = int64_t{next} + static_cast<int32_t>(u_.bc());
  if (!backwards && target < next) {
    return fail(Refusal::kNoFuel,
                "jumps back to unit " + std::to_string(target) + " without taking fuel");
  }
  const uint32_t merge = target >= 0 && target < int64_t{pou_.unit_count}
                             ? merge_at(static_cast<uint32_t>(target))
                             : kNone;
  if (merge == kNone || (backwards && pou_.merges[merge].unit > unit_)) {
    return fail(Refusal::kBadJump, "jumps to unit " + std::to_string(target));
  }
  return arrive(merge, backwards);
}

bool CodeVerifier::check_switch(uint32_t next) {
  const OpcodeRow& row = opcode_row(u_.opcode());
  if (!near_operand(row.b, u_.base_b(), u_.b, false)) return false;
  const uint32_t entries = extension_.y();
  const uint32_t bits = 8 * class_size(row.b.cls);
  if (entries == 0 || (bits < 32 && entries > 1u << bits)) {
    return fail(Refusal::kBadJump, "has a table of " + std::to_string(entries) + " jumps");
  }
  if (entries >= code_.size() - next) {
    return fail(Refusal::kBadJump, "nothing stands after its table");
  }
  table_end_ = next + entries;
  return true;
}

// Units up to the one after a table: what held at the SWITCH holds there.
bool CodeVerifier::check_table(uint32_t unit) {
  falls_through_ = true;
  if (unit == table_end_) return true;
  if (u_.opcode() != Opcode::JMP) return fail(Refusal::kBadJump, "is in a table, and no JMP");
  if (merge_at(unit) != kNone) return fail(Refusal::kBadJump, "a jump leads into a table");
  return true;
}

bool CodeVerifier::check_return() {
  if (!end_of_arguments("the return")) return false;
  if (scope_ != 0) return fail(Refusal::kBadJump, "returns while a try is open");
  for (const uint32_t slot : room_.results) {
    if (is_written(slot)) continue;
    return fail(Refusal::kBadCall, "result `" + slots_[slot].name + "` has not been written");
  }
  return true;
}

base::Result<CodeFacts> verify_code(const Context& context, CodeRoom& room, uint32_t pou) {
  const LinkedPou& row = context.image.pous[pou];
  const auto code = std::span(context.image.code).subspan(row.first_unit, row.unit_count);
  return CodeVerifier(context, room, pou, code).run();
}

base::Result<CodeFacts> verify_code(const Context& context, uint32_t pou) {
  CodeRoom room;
  return verify_code(context, room, pou);
}

base::Result<CodeFacts> verify_code(const Context& context, uint32_t pou,
                                    std::span<const Unit> code) {
  CodeRoom room;
  return CodeVerifier(context, room, pou, code).run();
}

}  // namespace ir::verification
