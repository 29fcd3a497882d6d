#include "tools/common/outputs.h"

#include <strings.h>
#include <sys/stat.h>

#include <cstdlib>
#include <cstring>

#include "tools/common/project_file.h"

namespace tools {
namespace {

const char* name_of(const char* path) {
  const char* const slash = std::strrchr(path, '/');
  return slash == nullptr ? path : slash + 1;
}

[[gnu::always_inline]] inline bool named_as_source(const char* name) {
  const char* const dot = std::strrchr(name, '.');
  return dot != nullptr && dot != name &&
         (::strcasecmp(dot, ".st") == 0 || ::strcasecmp(dot, ".iecst") == 0 ||
          ::strcasecmp(dot, ".exp") == 0);
}

// A source or settings, where a link leads to.
bool has_text_of_people(const char* path) noexcept {
  char* const real = ::realpath(path, nullptr);
  const bool has =
      real != nullptr && (named_as_source(name_of(real)) || name_of(real) == kProjectFile);
  std::free(real);
  return has;
}

bool is_output(std::string_view option) noexcept {
  constexpr std::string_view kOutputs = "--output --trace --plot --chart --record";
  return kOutputs.find(option) != kOutputs.npos;
}

bool takes(const std::string& output, const std::vector<std::string>& inputs,
           bool any_source) noexcept {
  struct stat own;
  struct stat other;
  const bool loses = ::stat(output.c_str(), &own) == 0 && S_ISREG(own.st_mode) && own.st_size > 0;
  if (!loses) return false;
  bool taken = any_source && has_text_of_people(output.c_str());
  for (const std::string& input : inputs) {
    taken |= ::stat(input.c_str(), &other) == 0 && other.st_dev == own.st_dev &&
             other.st_ino == own.st_ino;
  }
  return taken;
}

base::Error taken(const std::string& output) {
  return {base::Refusal::kFileUnwritable, output + ": is a source, or read by this command"};
}

}  // namespace

bool is_source_name(const std::string& path) { return named_as_source(name_of(path.c_str())); }

base::Status check_output(const std::string& output, const std::vector<std::string>& inputs,
                          bool any_source) {
  return takes(output, inputs, any_source) ? taken(output) : base::Status(base::Ok{});
}

base::Status check_outputs(const Options& options, bool in_place) {
  for (const auto& [name, outputs] : options.values()) {
    if (!is_output(name)) continue;
    // With --force a command decides itself which source it replaces.
    const std::vector<std::string> none;
    bool lost = takes(outputs[0], in_place ? none : options.arguments(), !options.has("--force"));
    for (const auto& [other, inputs] : options.values()) {
      lost |= &inputs != &outputs && takes(outputs[0], inputs, false);
    }
    if (lost) return taken(outputs[0]);
  }
  return base::Ok{};
}

}  // namespace tools
