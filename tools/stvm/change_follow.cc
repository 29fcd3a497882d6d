#include "tools/stvm/change_follow.h"

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/followed_change.h"
#include "tools/stvm/commands.h"
#include "vm/runtime/descriptor.h"

namespace stvm {
namespace {

using tools::FollowedEnd;

constexpr int kTrialLookMs = 200;

bool is_gone(const base::Error& error) { return error.refusal == base::Refusal::kNotRunning; }

class Follower {
 public:
  Follower(const SwitchOptions& options, ControllerClient& client, int stc)
      : options_(options), client_(client), stc_(stc) {}

  // Ok: stc has ended.
  base::Status run() {
    for (;;) {
      base::Result<base::Bytes> message = tools::receive_message(stc_);
      if (!message.ok()) return base::Ok{};
      base::Result<tools::FollowedChange> change = tools::decode_followed_change(*message);
      if (!change.ok()) return change.error();
      base::Result<tools::FollowedAnswer> answer = take(*change);
      if (!answer.ok()) return answer.error();
      if (!tools::send_message(stc_, encode(*answer)).ok()) return base::Ok{};
    }
  }

 private:
  // An error when the controller is gone, or does not say what it runs.
  base::Result<tools::FollowedAnswer> take(const tools::FollowedChange& change) {
    base::Result<vm::StatusReport> status = client_.status();
    if (!status.ok()) return status.error();
    if (change.package.empty() && status->running == change.base) {
      std::fputs("what was saved is running already\n", stderr);
      return tools::FollowedAnswer{};
    }
    if (base::Status free = check_no_trial(*status); !free.ok()) {
      std::fprintf(stderr, "waiting: %s\n", free.error().text.c_str());
      waited_ = true;
      return wait_for_end_of_trial(status->running);
    }
    if (status->running != change.base) {
      base::Result<base::Bytes> image = client_.image();
      if (!image.ok()) return image.error();
      return tools::FollowedAnswer{FollowedEnd::kOtherBase, std::move(*image)};
    }
    base::Result<Outcome> outcome = bring(options_, client_, change.package);
    if (!outcome.ok() && is_gone(outcome.error())) return outcome.error();
    if (outcome.ok()) print(options_, *outcome);
    if (!outcome.ok()) refuse(outcome.error());
    if (outcome.ok() && outcome->refused) refuse_reported(*outcome->refused);
    if (!outcome.ok() || !outcome->report) return tools::FollowedAnswer{};
    const bool waited = std::exchange(waited_, false);  // the times are somebody's who decided
    if (!options_.ask && !options_.json && !waited) say_times(change, *outcome);
    return tools::FollowedAnswer{FollowedEnd::kRuns, {}};
  }

  // Accepted, what waits is next. Undone, somebody wants the old program, and what waits was made
  // on top of the one that he took back: the next save is another try.
  base::Result<tools::FollowedAnswer> wait_for_end_of_trial(const base::Digest& on_trial) {
    for (;;) {
      base::Result<vm::StatusReport> status = client_.status();
      if (!status.ok()) return status.error();
      if (check_no_trial(*status).ok()) {
        if (status->running == on_trial) return tools::FollowedAnswer{FollowedEnd::kAgain, {}};
        std::fputs("undone: what was saved meanwhile is not brought; the next save will be\n",
                   stderr);
        return tools::FollowedAnswer{};
      }
      pollfd end = {stc_, POLLIN, 0};  // it has nothing to say now but that it ends
      if (::poll(&end, 1, kTrialLookMs) > 0) return tools::FollowedAnswer{};
    }
  }

  // Where the time from the save to the switch has gone. The controller answers when it knows which
  // releases the switch has made late.
  void say_times(const tools::FollowedChange& change, const Outcome& outcome) const {
    using Ms = std::chrono::duration<double, std::milli>;
    const auto at = [](Outcome::Time time) { return Ms(time.time_since_epoch()).count(); };
    const double now = at(std::chrono::steady_clock::now());
    const double runs = now - static_cast<double>(outcome.report->ago_ns) / 1e6;
    const struct {
      const char* what;
      double end;
    } kSteps[] = {{"seen", static_cast<double>(change.seen_ns) / 1e6},
                  {"built", static_cast<double>(change.built_ns) / 1e6},
                  {"packed", static_cast<double>(change.packed_ns) / 1e6},
                  {"sent and checked", at(outcome.staged)},
                  {"shown", at(outcome.shown)},
                  {"switched", runs}};
    double begin = static_cast<double>(change.saved_ns) / 1e6;
    std::printf("running %.0f ms after it was saved:", runs - begin);
    for (const auto& [what, end] : kSteps) {
      std::printf(" %s %.1f,", what, end - begin);
      begin = end;
    }
    std::printf(" and answered %.1f later\n", now - runs);
    std::fflush(stdout);
  }

  const SwitchOptions& options_;
  ControllerClient& client_;
  int stc_;
  bool waited_ = false;  // for the end of a trial: what comes next was saved long ago
};

}  // namespace

int follow(const Sources& sources, const SwitchOptions& options, ControllerClient& client) {
  if (options.ask && !options.dry_run && ::isatty(STDIN_FILENO) == 0) {
    return refuse({base::Refusal::kUsage,
                   "cannot ask for confirmation: stdin is not a terminal; pass --yes"});
  }
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return refuse(status.error());
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return refuse(running.error());
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return refuse(folder.error());
  const std::string base_file = folder->file("running.img");
  base::Status written = tools::write_file(base_file, *running);
  if (!written.ok()) return refuse(written.error());
  std::vector<std::string> command = {tools::own_folder() + "/stc", "package", "--watch", "--base",
                                      base_file};
  if (options.restricted) command.push_back("--restricted");
  auto stc = tools::ConnectedChild::start(stc_arguments(std::move(command), sources));
  if (!stc.ok()) return refuse(stc.error());
  const vm::Descriptor socket(stc->take_socket());
  base::Status ended = Follower(options, client, socket.get()).run();
  if (ended.ok()) return stc->wait();
  return refuse(ended.error());
}

}  // namespace stvm
