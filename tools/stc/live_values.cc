#include "tools/stc/live_values.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "tools/common/child.h"
#include "tools/common/files.h"

namespace stc {
namespace {

// What `stvm get` prints.
base::Result<std::string> get(const std::string& place, std::vector<std::string> arguments) {
  std::error_code ignored;
  const char* option = std::filesystem::is_directory(place, ignored) ? "--dir" : "--host";
  std::vector<std::string> command{tools::own_folder() + "/stvm", "get", option, place};
  command.insert(command.end(), arguments.begin(), arguments.end());
  base::Result<tools::ConnectedChild> child = tools::ConnectedChild::start(command);
  if (!child.ok()) return child.error();
  int socket = child->take_socket();
  std::string out;
  char buffer[4096];
  for (;;) {
    ssize_t n = ::read(socket, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    out.append(buffer, static_cast<size_t>(n));
  }
  ::close(socket);
  return out;
}

}  // namespace

void set_values(std::string_view lines, frontend::draw::Live& live) {
  while (!lines.empty()) {
    size_t end = std::min(lines.find('\n'), lines.size());
    std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    size_t sign = line.find('=');
    if (sign != std::string_view::npos) {
      live.set(line.substr(0, sign), std::string(line.substr(sign + 1)));
    }
  }
}

base::Status fetch_values(const std::string& place, const std::vector<std::string>& names,
                          frontend::draw::Live& live) {
  if (names.empty()) return base::Ok{};
  std::vector<std::string> arguments{"--list"};
  arguments.insert(arguments.end(), names.begin(), names.end());
  base::Result<std::string> list = get(place, arguments);
  if (!list.ok()) return list.error();
  arguments.clear();
  for (std::string_view lines = *list; !lines.empty();) {
    size_t end = std::min(lines.find('\n'), lines.size());
    std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    size_t colon = line.find(" : ");
    if (colon != std::string_view::npos) arguments.emplace_back(line.substr(0, colon));
  }
  if (arguments.empty()) {
    return base::Error{base::Refusal::kNoSuchVariable,
                       place + " has none of the picture's variables, or does not answer"};
  }
  base::Result<std::string> values = get(place, arguments);
  if (!values.ok()) return values.error();
  set_values(*values, live);
  return base::Ok{};
}

base::Status read_values(const std::string& file, frontend::draw::Live& live) {
  base::Result<std::string> text = tools::read_text(file);
  if (!text.ok()) return text.error();
  set_values(*text, live);
  return base::Ok{};
}

}  // namespace stc
