#include "tests/differential/isolated.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace differential {
namespace {

// Of a machine that is busy with others, for a second of processor time.
constexpr unsigned kSecondsOfWaiting = 60;

void write_text(int to, const std::string& text) {
  for (size_t at = 0; at < text.size();) {
    ssize_t done = ::write(to, text.data() + at, text.size() - at);
    if (done <= 0) _exit(3);
    at += static_cast<size_t>(done);
  }
}

std::string read_all(int from) {
  std::string out;
  char buffer[4096];
  for (ssize_t got; (got = ::read(from, buffer, sizeof buffer)) > 0;) {
    out.append(buffer, static_cast<size_t>(got));
  }
  return out;
}

// Fields separated by a byte that no text has.
constexpr char kSeparator = '\x01';

std::string packed(const Finding& finding) {
  std::string out = finding.failed ? "1" : "0";
  for (const std::string& field :
       {finding.key, finding.text, finding.trap, std::to_string(finding.scan), finding.expected}) {
    out += kSeparator + field;
  }
  return out;
}

Finding unpacked(const std::string& text) {
  std::vector<std::string> fields(1);
  for (char c : text) {
    if (c == kSeparator) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  fields.resize(6);
  return {fields[0] == "1",
          fields[1],
          fields[2],
          fields[3],
          std::strtoull(fields[4].c_str(), nullptr, 10),
          fields[5]};
}

}  // namespace

Finding isolated(const std::function<Finding()>& check, unsigned seconds) {
  Finding lost{true, "no child process", "cannot start a process", {}, 0, {}};
  int ends[2];
  if (::pipe(ends) != 0) return lost;
  pid_t child = ::fork();
  if (child < 0) return lost;
  if (child == 0) {
    ::close(ends[0]);
    const rlimit limit{seconds, seconds + 1};
    ::setrlimit(RLIMIT_CPU, &limit);
    ::alarm(kSecondsOfWaiting * seconds);
    write_text(ends[1], packed(check()));
    _exit(0);
  }
  ::close(ends[1]);
  std::string text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    std::string name = ::strsignal(WTERMSIG(status));
    return {true, "signal " + name, "ended by " + name, {}, 0, {}};
  }
  return unpacked(text);
}

}  // namespace differential
