// The table of units and the edits on trial on the wire: pages of rows (D8, D3).
#pragma once

#include <string>
#include <vector>

#include "base/hash.h"
#include "base/result.h"
#include "online_change/diff/fates.h"
#include "online_change/plan/pou_edits.h"
#include "online_change/plan/type_edits.h"

namespace stvm {

// What lies in the slot of a unit that does not run.
enum class OtherSlot : uint8_t {
  kEmpty,
  kBefore,  // what ran before the last switch of this unit
  kUndone,  // what ran until it was undone
  kStaged,  // what a change that is being prepared would run
  kLeft,    // it was staged once, and never ran
};
const char* other_slot_name(OtherSlot what);

struct UnitRow {
  std::string name;
  uint64_t instances = 0;  // of a function block or program
  uint8_t slot = 0;        // 0: A, 1: B
  base::Digest unit{};     // identity of what runs (E1)
  OtherSlot other = OtherSlot::kEmpty;
  base::Digest other_unit{};     // its first bytes, zeros after them
  base::Digest other_version{};  // of the image that it was written for; likewise
  // The cycle since which it runs in this slot; `event`: "started", "switched", "undone".
  uint64_t cycle = 0;
  int64_t time_ns = 0;
  std::string who;
  std::string event;
};

struct UnitPage {
  uint64_t next = 0;  // POU with which the next page begins; 0: this was the last
  std::vector<UnitRow> rows;
};

// One edit on trial, or one that was undone and can be brought again.
struct TrialEdit {
  std::string name;  // "E1"
  bool undone = false;
  base::Digest from{};
  base::Digest to{};
  uint64_t cycle = 0;  // the first one of the edited program
  int64_t time_ns = 0;
  std::string who;
  // The first of each, and how many there are.
  std::vector<online_change::PouEdit> pous;
  uint64_t pou_count = 0;
  std::vector<online_change::TypeEdit> types;
  uint64_t type_count = 0;
  std::vector<online_change::FateRow> variables;
  uint64_t variable_count = 0;
};

struct EditPage {
  uint64_t next = 0;  // likewise, of edits
  std::vector<TrialEdit> edits;
};

base::Bytes encode(const UnitPage& page);
base::Bytes encode(const EditPage& page);
base::Result<UnitPage> decode_unit_page(base::ByteSpan body);
base::Result<EditPage> decode_edit_page(base::ByteSpan body);

}  // namespace stvm
