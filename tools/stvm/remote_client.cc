#include "tools/stvm/remote_client.h"

#include "tools/common/ssh.h"

namespace stvm {
namespace {

// One word for the shell of the other side, whatever is in it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

base::Result<std::unique_ptr<RemoteClient>> RemoteClient::connect(const std::string& host,
                                                                  const std::string& directory,
                                                                  uint32_t patience_s) {
  std::string command = "stvm bridge";
  if (!directory.empty()) command += " --dir " + quoted(directory);
  base::Result<std::vector<std::string>> ssh = tools::ssh_command(host, command);
  if (!ssh.ok()) return ssh.error();
  base::Result<tools::ConnectedChild> child =
      tools::ConnectedChild::start(*ssh, tools::ConnectedChild::Errors::kVisible);
  if (!child.ok()) return child.error();
  auto client =
      vm::SocketClient::over(vm::Descriptor(child->take_socket()), "on " + host, patience_s);
  return std::make_unique<RemoteClient>(std::move(*child), std::move(client));
}

base::Result<base::Bytes> RemoteClient::exchange(base::ByteSpan request) {
  base::Result<base::Bytes> answer = client_->exchange(request);
  if (!answer.ok() && answer.error().refusal == base::Refusal::kNotRunning) {
    child_.end();
    child_.wait();  // what ssh says about it stands in front of the error
  }
  return answer;
}

}  // namespace stvm
