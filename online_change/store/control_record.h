// What boots, and what is on trial: the one record by which a controller's program changes.
#pragma once

#include <optional>

#include "base/bytes.h"
#include "base/hash.h"

namespace online_change {

inline constexpr uint8_t kImageSlots = 3;

struct ControlRecord {
  base::Digest boots{};  // the accepted program
  uint8_t slot = 0;      // that holds it; the other one holds what is on trial
  bool trial = false;
  uint8_t tries_left = 0;  // of the trial; a boot during it takes one, and none is left
  base::Digest trial_digest{};
  uint8_t trial_slot = 1;  // that holds what is on trial
  bool resumes = false;    // that boots, and stays on trial (D4)

  bool is_trial(const base::Digest& digest) const { return trial && trial_digest == digest; }
};

// Encoded, with everything that one can say.
inline constexpr uint64_t kMostControlBytes = 2 * sizeof(base::Digest) + 5;

base::Bytes encode(const ControlRecord& record);
std::optional<ControlRecord> decode_control(base::ByteSpan payload);

}  // namespace online_change
