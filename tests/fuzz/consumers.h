// Everybody who takes a verified image, each asked for all that it does with it. Nothing is
// expected of the answers but that they come, that a refusal says why, and that what must agree
// agrees.
#pragma once

#include <functional>

#include "ir/bytecode/verify.h"
#include "online_change/apply/change.h"

namespace fuzz {

// Versions that declare more data memory are read, and not run.
inline constexpr uint64_t kMostData = uint64_t{16} << 20;
inline bool can_run(const ir::VerifiedImage& image) {
  return image.image().data_capacity <= kMostData;
}

// Texts of tools, symbols, values.
void read_image(const ir::VerifiedImage& image);
// Its code as the native tier sees it, and as objects again.
void read_code(const ir::VerifiedImage& image);
// What a change from one to the other would do: plan, package, reports and fates, edits of POUs,
// types, tables and devices, and what a controller would refuse.
void compare_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to);
// Values that a restart with another program carries over.
void carry_values(const ir::VerifiedImage& from, const ir::VerifiedImage& to);
// An edit from one to the other, made in a third program (E-09).
void merge_images(const ir::VerifiedImage& original, const ir::VerifiedImage& edited,
                  const ir::VerifiedImage& target);
// The sources of a version, linked on top of what runs.
using Relink = std::function<base::Result<ir::Image>(const ir::Image& base)>;
void link_on(const Relink& relink, const ir::VerifiedImage& base);
// Cold start, scans, forces, values by path, restarts, on both tiers, which give the same values.
void run_image(const ir::VerifiedImage& image);
// A running controller of `from` changes to `to`, runs, goes back, runs, changes for good.
void change_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to,
                   online_change::Strategy strategy);
// A controller of `from` is asked all that a client can ask, rehearses the change to `to`, makes it
// under conditions, and goes back, by one of kServings ways. All of it is recorded and played
// again, and comes out the same.
inline constexpr uint8_t kServings = 4;
void serve_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to,
                  online_change::Strategy strategy, uint8_t serving);
// Both are resources of one configuration.
void exchange_globals(const ir::VerifiedImage& one, const ir::VerifiedImage& other);

}  // namespace fuzz
