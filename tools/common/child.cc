#include "tools/common/child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>

#include "tools/common/exit.h"
#include "tools/common/files.h"

extern char** environ;

namespace tools {
namespace {

using FileActions = posix_spawn_file_actions_t;

// The pid. `prepare` says what becomes of the standard streams.
template <class Prepare>
base::Result<pid_t> spawn(const std::vector<std::string>& command, Prepare prepare) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  FileActions actions;
  posix_spawn_file_actions_init(&actions);
  prepare(actions);
  pid_t pid = 0;
  int code = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code == 0) return pid;
  return base::Error{base::Refusal::kFileNotFound, command[0] + ": " + std::strerror(code)};
}

// The exit code; -1 when it ended in another way.
int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string read_all(int fd) {
  std::string text;
  char buffer[4096];
  for (;;) {
    ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<size_t>(n));
  }
}

constexpr uint32_t kMaxMessage = 1u << 30;

base::Error no_partner() {
  return {base::Refusal::kNotRunning, "the tool at the other end of the connection is gone"};
}

bool receive_all(int socket, std::span<uint8_t> to) {
  while (!to.empty()) {
    const ssize_t n = ::recv(socket, to.data(), to.size(), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    to = to.subspan(static_cast<size_t>(n));
  }
  return true;
}

struct Output {
  std::string messages;
  std::optional<base::Error> refusal;
};

// "stc: R0202: text", or "stc.toml:3:1: error[R0506]: text" as an error with its place in front.
std::optional<base::Error> refusal_in(const std::string& tool, std::string_view line) {
  const std::string mark = tool + ": ";
  if (line.starts_with(mark) && line.size() > mark.size() + 7) {
    const auto code = base::refusal_from_code(line.substr(mark.size(), 5));
    if (code) return base::Error{*code, std::string(line.substr(mark.size() + 7))};
  }
  constexpr std::string_view kPlaced = ": error[R";
  const size_t at = line.find(kPlaced);
  if (at == std::string_view::npos) return std::nullopt;
  const size_t code_at = at + kPlaced.size() - 1;
  const auto code = base::refusal_from_code(line.substr(code_at, 5));
  if (!code || line.size() < code_at + 8) return std::nullopt;
  return base::Error{
      *code, std::string(line.substr(0, at)) + ": " + std::string(line.substr(code_at + 8))};
}

// A refusal, with the lines of source and help below it, is not a message but comes back as the
// error, so that this tool says it once, with the same code.
Output sort_out(const std::string& tool, const std::string& text) {
  Output out;
  for (size_t at = 0; at < text.size();) {
    size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (auto refusal = refusal_in(tool, line)) {
      out.refusal = std::move(refusal);
    } else if (!out.refusal || !line.starts_with("  ")) {
      out.messages += std::string(line) + "\n";
    }
  }
  return out;
}

}  // namespace

// Errors of sources, read as text before, once more as JSON on our standard output. Nothing else
// of this run is printed there.
static void tell_as_json(std::vector<std::string> command) {
  command.insert(command.begin() + 2, "--format=json");
  std::fflush(stdout);
  const base::Result<pid_t> child = spawn(command, [](FileActions& actions) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  });
  if (child.ok()) wait_for(*child);
}

base::Status run_beside(const std::string& tool, const std::vector<std::string>& arguments,
                        Messages messages) {
  std::vector<std::string> command = {own_folder() + "/" + tool};
  command.insert(command.end(), arguments.begin(), arguments.end());
  // What it says is read here, whatever the environment says of colours.
  command.insert(command.begin() + 2, "--color=never");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return base::Error{base::Refusal::kInternal, "no pipe"};
  base::Result<pid_t> child = spawn(command, [&](FileActions& actions) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  });
  ::close(ends[1]);
  if (!child.ok()) {
    ::close(ends[0]);
    return base::Error{child.error().refusal,
                       child.error().text + "; it comes with the package " + tool};
  }
  Output output = sort_out(tool, read_all(ends[0]));
  ::close(ends[0]);
  const bool good = wait_for(*child) == 0;
  if (!good || messages == Messages::kShown) std::fputs(output.messages.c_str(), stderr);
  if (good) return base::Ok{};
  if (output.refusal) {
    const bool of_sources = output.refusal->refusal == base::Refusal::kSourceErrors;
    if (of_sources && has_refusal_form()) tell_as_json(std::move(command));
    return *output.refusal;
  }
  return base::Error{base::Refusal::kInternal, tool + " failed without a reason"};
}

base::Result<ConnectedChild> ConnectedChild::start(const std::vector<std::string>& command,
                                                   Errors errors) {
  std::unique_ptr<VisibleErrors> visible;
  if (errors == Errors::kVisible) {
    auto made = VisibleErrors::make();
    if (!made.ok()) return made.error();
    visible = std::move(*made);
  }
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return base::Error{base::Refusal::kInternal, "no pair of sockets"};
  }
  base::Result<pid_t> child = spawn(command, [&](FileActions& actions) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    if (!visible) return;
    posix_spawn_file_actions_adddup2(&actions, visible->for_child(), STDERR_FILENO);
  });
  ::close(ends[1]);
  if (!child.ok()) {
    ::close(ends[0]);
    return child.error();
  }
  if (visible) visible->started();
  ConnectedChild out(*child, ends[0]);
  out.errors_ = std::move(visible);
  return out;
}

ConnectedChild::ConnectedChild(ConnectedChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      socket_(std::exchange(other.socket_, -1)),
      errors_(std::move(other.errors_)) {}

ConnectedChild::~ConnectedChild() {
  if (socket_ >= 0) ::close(socket_);
  wait();
}

int ConnectedChild::wait() {
  const int pid = std::exchange(pid_, -1);
  const int code = pid > 0 ? wait_for(pid) : -1;
  errors_.reset();
  return code;
}

void ConnectedChild::end() {
  if (pid_ > 0) ::kill(pid_, SIGTERM);
}

int ConnectedChild::take_socket() { return std::exchange(socket_, -1); }

base::Status send_message(int socket, base::ByteSpan message) {
  base::ByteWriter length;
  length.u32(static_cast<uint32_t>(message.size()));
  for (base::ByteSpan rest : {base::ByteSpan(length.bytes()), message}) {
    while (!rest.empty()) {
      const ssize_t n = ::send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return no_partner();
      rest = rest.subspan(static_cast<size_t>(n));
    }
  }
  return base::Ok{};
}

base::Result<base::Bytes> receive_message(int socket) {
  uint8_t length[4];
  if (!receive_all(socket, length)) return no_partner();
  const uint32_t size = base::ByteReader(length).u32();
  if (size > kMaxMessage) return no_partner();
  base::Bytes message(size);
  if (!receive_all(socket, message)) return no_partner();
  return message;
}

namespace {

constexpr const char* kFolderPrefix = "stvm-";
constexpr const char* kFolderMark = "/.stvm-temporary";

// Removes folders in `parent` whose owner lives no more. What has no mark is none of ours.
void remove_left_folders(const std::string& parent) {
  std::error_code failed;
  std::filesystem::directory_iterator at(parent, failed);
  for (; !failed && at != std::filesystem::directory_iterator(); at.increment(failed)) {
    if (!at->path().filename().string().starts_with(kFolderPrefix)) continue;
    struct stat folder {};
    if (::lstat(at->path().c_str(), &folder) != 0 || folder.st_uid != ::geteuid()) continue;
    const std::string mark = at->path().string() + kFolderMark;
    const int fd = S_ISDIR(folder.st_mode) ? ::open(mark.c_str(), O_RDWR | O_CLOEXEC) : -1;
    if (fd < 0) continue;
    std::error_code ignored;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove_all(at->path(), ignored);
    ::close(fd);
  }
}

}  // namespace

base::Result<TemporaryFolder> TemporaryFolder::make() {
  const char* chosen = std::getenv("TMPDIR");
  const std::string parent = chosen != nullptr && *chosen != '\0' ? chosen : "/tmp";
  remove_left_folders(parent);
  for (;;) {
    std::string path = parent + "/" + kFolderPrefix + "XXXXXX";
    const bool made = ::mkdtemp(path.data()) != nullptr;
    const std::string mark = path + kFolderMark;
    const int fd = made ? ::open(mark.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600) : -1;
    if (fd < 0) {
      const int reason = errno;
      if (made) ::rmdir(path.c_str());
      return base::Error{base::Refusal::kFileUnwritable, path + ": " + std::strerror(reason)};
    }
    // Where files cannot be locked nobody takes it for one that was left.
    struct stat marked {};
    const bool locked = ::flock(fd, LOCK_EX) == 0 && ::fstat(fd, &marked) == 0;
    if (!locked || marked.st_nlink != 0) return TemporaryFolder(std::move(path), fd);
    ::close(fd);  // another process did, before it was locked
  }
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), mark_(std::exchange(other.mark_, -1)) {}

TemporaryFolder::~TemporaryFolder() {
  if (path_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  ::close(mark_);
}

}  // namespace tools
