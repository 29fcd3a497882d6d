// A law that did not hold: ends the run of a seed.
#pragma once

#include <stdexcept>
#include <string>

namespace sim {

class Violation : public std::runtime_error {
 public:
  explicit Violation(const std::string& text) : std::runtime_error(text) {}
};

inline void require(bool holds, const std::string& law) {
  if (!holds) throw Violation(law);
}

}  // namespace sim
