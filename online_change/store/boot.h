// What a controller starts with: the program that boots, or one that it is given, and its retained
// values, whatever the power cut or the disk has left. A lost trial is over when its steps are
// carried out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/verify.h"
#include "online_change/store/resumed_edits.h"
#include "online_change/store/store.h"

namespace online_change {

struct BootStep {
  enum class Kind : uint8_t {
    kNote,       // `row`
    kAlarms,     // all alarms so far, as rows like it
    kSettle,     // the trial is over
    kMakeWhole,  // copies that are missing
    kInstall,    // the image boots from now on
  };
  Kind kind = Kind::kNote;
  JournalEntry row = {};
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
  // What has to be stored before it runs, and rows of the journal, in order.
  std::vector<BootStep> steps = {};
  // For kInstall: the program that was stored, and its retained values. No digest: there was none.
  std::optional<base::Digest> before = {};
  base::Bytes values_before = {};
};

// `given` replaces what is stored; the retained values follow by path and type. kFileNotFound when
// nothing was ever stored, unless `create` says that a program comes later. Stores nothing: a start
// that is refused for another reason leaves the store as it was.
base::Result<Boot> choose_boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                               const std::string& who, int64_t time_ns, bool create = false);
// Its steps. kStorageFailed when what was given cannot be stored; what else fails is an alarm.
// Notes in the journal what it did, at the time of the choice.
base::Status carry_out(Store& store, Boot& boot);
// Both.
base::Result<Boot> boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                        const std::string& who, int64_t time_ns, bool create = false);

}  // namespace online_change
