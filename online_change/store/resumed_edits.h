// Edits on trial that are stored, and the versions that they lead through (D4): of a trial that
// goes on, of one that is lost, and of a recording that begins with one.
#pragma once

#include <optional>
#include <vector>

#include "ir/bytecode/verify.h"
#include "online_change/store/edits_record.h"

namespace online_change {

// An edit that is on trial still (D4).
struct ResumedEdit {
  StoredEdit stored;
  ir::VerifiedImage before;  // that it was made on
};

// The versions that these edits make, one behind the other, from what the first one was made on;
// `last` is what the last one has made. Nullopt: one of them is not what it should be.
std::optional<std::vector<ResumedEdit>> follow_edits(const std::vector<StoredEdit>& edits,
                                                     const ir::VerifiedImage& first,
                                                     ir::VerifiedImage& last);
// As a recording that begins with a trial has them: the image that the first one was made on, and
// the edits. Empty: there is none.
base::Bytes encode_trial(const std::vector<ResumedEdit>& edits);
// Nullopt: damaged. They lead to `last`.
std::optional<std::vector<ResumedEdit>> decode_trial(base::ByteSpan bytes,
                                                     const base::Digest& last);

}  // namespace online_change
