// A running controller as the commands see it. Believes nothing that it is sent: every answer is
// decoded by the bounded reader.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "online_change/store/journal.h"
#include "tools/common/options.h"
#include "tools/stvm/fate_message.h"
#include "tools/stvm/unit_message.h"
#include "vm/runtime/ports.h"
#include "vm/runtime/protocol.h"
#include "vm/runtime/socket_client.h"

namespace stvm {

class ControllerClient {
 public:
  // The one that --dir or --host names.
  static base::Result<ControllerClient> connect(const tools::Options& options);
  // A state directory where there is one, else a host. Waits for each answer so long.
  static base::Result<ControllerClient> connect_to(
      const std::string& place, uint32_t patience_s = vm::SocketClient::kPatienceSeconds);
  // Of this machine; of another one, where an empty directory is the one that it takes by itself.
  static base::Result<ControllerClient> connect_here(const std::string& directory,
                                                     uint32_t patience_s);
  static base::Result<ControllerClient> connect_there(const std::string& host,
                                                      const std::string& directory,
                                                      uint32_t patience_s);
  explicit ControllerClient(std::unique_ptr<vm::Transport> transport)
      : transport_(std::move(transport)) {}

  // Requests that change state name the version that the last status() or image() saw.
  base::Result<base::Bytes> call(vm::Request request);
  base::Result<vm::StatusReport> status();
  // Asks for the status, and requests go on to name the version that was seen before: what others
  // do meanwhile refuses them.
  base::Result<vm::StatusReport> look();
  base::Result<vm::TaskTimes> task_times(const std::string& task);
  base::Result<vm::Values> get(std::vector<std::string> names);
  base::Result<vm::Values> list(const std::string& pattern);
  base::Result<vm::ForceRows> forces();
  base::Result<vm::ForceRows> force(const std::vector<std::string>& names,
                                    const std::vector<std::string>& values);
  base::Status assign(vm::Command command, const std::vector<std::string>& names,
                      const std::vector<std::string>& values);
  base::Result<base::Bytes> image();
  // The image that ran before the last accept.
  base::Result<base::Bytes> image_before();
  // The image that the edit on trial of that name was made on.
  base::Result<base::Bytes> image_before(const std::string& edit);
  base::Result<std::vector<online_change::JournalEntry>> journal();
  // From number `first` on, as far as the controller has them; their `sequence` is that number.
  base::Result<std::vector<online_change::JournalEntry>> events(uint64_t first);
  base::Result<std::vector<UnitRow>> units();
  // What it is and can do, by name; none of one that is too old to say.
  base::Result<std::map<std::string, std::string>> facts();
  // On trial, oldest first.
  base::Result<std::vector<TrialEdit>> edits();

  // `unless`: a BOOL; while it is TRUE nothing is switched (C9). `note`: for the journal.
  // `taken_out`: the edit on trial whose work the change takes back.
  base::Status stage(base::ByteSpan package, uint32_t flags, const std::string& unless = {},
                     const std::string& note = {}, const std::string& taken_out = {});
  // The edit that was undone last, which has that name.
  base::Status stage_again(const std::string& edit);
  // `way_back`: vm::kWithoutExit; else "". `edit`: on trial, whose undo it is about, behind that of
  // all above it; "": of the newest one, or of what is staged.
  base::Result<FatePage> fates(const std::string& way_back = {}, const std::string& edit = {});
  // One line for each variable.
  base::Result<std::vector<FateLine>> every_fate();
  // Switches to what was staged here, or of nothing (E-14). `health`: a BOOL that must stay TRUE in
  // the first cycles (X7); "": none.
  base::Result<online_change::SwitchReport> make_switch(uint32_t flags,
                                                        const std::string& health = {});
  // Undoes the newest edit on trial, which has that name; "": whatever it is. `ways`:
  // vm::kWithoutExit, vm::kWithLoss.
  base::Result<online_change::SwitchReport> undo(const std::string& edit = {},
                                                 const std::vector<std::string>& ways = {});

 private:
  base::Result<base::Bytes> image_parts(vm::Request request, const base::Digest* expected);
  // Entries of a page, added to `all`. False: there were none.
  base::Result<bool> journal_page(const vm::Request& request,
                                  std::vector<online_change::JournalEntry>& all);
  base::Status learn_edition(const base::Result<base::Bytes>& staged);
  base::Result<FatePage> fate_pages(std::vector<std::string> names);
  base::Result<online_change::SwitchReport> switch_report(vm::Request request);

  std::unique_ptr<vm::Transport> transport_;
  base::Digest expected_{};
  uint64_t edition_ = 0;
  std::optional<base::Digest> staged_;  // package of stage()
};

}  // namespace stvm
