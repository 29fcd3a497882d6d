#include "tools/common/visible_errors.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <utility>

#include "base/visible_text.h"

namespace tools {
namespace {

constexpr size_t kWaitingLine = 4096;  // a longer one is shown in parts
constexpr uint32_t kMostAtEnd = 64;    // reads

}  // namespace

base::Result<std::unique_ptr<VisibleErrors>> VisibleErrors::make() {
  auto out = std::make_unique<VisibleErrors>();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return base::Error{base::Refusal::kInternal, "no pipe"};
  out->out_ = ends[0];
  out->in_ = ends[1];
  if (::pipe2(out->stop_, O_CLOEXEC) != 0) {
    return base::Error{base::Refusal::kInternal, "no pipe"};
  }
  return out;
}

void VisibleErrors::started() {
  ::close(std::exchange(in_, -1));
  sigset_t all;
  sigset_t before;
  sigfillset(&all);  // signals are the tool's own
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

VisibleErrors::~VisibleErrors() {
  if (stop_[1] >= 0) ::close(stop_[1]);
  if (thread_.joinable()) thread_.join();
  for (const int fd : {in_, out_, stop_[0]}) {
    if (fd >= 0) ::close(fd);
  }
}

void VisibleErrors::run() {
  pollfd wanted[2] = {{out_, POLLIN, 0}, {stop_[0], POLLIN, 0}};
  bool open = true;
  while (open && wanted[1].revents == 0) {
    if (::poll(wanted, 2, -1) < 0 && errno != EINTR) break;
    if (wanted[0].revents != 0) open = take();
  }
  ::fcntl(out_, F_SETFL, O_NONBLOCK);
  for (uint32_t i = 0; open && i < kMostAtEnd; ++i) open = take();
  if (!waits_.empty()) waits_ += '\n';  // what follows is not of this line
  show(waits_.size());
}

bool VisibleErrors::take() {
  char buffer[4096];
  const ssize_t n = ::read(out_, buffer, sizeof buffer);
  if (n < 0 && errno == EINTR) return true;
  if (n <= 0) return false;
  waits_.append(buffer, static_cast<size_t>(n));
  show(waits_.size() > kWaitingLine ? waits_.size() : waits_.rfind('\n') + 1);
  return true;
}

void VisibleErrors::show(size_t size) {
  std::string lines = waits_.substr(0, size);
  for (size_t at = 0; (at = lines.find("\r\n", at)) != lines.npos;) lines.erase(at, 1);  // of ssh
  const std::string text = base::visible_lines(lines);
  std::fwrite(text.data(), 1, text.size(), stderr);
  waits_.erase(0, size);
}

}  // namespace tools
