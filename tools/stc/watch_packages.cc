#include "tools/stc/watch_packages.h"

#include <poll.h>

#include <cstdio>

#include "online_change/package/package.h"
#include "online_change/plan/pou_edits.h"
#include "tools/common/child.h"
#include "tools/common/exit.h"

namespace stc {
namespace {

using Clock = std::chrono::steady_clock;

int64_t monotonic_ns(Clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

base::Status WatchedPackages::begin(base::Bytes running) {
  base::Result<ir::Image> image = ir::decode(running);
  if (!image.ok()) return image.error();
  bytes_ = std::move(running);
  running_ = std::make_shared<const ir::Image>(std::move(*image));
  return base::Ok{};
}

base::Result<WatchTarget::Next> WatchedPackages::take(const ir::Image& image, const Project&,
                                                      const Built& built) {
  return bring(image, ir::encode(image), built);
}

base::Result<WatchTarget::Next> WatchedPackages::take(std::vector<ResourceVersion>& versions,
                                                      const Project&, const Built& built) {
  if (versions.size() > 1) {
    return base::Error{base::Refusal::kUsage,
                       "there are several RESOURCEs, but what runs is of none of them"};
  }
  Version& version = versions.front().version;
  return bring(version.image, std::move(version.bytes), built);
}

base::Result<WatchTarget::Next> WatchedPackages::bring(const ir::Image& image, base::Bytes bytes,
                                                       const Built& built) {
  if (bytes == bytes_) {
    const base::Digest same = ir::digest(bytes_);
    return send(built, same, {}, std::move(bytes));
  }
  const online_change::EncodedImage before{*running_, bytes_};
  const online_change::EncodedImage after{image, bytes};
  if (restricted_) {
    base::Status kept = online_change::check_restricted(online_change::pou_edits(before, after));
    if (!kept.ok()) return kept.error();
  }
  auto package = online_change::make_package(before, after);
  if (!package.ok()) return package.error();
  base::Bytes message = online_change::encode_short(*package, bytes_);
  return send(built, package->base, std::move(message), std::move(bytes));
}

// No package: nothing has changed since `base`, if that still runs.
base::Result<WatchTarget::Next> WatchedPackages::send(const Built& built, const base::Digest& base,
                                                      base::Bytes package, base::Bytes made) {
  const tools::FollowedChange change{monotonic_ns(built.saved),
                                     monotonic_ns(built.seen),
                                     monotonic_ns(built.made),
                                     monotonic_ns(Clock::now()),
                                     base,
                                     std::move(package)};
  if (!tools::send_message(socket_, encode(change)).ok()) return Next::kEnd;
  base::Result<base::Bytes> message = tools::receive_message(socket_);
  if (!message.ok()) return Next::kEnd;
  base::Result<tools::FollowedAnswer> answer = tools::decode_followed_answer(*message);
  if (!answer.ok()) {
    tools::refuse("stc", answer.error());
    return Next::kEnd;
  }
  switch (answer->end) {
    case tools::FollowedEnd::kNotWanted:
      return Next::kWait;
    case tools::FollowedEnd::kAgain:
      return Next::kAgain;
    case tools::FollowedEnd::kRuns:
    case tools::FollowedEnd::kOtherBase:
      break;
  }
  const bool is_ours = answer->end == tools::FollowedEnd::kRuns;
  base::Status begun = begin(is_ours ? std::move(made) : std::move(answer->image));
  if (!begun.ok()) return begun.error();
  return is_ours ? Next::kBase : Next::kOtherBase;
}

// Nothing comes from stvm but answers, and its end.
WatchTarget::Rest WatchedPackages::rest(std::chrono::nanoseconds time, int descriptor) {
  pollfd ready[] = {{socket_, POLLIN, 0}, {descriptor, POLLIN, 0}};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(time);
  if (::poll(ready, std::size(ready), static_cast<int>(ms.count())) <= 0) return Rest::kOver;
  return ready[0].revents != 0 ? Rest::kEnd : Rest::kEvent;
}

}  // namespace stc
