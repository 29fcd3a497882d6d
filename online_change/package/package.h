// The change package: the one file or message by which a change reaches a
// controller. Made for one exact base version (its digest); carries the new
// image, the plan and the inverse plan. The controller checks all of it (V17).
#pragma once

#include "base/hash.h"
#include "base/result.h"
#include "ir/bytecode/image.h"
#include "online_change/plan/plan.h"
#include "online_change/plan/same_data.h"

namespace online_change {

struct Package {
  base::Digest base{};  // digest of the image it applies to
  base::Bytes image;    // encoded new image
  Plan forward;
  Plan inverse;
};

inline constexpr size_t kPackageMagicBytes = 4;
bool has_package_magic(base::ByteSpan bytes);
base::Bytes encode(const Package& package);
// The package without what the base has too: it can be decoded beside the base only.
base::Bytes encode_short(const Package& package, base::ByteSpan base_image);
// In three parts: layout, program (together the image), commands. All three checksums are verified
// before anything of them is used (C4): kBadHash names the part. Consistency with the images is
// check_package(). `base_image`: the encoded image that runs; kStaleBase when a package in the
// short form was made for another one.
base::Result<Package> decode(base::ByteSpan bytes, base::ByteSpan base_image = {});
base::Error stale_base(const base::Digest& base, const base::Digest& running);
// V17: copies in range and inside areas of their own version, types right, no target twice, every
// variable of the new version kept, written or initialised.
base::Status check_package(const Package& package, const ir::Image& old_image,
                           const ir::Image& new_image);
base::Result<Package> make_package(base::ByteSpan old_image, base::ByteSpan new_image);
// For images that were verified, or come from the linker.
base::Result<Package> make_package(const EncodedImage& from, const EncodedImage& to);
// The same in the short form, without a package in between.
base::Result<base::Bytes> make_short_package(const EncodedImage& from, const EncodedImage& to);
// Does it do nothing to data, there and back? Sound where the two versions have the same_data().
bool leaves_all(const Package& package);

}  // namespace online_change
