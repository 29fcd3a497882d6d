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

// A source or settings, where a link leads to.
bool has_text_of_people(const char* path) {
  char* const real = ::realpath(path, nullptr);
  const bool has = real != nullptr && (is_source_name(real) || name_of(real) == kProjectFile);
  std::free(real);
  return has;
}

}  // namespace

bool is_source_name(const std::string& path) { return is_source_name(path.c_str()); }

bool is_source_name(const char* path) {
  const char* const name = name_of(path);
  const char* const dot = std::strrchr(name, '.');
  return dot != nullptr && dot != name &&
         (::strcasecmp(dot, ".st") == 0 || ::strcasecmp(dot, ".iecst") == 0 ||
          ::strcasecmp(dot, ".exp") == 0);
}

base::Status check_output(const std::string& output, const std::vector<std::string>& inputs,
                          bool any_source) {
  struct stat own;
  struct stat other;
  const bool loses = ::stat(output.c_str(), &own) == 0 && S_ISREG(own.st_mode) && own.st_size > 0;
  if (!loses) return base::Ok{};
  bool taken = any_source && has_text_of_people(output.c_str());
  for (const std::string& input : inputs) {
    taken |= ::stat(input.c_str(), &other) == 0 && other.st_dev == own.st_dev &&
             other.st_ino == own.st_ino;
  }
  if (!taken) return base::Ok{};
  return base::Error{base::Refusal::kFileUnwritable,
                     output +
                         ": is a source, or this command reads it; nothing was written. "
                         "Name another file"};
}

base::Status check_outputs(const Options& options) {
  std::vector<std::string> inputs = options.arguments();
  for (const char* const read : {"--first", "--base", "--key", "--values"}) {
    inputs.push_back(options.text(read));
  }
  base::Status free = base::Ok{};
  for (const char* const name : {"--output", "--trace", "--plot", "--chart", "--record"}) {
    if (free.ok()) free = check_output(options.text(name), inputs, !options.has("--force"));
  }
  return free;
}

}  // namespace tools
