#include "tools/common/version.h"

#include <algorithm>

#include "base/joined.h"
#include "ir/bytecode/image_versions.h"
#include "tools/common/json.h"

namespace tools {
namespace {

constexpr size_t kValueColumn = 16;

std::string line(std::string name, const std::vector<std::string>& values) {
  std::replace(name.begin(), name.end(), '_', ' ');
  name.resize(std::max(name.size() + 1, kValueColumn), ' ');
  for (size_t i = 0; i < values.size(); ++i) name += base::joined({i == 0 ? "" : ", ", values[i]});
  return name + (values.empty() ? "none\n" : "\n");
}

}  // namespace

VersionFact image_formats() {
  VersionFact fact{"image_formats", VersionFact::kNumbers, {}};
  for (uint32_t i = ir::kFirstImageVersion; i <= ir::kLastImageVersion; ++i) {
    fact.values.push_back(std::to_string(i));
  }
  return fact;
}

VersionFact native_tier(bool available) {
#if defined(__aarch64__)
  const char* const machine = "aarch64";
#else
  const char* const machine = "x86-64";
#endif
  return {"native_tier", VersionFact::kText, {available ? machine : "none"}};
}

std::string version_text(std::string_view tool, std::span<const VersionFact> facts) {
  std::string out = base::joined({tool, " ", kVersion, "\n", line("commit", {kCommit})});
  for (const VersionFact& fact : facts) out += line(fact.name, fact.values);
  return out;
}

std::string version_json(std::string_view tool, std::span<const VersionFact> facts) {
  JsonWriter json;
  json.begin_object().field("tool", tool).field("version", kVersion).field("commit", kCommit);
  for (const VersionFact& fact : facts) {
    const bool list = fact.kind == VersionFact::kTexts || fact.kind == VersionFact::kNumbers;
    json.key(fact.name);
    if (list) json.begin_array();
    for (const std::string& value : fact.values) {
      fact.kind >= VersionFact::kNumber ? json.number(value) : json.value(value);
    }
    if (list) json.end_array();
  }
  json.end_object();
  return json.finish();
}

}  // namespace tools
