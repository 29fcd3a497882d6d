#include "tools/stvm/undo_only.h"

#include <algorithm>

#include "online_change/package/fleet_file.h"
#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/package_making.h"

namespace stvm {
namespace {

// The way back of the edit, as an edit by itself: from what it made to what it was made on.
base::Result<base::Bytes> package_of(ControllerClient& client, const std::string& edit,
                                     const std::string& next) {
  online_change::FleetFile back;
  base::Result<base::Bytes> before = client.image_before(edit);
  if (!before.ok()) return before;
  base::Result<base::Bytes> after = client.image_before(next);
  if (!after.ok()) return after;
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return running;
  back.original = std::move(*after);
  back.edited = std::move(*before);
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("back.fleet");
  base::Status written = tools::write_file(file, online_change::encode(back));
  if (!written.ok()) return written.error();
  return make_package({{file}, {}}, {}, *running);
}

}  // namespace

std::string take_out_note(const std::string& edit) { return edit + " alone is taken back"; }

base::Result<Outcome> take_out(const SwitchOptions& how, ControllerClient& client,
                               const std::string& edit, const std::vector<std::string>& on_trial) {
  const auto found = std::find(on_trial.begin(), on_trial.end(), edit);
  if (found == on_trial.end()) {
    return base::Error{base::Refusal::kNothingToUndo,
                       "no edit `" + edit + "` is on trial; `stvm edits` shows them"};
  }
  if (found == on_trial.begin()) {
    return base::Error{base::Refusal::kUsage,
                       "`" + edit + "` is the newest edit: undo it without --only"};
  }
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  base::Result<base::Bytes> package = package_of(client, edit, *(found - 1));
  if (!package.ok()) {
    const base::Error& why = package.error();
    const bool depends =
        why.refusal == base::Refusal::kOtherPart || why.refusal == base::Refusal::kCannotRelink;
    if (!depends) return why;
    return base::Error{why.refusal, "later edits depend on " + edit + ": " + why.text +
                                        "; without --only they go, too"};
  }
  SwitchOptions noted = how;
  noted.note = take_out_note(edit);
  noted.taken_out = edit;
  return bring(noted, client, *package);
}

}  // namespace stvm
