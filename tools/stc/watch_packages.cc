#include "tools/stc/watch_packages.h"

#include <poll.h>

#include <cstdio>

#include "ir/bytecode/verify.h"
#include "online_change/package/package.h"
#include "online_change/plan/pou_edits.h"
#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/stc/embed.h"

namespace stc {
namespace {

using PackageClock = std::chrono::steady_clock;

int64_t monotonic_ns(PackageClock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

base::Status WatchedPackages::begin(base::Bytes running) {
  if (auto sound = ir::verify(running); !sound.ok()) return sound.error();
  base::Result<ir::DecodedImage> image = ir::decode(running, nullptr);
  if (!image.ok()) return image.error();
  written_ = {std::move(running), std::move(image->places)};
  running_ = std::make_shared<const ir::Image>(std::move(image->image));
  return base::Ok{};
}

base::Result<WatchTarget::Next> WatchedPackages::take(const ir::Image& image,
                                                      const Project& project, const Built& built) {
  base::Result<Embedding> embedding = Embedding::of(project);
  if (!embedding.ok()) return embedding.error();
  ir::Image copy;
  const ir::Image& named = embedding->named(image, copy);
  const ir::KnownImage known{*running_, written_.bytes, written_.places};
  return bring(named, embedding->encode(named, &known), built);
}

base::Result<WatchTarget::Next> WatchedPackages::take(std::vector<ResourceVersion>& versions,
                                                      const Project& project, const Built& built) {
  if (versions.size() > 1) {
    return base::Error{base::Refusal::kUsage,
                       "there are several RESOURCEs, but what runs is of none of them"};
  }
  const ir::Image& image = versions.front().version.image;
  base::Result<Embedding> embedding = Embedding::of(project);
  if (!embedding.ok()) return embedding.error();
  return bring(image, embedding->encode(image, nullptr), built);
}

base::Result<WatchTarget::Next> WatchedPackages::bring(const ir::Image& image,
                                                       ir::WrittenImage made, const Built& built) {
  if (made.bytes == written_.bytes) return send(built, {}, image, std::move(made));
  const online_change::EncodedImage before{*running_, written_.bytes};
  const online_change::EncodedImage after{image, made.bytes};
  if (restricted_) {
    base::Status kept = online_change::check_restricted(online_change::pou_edits(before, after));
    if (!kept.ok()) return kept.error();
  }
  auto package = online_change::make_short_package(before, after);
  if (!package.ok()) return package.error();
  return send(built, std::move(*package), image, std::move(made));
}

// No package: nothing has changed since the base, if that still runs.
base::Result<WatchTarget::Next> WatchedPackages::send(const Built& built, base::Bytes package,
                                                      const ir::Image& image,
                                                      ir::WrittenImage made) {
  const tools::FollowedChange change{monotonic_ns(built.saved),  monotonic_ns(built.seen),
                                     monotonic_ns(built.made),   monotonic_ns(PackageClock::now()),
                                     ir::digest(written_.bytes), std::move(package)};
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
  if (answer->end == tools::FollowedEnd::kRuns) {
    running_ = std::make_shared<const ir::Image>(image);
    written_ = std::move(made);
    return Next::kBase;
  }
  base::Status begun = begin(std::move(answer->image));
  if (!begun.ok()) return begun.error();
  return Next::kOtherBase;
}

// Nothing comes from stvm but answers, and its end.
WatchTarget::Rest WatchedPackages::rest(std::chrono::nanoseconds time, int descriptor) {
  pollfd ready[] = {{socket_, POLLIN, 0}, {descriptor, POLLIN, 0}};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(time);
  if (::poll(ready, std::size(ready), static_cast<int>(ms.count())) <= 0) return Rest::kOver;
  return ready[0].revents != 0 ? Rest::kEnd : Rest::kEvent;
}

}  // namespace stc
