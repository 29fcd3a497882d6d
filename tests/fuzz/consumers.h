// Everybody who takes a verified image, each asked for all that it does with it. Nothing is expected
// of the answers but that they come, that a refusal says why, and that what must agree agrees.
#pragma once

#include "ir/bytecode/verify.h"
#include "online_change/apply/change.h"

namespace fuzz {

// Versions that declare more data memory are read, and not run.
inline constexpr uint64_t kMostData = uint64_t{16} << 20;

// Texts of tools, symbols, values.
void read_image(const ir::VerifiedImage& image);
// What a change from one to the other would do: plan, package, reports, edits of POUs and devices,
// values that a restart carries over.
void compare_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to);
// An edit from one to the other, made in a third program (E-09).
void merge_images(const ir::VerifiedImage& original, const ir::VerifiedImage& edited,
                  const ir::VerifiedImage& target);
// Cold start, scans, forces, values by path, restarts, on both tiers, which give the same values.
void run_image(const ir::VerifiedImage& image);
// A running controller of `from` changes to `to`, runs, goes back, runs, changes for good.
void change_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to,
                   online_change::Strategy strategy);
// Both are resources of one configuration.
void exchange_globals(const ir::VerifiedImage& one, const ir::VerifiedImage& other);

}  // namespace fuzz
