// stvm bridge: standard input and output as a connection to the controller of this machine. What
// `--host` runs over ssh.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "vm/runtime/socket_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kBridgeOptions[] = {STVM_DIR_OPTION};
constexpr tools::Command kBridgeCommand{
    "bridge",       "", "Connects its standard streams to the controller (what --host runs there).",
    kBridgeOptions, 0,  0};

// False: the other side is gone.
bool write_all(int fd, const char* bytes, size_t size) {
  while (size != 0) {
    const ssize_t n = ::write(fd, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes += n;
    size -= static_cast<size_t>(n);
  }
  return true;
}

// Follows the frames of a byte stream (vm/runtime/frames.h) without keeping them.
class FrameCounter {
 public:
  void add(const char* bytes, size_t size) {
    for (; size != 0; ++bytes, --size) {
      if (left_ != 0) {
        const size_t skipped = std::min<size_t>(left_, size);
        left_ -= static_cast<uint32_t>(skipped);
        bytes += skipped - 1;
        size -= skipped - 1;
      } else {
        length_ |= uint32_t{static_cast<uint8_t>(*bytes)} << (8 * header_);
        if (++header_ < sizeof length_) continue;
        left_ = std::exchange(length_, 0);
        header_ = 0;
      }
    }
  }
  bool between_frames() const { return left_ == 0 && header_ == 0; }

 private:
  uint32_t length_ = 0;
  uint32_t header_ = 0;  // bytes of the length that have come
  uint32_t left_ = 0;    // bytes of the message that are still to come
};

// False: nothing more will come.
bool pass_on(int from, int to, FrameCounter& frames) {
  char buffer[65536];
  const ssize_t n = ::read(from, buffer, sizeof buffer);
  if (n < 0 && errno == EINTR) return true;
  if (n <= 0 || !write_all(to, buffer, static_cast<size_t>(n))) return false;
  frames.add(buffer, static_cast<size_t>(n));
  return true;
}

base::Result<vm::Descriptor> connect(const std::string& directory) {
  return vm::SocketClient::open(directory, vm::SocketClient::For::kAnother);
}

// A controller ends connections that have asked nothing for long; the next request looks for it
// again. One that ends before it has answered, or in the middle of an answer, is gone.
base::Status relay(const std::string& directory, vm::Descriptor controller) {
  bool asked = false;
  FrameCounter requests;
  FrameCounter answers;
  for (;;) {
    pollfd ends[] = {{STDIN_FILENO, POLLIN, 0}, {controller.get(), POLLIN, 0}};
    if (::poll(ends, 2, -1) < 0 && errno != EINTR) return base::Ok{};
    if (ends[1].revents != 0) {
      const bool more = pass_on(controller.get(), STDOUT_FILENO, answers);
      if (!more && asked) return base::Ok{};
      if (!more) controller = {};
      asked = asked && !answers.between_frames();
    }
    if (ends[0].revents == 0) continue;
    if (!controller.valid()) {
      base::Result<vm::Descriptor> again = connect(directory);
      if (!again.ok()) return again.error();
      controller = std::move(*again);
    }
    if (!pass_on(STDIN_FILENO, controller.get(), requests)) return base::Ok{};
    asked = true;
  }
}

int run_bridge(const tools::Options& options) {
  base::Result<vm::Descriptor> socket = connect(state_directory(options));
  if (!socket.ok()) return refuse(socket.error());
  base::Status relayed = relay(state_directory(options), std::move(*socket));
  return relayed.ok() ? tools::kOk : refuse(relayed.error());
}

}  // namespace

const Entry kBridge{&kBridgeCommand, run_bridge};

}  // namespace stvm
