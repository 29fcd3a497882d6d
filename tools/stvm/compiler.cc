#include "tools/stvm/compiler.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "tools/common/files.h"
#include "vm/runtime/descriptor.h"

extern char** environ;

namespace stvm {
namespace {

struct Child {
  pid_t pid = 0;
  vm::Descriptor output;  // of both its streams
};

base::Result<Child> start(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return base::Error{base::Refusal::kInternal, "no pipe"};
  Child child{0, vm::Descriptor(ends[0])};
  vm::Descriptor input(ends[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  int code = posix_spawn(&child.pid, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code != 0) {
    return base::Error{base::Refusal::kFileNotFound,
                       program + ": " + std::strerror(code) + "; stvm needs stc beside it"};
  }
  return child;
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

struct Output {
  std::string messages;
  std::optional<base::Error> refusal;
};

// A refusal of stc ("stc: R0202: text" and a line of help) is not a message but comes back as the
// error, so that this tool says it once, with the same code.
Output sort_out(const std::string& text) {
  constexpr std::string_view kMark = "stc: ";
  Output out;
  for (size_t at = 0; at < text.size();) {
    size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    bool marked = line.starts_with(kMark) && line.size() > kMark.size() + 7;
    auto code = marked ? base::refusal_from_code(line.substr(kMark.size(), 5)) : std::nullopt;
    if (code) {
      out.refusal = base::Error{*code, std::string(line.substr(kMark.size() + 7))};
    } else if (!(out.refusal && line.starts_with("  help: "))) {
      out.messages += std::string(line) + "\n";
    }
  }
  return out;
}

}  // namespace

base::Result<TemporaryFolder> TemporaryFolder::make() {
  const char* parent = std::getenv("TMPDIR");
  std::string path = parent != nullptr && *parent != '\0' ? parent : "/tmp";
  path += "/stvm-XXXXXX";
  if (::mkdtemp(path.data()) == nullptr) {
    return base::Error{base::Refusal::kFileUnwritable, path + ": " + std::strerror(errno)};
  }
  return TemporaryFolder(std::move(path));
}

TemporaryFolder::~TemporaryFolder() {
  if (path_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

base::Status run_stc(const std::vector<std::string>& arguments, Messages messages) {
  base::Result<Child> child = start(tools::own_folder() + "/stc", arguments);
  if (!child.ok()) return child.error();
  Output output = sort_out(read_all(child->output.get()));
  int status = 0;
  while (::waitpid(child->pid, &status, 0) < 0) {
    if (errno != EINTR) return base::Error{base::Refusal::kInternal, "stc was lost"};
  }
  bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!good || messages == Messages::kShown) std::fputs(output.messages.c_str(), stderr);
  if (good) return base::Ok{};
  if (output.refusal) return *output.refusal;
  return base::Error{base::Refusal::kInternal, "stc failed without a reason"};
}

Sources sources_of(const tools::Options& options) {
  return {options.arguments(), options.text("--dialect")};
}

std::vector<std::string> stc_arguments(std::vector<std::string> command, const Sources& sources) {
  if (!sources.dialect.empty()) {
    command.push_back("--dialect");
    command.push_back(sources.dialect);
  }
  command.push_back("--");
  command.insert(command.end(), sources.paths.begin(), sources.paths.end());
  return command;
}

bool is_image(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  static const base::Bytes kMagic = [] {
    base::Bytes empty = ir::encode(ir::Image{});
    return base::Bytes(empty.begin(), empty.begin() + 8);
  }();
  return bytes.ok() && bytes->size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), bytes->begin());
}

base::Result<ir::VerifiedImage> load_program(const Sources& sources) {
  std::string path = sources.paths.front();
  base::Result<TemporaryFolder> folder = TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  if (sources.paths.size() != 1 || !is_image(path)) {
    path = folder->file("program.img");
    base::Status built = run_stc(stc_arguments({"build", "--quiet", "-o", path}, sources));
    if (!built.ok()) return built.error();
  }
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  if (!bytes.ok()) return bytes.error();
  return ir::verify(*bytes);
}

}  // namespace stvm
