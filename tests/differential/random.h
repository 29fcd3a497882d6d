// A small deterministic generator of random numbers: the same seed gives the same program on every
// machine.
#pragma once

#include <cstdint>

namespace differential {

class Random {
 public:
  // Mixed first: the states of neighbouring seeds would otherwise be one step apart.
  explicit Random(uint64_t seed) : state_(mixed(seed ^ 0x6a09e667f3bcc909ull)) {}
  uint64_t next() { return mixed(state_ += 0x9e3779b97f4a7c15ull); }  // splitmix64
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(next() % n); }
  bool one_in(uint32_t n) { return below(n) == 0; }

 private:
  static uint64_t mixed(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

  uint64_t state_;
};

}  // namespace differential
