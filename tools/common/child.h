// Another program as a child: the tool beside this one, or ssh.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "tools/common/visible_errors.h"

namespace tools {

enum class Messages : uint8_t { kShown, kOnlyOfFailure };
// Runs TOOL of the own folder ("stc", "stvm"). Its messages go to stderr, its refusal comes back as
// the error.
base::Status run_beside(const std::string& tool, const std::vector<std::string>& arguments,
                        Messages messages = Messages::kShown);

// Runs `program` (looked up in PATH) with both its standard streams on one socket. Ends it with the
// connection.
class ConnectedChild {
 public:
  enum class Errors : uint8_t { kOwn, kVisible };  // standard error: ours, or made visible there
  static base::Result<ConnectedChild> start(const std::vector<std::string>& command,
                                            Errors errors = Errors::kOwn);
  ConnectedChild(ConnectedChild&& other) noexcept;
  ConnectedChild& operator=(ConnectedChild&&) = delete;
  ~ConnectedChild();  // waits for its end
  // The exit code of the child, once it has ended; -1 when it was killed. What it wrote to its
  // standard error is shown.
  int wait();
  // Asks it to end, as a terminal does; it need not wait for what it is waiting for.
  void end();
  // Our end of the socket, once; the caller owns it.
  int take_socket();

 private:
  ConnectedChild(int pid, int socket) : pid_(pid), socket_(socket) {}
  int pid_ = -1;
  int socket_ = -1;
  std::unique_ptr<VisibleErrors> errors_;  // goes last
};

// Messages of any bytes between a tool and its child, over their socket. Each is a u32 length and
// as many bytes. kNotRunning when the other side is gone.
base::Status send_message(int socket, base::ByteSpan message);
base::Result<base::Bytes> receive_message(int socket);

// A folder for intermediate files that goes when its owner goes. A process that is killed cannot
// take it along: the next one that makes a folder does.
class TemporaryFolder {
 public:
  static base::Result<TemporaryFolder> make();
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  TemporaryFolder(std::string path, int mark) : path_(std::move(path)), mark_(mark) {}
  std::string path_;
  int mark_ = -1;  // locked for as long as the process lives
};

}  // namespace tools
