// `TOOL version`: what a bug report, a package and a script need to know of a program.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tools {

// From a generated file (scripts/identity.cmake). Only the two programs have it, so a commit
// compiles that file and links nothing else.
extern const char kVersion[];
extern const char kCommit[];  // "unknown" in what is built outside of a repository
// Where a page for each code is ("/E3001" after it); "": nowhere that this build knows of.
extern const char kDocumentation[];

// What a tool says beside: "protocol" and 10; "adapters" and their names.
struct VersionFact {
  enum Kind : uint8_t { kText, kTexts, kNumber, kNumbers };
  const char* name;
  Kind kind;
  std::vector<std::string> values;
};

// Every version of images that this program reads.
VersionFact image_formats();
// The machine whose code it makes, or "none".
VersionFact native_tier(bool available);

std::string version_text(std::string_view tool, std::span<const VersionFact> facts);
std::string version_json(std::string_view tool, std::span<const VersionFact> facts);

}  // namespace tools
