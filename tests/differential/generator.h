// Random valid ST programs: all elementary arithmetic, conversions, structures,
// arrays, strings, functions, function blocks, every statement. Some of them trap; all tiers
// must then trap at the same place.
#pragma once

#include <cstdint>
#include <string>

namespace differential {

std::string random_program(uint64_t seed);

}  // namespace differential
