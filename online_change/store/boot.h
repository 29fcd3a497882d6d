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

// `given` replaces what is stored; the retained values follow by path and type. kFileNotFound when
// nothing was ever stored, unless `create` says that a program comes later; kStorageFailed when
// `given` cannot be stored. Notes in the journal what it did, at `time_ns`.
base::Result<Boot> boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                        const std::string& who, int64_t time_ns, bool create = false);

}  // namespace online_change
