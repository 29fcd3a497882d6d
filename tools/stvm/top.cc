// stvm top: a page that shows a controller, again and again. Plain ANSI, so it works over ssh.
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "tools/common/exit.h"
#include "tools/common/terminal.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/top_page.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kTopOptions[] = {
    tools::kIntervalOption,
    tools::kCountOption,
    STVM_CONTROLLER_OPTIONS,
};
constexpr tools::Command kTopCommand{
    "top",       "", "Shows tasks, devices, changes and alarms on a page that refreshes.",
    kTopOptions, 0,  0};

size_t from_environment(const char* name, size_t otherwise) {
  const char* text = std::getenv(name);
  const unsigned long value = text != nullptr ? std::strtoul(text, nullptr, 10) : 0;
  return value >= 20 && value <= 1000 ? value : otherwise;
}

TopView view_of_terminal() {
  TopView view;
  winsize size{};
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  if (terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= 20) {
    view.width = size.ws_col;
    view.height = size.ws_row;
  } else {
    view.width = from_environment("COLUMNS", 80);
    view.height = from_environment("LINES", 24);
  }
  view.color = tools::has_colour(STDOUT_FILENO);
  return view;
}

// A terminal of its own for as long as it lives: keys come one by one, and what was on the screen
// comes back. Without a terminal pages follow each other.
class Screen {
 public:
  Screen() : terminal_(isatty(STDOUT_FILENO) != 0), keys_(isatty(STDIN_FILENO) != 0) {
    if (terminal_) std::fputs("\x1b[?1049h\x1b[?25l", stdout);
    if (!keys_ || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Screen() {
    if (terminal_) std::fputs("\x1b[?25h\x1b[?1049l", stdout);
    std::fflush(stdout);
    if (keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // Line by line over what stood there, so that nothing flickers.
  void show(const std::string& page) const {
    if (!terminal_) {
      std::fputs(page.c_str(), stdout);
    } else {
      std::string text = "\x1b[H";
      for (size_t at = 0; at < page.size();) {
        const size_t end = page.find('\n', at);
        text += page.substr(at, end - at) + "\x1b[K";
        at = end + 1;
        if (at < page.size()) text += "\r\n";
      }
      std::fputs((text + "\x1b[J").c_str(), stdout);
    }
    std::fflush(stdout);
  }

  // Waits; false: the person wants to leave.
  bool wait(int ms) const {
    pollfd key{STDIN_FILENO, POLLIN, 0};
    if (!keys_) return poll(nullptr, 0, ms) >= 0 || !StopSignal::received();
    if (poll(&key, 1, ms) <= 0) return !StopSignal::received();
    char pressed = 0;
    return read(STDIN_FILENO, &pressed, 1) != 1 || (pressed != 'q' && pressed != 'Q');
  }

 private:
  bool terminal_;
  bool keys_;
  termios before_{};
};

base::Status top(const tools::Options& options) {
  base::Result<uint64_t> interval = options.number("--interval", 1000);
  if (!interval.ok()) return interval.error();
  base::Result<uint64_t> count = options.number("--count", UINT64_MAX);
  if (!count.ok()) return count.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> before = client->status();
  if (!before.ok()) return before.error();
  StopSignal::install();
  const Screen screen;
  const int pause_ms = static_cast<int>(std::min<uint64_t>(*interval, 3'600'000));
  if (*count != 0) screen.show(top_page(*before, *before, view_of_terminal()));
  for (uint64_t i = 1; i < *count && !StopSignal::received() && std::ferror(stdout) == 0; ++i) {
    if (!screen.wait(pause_ms)) break;
    base::Result<vm::StatusReport> now = client->status();
    if (!now.ok()) return now.error();
    screen.show(top_page(*before, *now, view_of_terminal()));
    before = std::move(now);
  }
  return base::Ok{};
}

int run_top(const tools::Options& options) {
  base::Status shown = top(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kTop{&kTopCommand, run_top};

}  // namespace stvm
