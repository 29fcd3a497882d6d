// The control channel over a real socket, and peers that do not keep to it.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>

#include "vm/runtime/frames.h"
#include "vm/runtime/socket_client.h"
#include "vm/runtime/socket_server.h"

namespace vm {
namespace {

// Sends back what it gets; a request that is none ends the connection.
class EchoService : public Service {
 public:
  base::Bytes answer(base::ByteSpan bytes, bool& keep_open) override {
    base::Result<Request> request = decode_request(bytes);
    if (request.ok()) return encode_answer(bytes);
    keep_open = false;
    return encode_answer(request.error());
  }
};

class SocketTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string path = ::testing::TempDir() + "socket-XXXXXX";
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    directory_ = path;
    open(directory_);
  }
  void TearDown() override {
    server_.reset();
    std::filesystem::remove_all(directory_);
  }
  void open(const std::string& directory) {
    auto server = SocketServer::open(directory, service_);
    ASSERT_TRUE(server.ok()) << base::to_string(server.error());
    server_ = std::move(*server);
  }
  Descriptor raw_connection() const {
    Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::string path = directory_ + "/" + kSocketName;
    std::memcpy(address.sun_path, path.data(), path.size());
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    return socket;
  }

  std::string directory_;
  EchoService service_;
  std::unique_ptr<SocketServer> server_;
};

TEST_F(SocketTest, AnswersRequestsOfSeveralClients) {
  auto first = SocketClient::connect(directory_);
  auto second = SocketClient::connect(directory_);
  ASSERT_TRUE(first.ok() && second.ok());
  for (int i = 0; i < 20; ++i) {
    Request request{.command = Command::kUpload};
    request.data.assign(static_cast<size_t>(i) * 20'000, 5);
    base::Bytes bytes = encode(request);
    for (auto* client : {&*first, &*second}) {
      base::Result<base::Bytes> answer = (*client)->exchange(bytes);
      ASSERT_TRUE(answer.ok());
      EXPECT_EQ(*decode_answer(*answer), bytes);
    }
  }
}

TEST_F(SocketTest, IsForTheOwnerOnly) {
  struct stat info {};
  ASSERT_EQ(::stat((directory_ + "/" + kSocketName).c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600u);
}

TEST_F(SocketTest, NobodyThereIsOneClearError) {
  server_.reset();
  auto client = SocketClient::connect(directory_);
  ASSERT_FALSE(client.ok());
  EXPECT_EQ(client.error().refusal, base::Refusal::kNotRunning);
  EXPECT_EQ(SocketClient::connect(directory_ + "/none").error().refusal,
            base::Refusal::kNotRunning);
}

TEST_F(SocketTest, WorksInADirectoryWithAVeryLongName) {
  server_.reset();
  std::string deep = directory_ + "/" + std::string(150, 'd');
  std::filesystem::create_directory(deep);
  open(deep);
  auto client = SocketClient::connect(deep);
  ASSERT_TRUE(client.ok()) << base::to_string(client.error());
  EXPECT_TRUE((*client)->exchange(encode(Request{.command = Command::kStatus})).ok());
}

// Hostile bytes get an error or nothing, their connection ends, and others are served.
TEST_F(SocketTest, HostileBytesEndTheirConnectionOnly) {
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    Descriptor socket = raw_connection();
    base::Bytes noise(1 + random() % 200);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
    if (round % 2 == 0) noise = frame(noise);
    (void)!::send(socket.get(), noise.data(), noise.size(), MSG_NOSIGNAL);
    ::shutdown(socket.get(), SHUT_WR);
    uint8_t buffer[4096];
    while (::recv(socket.get(), buffer, sizeof buffer, 0) > 0) {
    }
  }
  auto client = SocketClient::connect(directory_);
  ASSERT_TRUE(client.ok());
  EXPECT_TRUE((*client)->exchange(encode(Request{.command = Command::kStatus})).ok());
}

TEST_F(SocketTest, ConnectionsThatSayNothingDoNotKeepOthersOut) {
  std::vector<Descriptor> silent;
  for (int i = 0; i < 8; ++i) silent.push_back(raw_connection());
  auto client = SocketClient::connect(directory_);
  ASSERT_TRUE(client.ok());
  EXPECT_TRUE((*client)->exchange(encode(Request{.command = Command::kStatus})).ok());
}

}  // namespace
}  // namespace vm
