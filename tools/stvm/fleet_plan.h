// The plan of a roll-out, as it stands in a file beside the fleet file ("x.fleet.plan"): what is
// rolled out to whom, and how far it is (X6-02). Each decision is written there, durably, before it
// is carried out, so that a tool that ended at any instant is followed by `stvm fleet resume`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/hash.h"
#include "tools/common/json.h"
#include "tools/stvm/fleet_waves.h"

namespace stvm {

// Of a controller.
enum class RollState : uint8_t {
  kWaiting,
  kStarting,  // decided: the edit is brought
  kOnTrial,
  kAccepting,  // decided: it is made final
  kAccepted,
  kHadIt,
  kRefused,  // it did not take the edit
  kFailed,   // it took the edit back by itself
  kLost,     // it does not answer
  kUndoing,  // decided: the edit is taken back
  kUndone,
  kStays,    // the edit could not be taken back
  kSkipped,  // the roll-out ended before its turn
};
std::string_view roll_state_name(RollState state);

// Of the whole.
enum class RollPhase : uint8_t { kRunning, kUndoing, kDone, kFailed, kAborting, kAborted };
std::string_view roll_phase_name(RollPhase phase);
bool is_over(RollPhase phase);

struct RollMember {
  FleetMember member;
  RollState state = RollState::kWaiting;
  int64_t since_ms = 0;  // since 1970
  bool was_accepted = false;
  int64_t silent_ms = 0;  // since when it does not answer; 0: it does
  std::string edit;       // on trial
  std::string text;       // why it is so
  base::Digest from{};    // what ran before
  base::Digest to{};      // and with the edit
};

struct RollPlan {
  std::string id;    // eight hexadecimal digits
  std::string who;   // began it
  std::string file;  // the fleet file
  base::Digest digest{};
  std::string list;  // text of fleet.toml, as it was
  // Options of the command line that began it.
  uint32_t stage_flags = 0;
  uint32_t switch_flags = 0;
  bool matching = false;
  bool confirm_each = false;
  RollPhase phase = RollPhase::kRunning;
  size_t wave = 0;                  // the one that is at work; from 0
  int64_t soak_from_ms = 0;         // of that wave; 0: not all of it has the edit
  std::string why;                  // it failed
  std::vector<RollMember> members;  // in the order of the list
  // Not stored: they follow from the list.
  RollSettings settings;

  // The wave of a controller.
  size_t wave_of(size_t member) const;
};

std::string plan_text(const RollPlan& plan);
base::Result<RollPlan> parse_plan(const std::string& path, const std::string& text);
base::Result<RollPlan> read_plan(const std::string& path);
// Durable when it returns.
base::Status write_plan(const std::string& path, const RollPlan& plan);
// From fleet.toml; the fleet file and the options are the caller's.
base::Result<RollPlan> new_plan(const std::string& list_file);

// What is shown of it: waves, controllers, state and since when, the next event (X6-09).
std::string plan_page(const RollPlan& plan, int64_t now_ms);
std::string plan_json(const RollPlan& plan, int64_t now_ms);
// What is shown before anything is done (X6-02).
std::string plan_outline(const RollPlan& plan);
// 0: all have it; 1: some do not; 7: it failed or was aborted.
int plan_exit_code(const RollPlan& plan);

}  // namespace stvm
