// What a controller starts with: the program that boots, or one that it is given, and its retained
// values, whatever the power cut or the disk has left. A lost trial is over when it returns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/verify.h"
#include "online_change/store/store.h"

namespace online_change {

// An edit that is on trial still (D4).
struct ResumedEdit {
  StoredEdit stored;
  ir::VerifiedImage before;  // that it was made on
};

struct Boot {
  ir::VerifiedImage image;
  base::Bytes retained;                    // for Controller::start()
  std::optional<base::Digest> trial_lost;  // the program that was on trial
  std::vector<std::string> alarms;         // what is damaged or failed
  // Not empty: the accepted program is damaged, or nobody knows which it was. `image` is the
  // likeliest, or ir::no_program() where none is intact; it must not run before somebody says so,
  // and is not stored as what boots.
  std::string fault = {};
  // Not empty: `image` is the newest of these, oldest first, and on trial.
  std::vector<ResumedEdit> edits = {};
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

// `given` replaces what is stored; the retained values follow by path and type. kFileNotFound when
// nothing was ever stored, unless `create` says that a program comes later; kStorageFailed when
// `given` cannot be stored. Notes in the journal what it did, at `time_ns`.
base::Result<Boot> boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                        const std::string& who, int64_t time_ns, bool create = false);

}  // namespace online_change
