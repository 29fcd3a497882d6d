// What `stvm change --watch` and the `stc package --watch` that it starts say to each other: a
// change package at each save, and what became of it.
#pragma once

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace tools {

// From stc: the sources have become something else than what runs.
struct FollowedChange {
  // CLOCK_MONOTONIC: the last file was saved, that was seen, there is an image, and this package.
  int64_t saved_ns = 0;
  int64_t seen_ns = 0;
  int64_t built_ns = 0;
  int64_t packed_ns = 0;
  base::Digest base{};  // the version that the package is for
  base::Bytes package;  // none: the sources give that version
};

// From stvm, after each.
enum class FollowedEnd : uint8_t {
  kRuns,       // the package's version is the base from now on
  kNotWanted,  // refused, or by leave of nobody: the base stays
  kAgain,      // the base stays; once more, from what is saved by now
  kOtherBase,  // `image` runs by now; once more, against it
};
struct FollowedAnswer {
  FollowedEnd end = FollowedEnd::kNotWanted;
  base::Bytes image;
};

base::Bytes encode(const FollowedChange& change);
base::Bytes encode(const FollowedAnswer& answer);
// kProtocol for anything else.
base::Result<FollowedChange> decode_followed_change(base::ByteSpan bytes);
base::Result<FollowedAnswer> decode_followed_answer(base::ByteSpan bytes);

}  // namespace tools
