#include "tools/stvm/undo_only.h"

#include <algorithm>
#include <optional>

#include "ir/bytecode/image.h"
#include "ir/bytecode/renames.h"
#include "online_change/package/fleet_file.h"
#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/package_making.h"

namespace stvm {
namespace {

// What the edit had renamed by a rule has a rule to go back by, so that it keeps its value. Image
// and rules are those of the edit, what it was made on has none of them.
base::Result<base::Bytes> with_rules_back(base::Bytes before, const base::Bytes& after) {
  base::Result<ir::Image> image = ir::decode(before);
  if (!image.ok()) return image.error();
  base::Result<ir::Image> edited = ir::decode(after);
  if (!edited.ok()) return edited.error();
  const std::optional<ir::Image> renamed = ir::under_new_names(*image, *edited);
  if (!renamed) return before;
  ir::TypeTable& types = image->types.own();
  const auto go_back = [&](ir::OldNameId& rule, ir::OldNameId known, const std::string& name) {
    if (known.valid()) rule = types.add_old_name(name);
  };
  for (uint32_t i = 0; i < types.size(); ++i) {
    const ir::Type& there = renamed->types[ir::TypeId(i)];
    ir::Type& type = types.edit(ir::TypeId(i));
    go_back(type.old_name, there.old_name, there.name);
    for (size_t k = 0; k < type.members.size(); ++k) {
      go_back(type.members[k].old_name, there.members[k].old_name, there.members[k].name);
    }
    for (size_t k = 0; k < type.literals.size(); ++k) {
      go_back(type.literals[k].old_name, there.literals[k].old_name, there.literals[k].name);
    }
  }
  for (const uint32_t id : image->program_ids()) {
    const ir::Instance& there = renamed->instances[id];
    go_back(image->instances[id].old_name, there.old_name, there.name);
  }
  return ir::encode(*image);
}

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
  base::Result<base::Bytes> edited = with_rules_back(std::move(*before), *after);
  if (!edited.ok()) return edited;
  back.original = std::move(*after);
  back.edited = std::move(*edited);
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
    return base::Error{why.refusal, "later edits depend on " + edit + ": " + why.text};
  }
  SwitchOptions noted = how;
  noted.note = take_out_note(edit);
  noted.taken_out = edit;
  return bring(noted, client, *package);
}

}  // namespace stvm
