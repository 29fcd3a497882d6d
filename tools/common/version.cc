#include "tools/common/version.h"

#include <algorithm>

#include "ir/bytecode/image_versions.h"
#include "tools/common/json.h"

namespace tools {
namespace {

constexpr size_t kValueColumn = 16;

std::string text_of(const std::string& value) { return value; }
std::string text_of(uint32_t value) { return std::to_string(value); }
template <class T>
std::string text_of(const std::vector<T>& values) {
  std::string out;
  for (const T& value : values) out += (out.empty() ? "" : ", ") + text_of(value);
  return out.empty() ? "none" : out;
}

template <class T>
void value_json(const T& value, JsonWriter& json) {
  json.value(value);
}
template <class T>
void value_json(const std::vector<T>& values, JsonWriter& json) {
  json.begin_array();
  for (const T& value : values) json.value(value);
  json.end_array();
}

std::string line(std::string name, const std::string& value) {
  std::replace(name.begin(), name.end(), '_', ' ');
  name.resize(std::max(name.size() + 1, kValueColumn), ' ');
  return name + value + "\n";
}

}  // namespace

VersionFact image_formats() {
  std::vector<uint32_t> versions;
  for (uint32_t i = ir::kFirstImageVersion; i <= ir::kLastImageVersion; ++i) versions.push_back(i);
  return {"image_formats", std::move(versions)};
}

VersionFact native_tier(bool available) {
#if defined(__aarch64__)
  const std::string machine = "aarch64";
#else
  const std::string machine = "x86-64";
#endif
  return {"native_tier", available ? machine : std::string("none")};
}

std::string version_text(std::string_view tool, std::span<const VersionFact> facts) {
  std::string out = std::string(tool) + " " + kVersion + "\n" + line("commit", kCommit);
  for (const VersionFact& fact : facts) {
    out += line(fact.name, std::visit([](const auto& value) { return text_of(value); }, fact.value));
  }
  return out;
}

std::string version_json(std::string_view tool, std::span<const VersionFact> facts) {
  JsonWriter json;
  json.begin_object().field("tool", tool).field("version", kVersion).field("commit", kCommit);
  for (const VersionFact& fact : facts) {
    json.key(fact.name);
    std::visit([&](const auto& value) { value_json(value, json); }, fact.value);
  }
  json.end_object();
  return json.finish();
}

}  // namespace tools
