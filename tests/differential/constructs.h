// How often each construct of the language occurs in generated programs: what the generator is
// said to cover is counted in its text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace differential {

struct ConstructCount {
  const char* name = nullptr;
  uint64_t programs = 0;  // that have it
};

std::vector<ConstructCount> no_constructs();
void count_constructs(const std::string& source, std::vector<ConstructCount>& counts);

}  // namespace differential
