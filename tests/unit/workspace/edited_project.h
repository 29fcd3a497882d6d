// Random edits of a source text, and what a build from nothing makes of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/source.h"
#include "workspace/incremental_build.h"

namespace test {

class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 2654435761u + 1) {}
  uint32_t below(uint32_t limit) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return limit == 0 ? 0 : static_cast<uint32_t>((state_ >> 33) % limit);
  }

 private:
  uint64_t state_;
};

// What somebody sees of a build.
struct Outcome {
  std::optional<base::Bytes> image;
  std::string messages;
  std::string refusal;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome build_from_nothing(const base::SourceMap& sources, const workspace::Settings& settings);
Outcome build_again(workspace::IncrementalBuild& build, const base::SourceMap& sources);

// A few random changes of lines, words and numbers; mostly between the variables and the end of a
// POU, where they are statements.
std::string edited(const std::string& text, Random& random);

base::SourceMap one_file(const std::string& text);
std::string read_file(const std::string& path);
// All *.st files below a folder of the repository, sorted.
std::vector<std::string> sources_below(const std::string& folder);
// Of its file name: the same whatever other files come, and wherever the repository lies.
uint64_t seed_of(const std::string& path);

}  // namespace test
