// Two versions of a program each, and the package that leads from one to the other: golden files of
// changes, and one program that fills every table of an image.
#pragma once

#include <string>

#include "ir/bytecode/verify.h"
#include "online_change/package/package.h"

namespace fuzz {

struct Versions {
  ir::VerifiedImage from;
  ir::VerifiedImage to;
  online_change::Package package;
};

// By number, modulo how many there are; made when first asked for.
const Versions& versions(uint8_t number);
// The sources of the second version, linked on top of that image, which is verified.
base::Result<ir::Image> second_on(uint8_t number, const ir::Image& base);
// The versions that fill every table: with devices, safe outputs and shared globals.
inline constexpr uint8_t kEveryTable = 13;

}  // namespace fuzz
