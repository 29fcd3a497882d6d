// The version of the stvm that an edit is for (E-20).
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/common/ssh.h"
#include "tools/common/version.h"
#include "tools/stc/online_base.h"

namespace stc {
namespace {

constexpr std::string_view kFirstWord = "stvm ";
constexpr size_t kMostSaid = 4096;

// "0.1.0", "2.0-dev"; an address such as 10.0.0.3 has three dots.
bool is_version(const std::string& text) {
  const std::string number = text.substr(0, text.find('-'));
  const auto digit = [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; };
  const auto dots = std::count(number.begin(), number.end(), '.');
  return !number.empty() && std::isdigit(static_cast<unsigned char>(number[0])) != 0 &&
         std::all_of(number.begin(), number.end(), digit) && dots <= 2;
}

std::string said_by(tools::ConnectedChild child) {
  const int socket = child.take_socket();
  std::string said;
  char buffer[512];
  while (said.size() < kMostSaid) {
    const ssize_t n = ::read(socket, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    said.append(buffer, static_cast<size_t>(n));
  }
  ::close(socket);
  return said;
}

// "stvm 0.1.0" is its first line; "": it did not say it.
std::string version_at(const std::string& host) {
  const auto command = tools::ssh_command(host, "stvm version");
  if (!command.ok()) return {};
  base::Result<tools::ConnectedChild> child =
      tools::ConnectedChild::start(*command, tools::ConnectedChild::Errors::kVisible);
  if (!child.ok()) return {};
  const std::string said = said_by(std::move(*child));
  if (!said.starts_with(kFirstWord)) return {};
  return said.substr(kFirstWord.size(), said.find('\n') - kFirstWord.size());
}

}  // namespace

std::vector<std::string> target_versions(const tools::Options& options) {
  std::vector<std::string> versions;
  for (const std::string& target : options.all("--target")) {
    if (is_version(target)) {
      versions.push_back(target);
    } else if (tools::is_folder(target)) {
      versions.emplace_back(tools::kVersion);  // of this machine: the stvm beside this tool
    } else {
      versions.push_back(version_at(target));
    }
  }
  return versions;
}

}  // namespace stc
