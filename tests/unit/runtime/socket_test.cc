// The control channel over a real socket, and peers that do not keep to it.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "vm/runtime/connection.h"
#include "vm/runtime/frames.h"
#include "vm/runtime/socket_client.h"
#include "vm/runtime/socket_peer.h"
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

bool is_served(const std::string& directory) {
  auto client = SocketClient::connect(directory);
  if (!client.ok()) return false;
  auto answer = (*client)->exchange(encode(Request{.command = Command::kStatus}));
  return answer.ok() && decode_answer(*answer).ok();
}

TEST_F(SocketTest, ConnectionsThatSayNothingDoNotKeepOthersOut) {
  std::vector<Descriptor> silent;
  for (size_t i = 0; i < 2 * kMaxConnections; ++i) silent.push_back(raw_connection());
  EXPECT_TRUE(is_served(directory_));
}

// The answer is there when the connection has been closed before the request is sent.
TEST_F(SocketTest, WhoGetsNoPlaceIsToldSo) {
  std::vector<std::unique_ptr<SocketClient>> others;
  for (size_t i = 0; i < kMaxConnections; ++i) {
    others.push_back(std::move(*SocketClient::connect(directory_)));
    ASSERT_TRUE(others.back()->exchange(encode(Request{.command = Command::kCancel})).ok());
  }
  auto client = SocketClient::connect(directory_);
  ASSERT_TRUE(client.ok());
  while (server_->accepts() <= kMaxConnections) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  auto answer = (*client)->exchange(encode(Request{.command = Command::kStatus}));
  ASSERT_TRUE(answer.ok()) << base::to_string(answer.error());
  EXPECT_EQ(decode_answer(*answer).error().refusal, base::Refusal::kBusy);
}

// The last place is for this machine, however many bridges there are.
TEST_F(SocketTest, BridgesLeaveAPlace) {
  std::vector<Descriptor> bridges;
  for (size_t i = 0; i < 3 * kMaxConnections; ++i) {
    auto bridge = SocketClient::open(directory_, SocketClient::For::kAnother);
    ASSERT_TRUE(bridge.ok());
    bridges.push_back(std::move(*bridge));
  }
  EXPECT_TRUE(is_served(directory_));
  EXPECT_TRUE(is_served(directory_));
}

// Without a descriptor for it, a peer is served all the same. A second one waits without being asked
// for again and again, until the first one is idle: it then gets that one's place, though there is no
// descriptor yet.
TEST_F(SocketTest, DescriptorsThatRunOutAreNoBusyLoop) {
  Descriptor first(::socket(AF_UNIX, SOCK_STREAM, 0));
  Descriptor second(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = directory_ + "/" + kSocketName;
  std::memcpy(address.sun_path, path.data(), path.size());
  const auto* const to = reinterpret_cast<const sockaddr*>(&address);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  std::vector<Descriptor> all;  // whatever is free below the limit
  rlimit low = before;
  low.rlim_cur = 64;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  for (;;) {
    Descriptor next(::dup(first.get()));
    if (!next.valid()) break;
    all.push_back(std::move(next));
  }
  ASSERT_EQ(::connect(first.get(), to, sizeof address), 0);
  ASSERT_EQ(::connect(second.get(), to, sizeof address), 0);
  auto client = SocketClient::over(std::move(first), "here");
  const auto begin = std::chrono::steady_clock::now();
  const uint64_t accepts = server_->accepts();
  constexpr int kRounds = 2000;  // each wakes the server, which sees that the second one waits
  for (int i = 0; i < kRounds; ++i) {
    ASSERT_TRUE(client->exchange(encode(Request{.command = Command::kUpload, .data = {1}})).ok());
  }
  const auto elapsed = std::chrono::steady_clock::now() - begin;
  const auto tries = static_cast<uint64_t>(elapsed / std::chrono::milliseconds(100));
  EXPECT_LE(server_->accepts() - accepts, 4 + tries);
  auto waiting = SocketClient::over(std::move(second), "here");
  EXPECT_TRUE(waiting->exchange(encode(Request{.command = Command::kStatus})).ok());
  EXPECT_FALSE(::dup(STDOUT_FILENO) >= 0) << "there was a descriptor";
  all.clear();
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

// A client that was idle for too long finds its controller again, but not in the middle of a
// request.
TEST_F(SocketTest, AnIdleClientConnectsAgain) {
  auto client = SocketClient::connect(directory_);
  ASSERT_TRUE(client.ok());
  EXPECT_TRUE((*client)->exchange(encode(Request{.command = Command::kStatus})).ok());
  server_.reset();  // ends its connections
  auto gone = (*client)->exchange(encode(Request{.command = Command::kStatus}));
  ASSERT_FALSE(gone.ok());
  EXPECT_EQ(gone.error().refusal, base::Refusal::kNotRunning);
  open(directory_);
  EXPECT_TRUE((*client)->exchange(encode(Request{.command = Command::kStatus})).ok());
}

constexpr uid_t kNobody = 65534;

TEST(Peer, IsRootOrOneself) {
  EXPECT_TRUE(is_trusted(0, 0, 0));
  EXPECT_TRUE(is_trusted(0, 1000, 0));
  EXPECT_TRUE(is_trusted(1000, 1000, 0));
  EXPECT_FALSE(is_trusted(1001, 1000, 0));
  EXPECT_FALSE(is_trusted(1000, 0, 0)) << "a socket that root did not make";
}

// a service has a user of its own; root's tools ask it in that user's folder.
TEST(Peer, R12_RootAsksWhomTheFolderBelongsTo) {
  EXPECT_TRUE(is_trusted(995, 0, 995));
  EXPECT_FALSE(is_trusted(996, 0, 995));
  EXPECT_FALSE(is_trusted(995, 1000, 995)) << "only root can do anything there anyway";
}

// Somebody else listens in `directory` while root connects there.
base::Status connect_to_another(const std::string& directory) {
  const std::string path = directory + "/" + kSocketName;
  int ready[2];
  EXPECT_EQ(::pipe(ready), 0);
  const pid_t other = ::fork();
  if (other == 0) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
    const bool listens =
        ::setuid(kNobody) == 0 &&
        ::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
        ::listen(listener, 4) == 0;
    (void)!::write(ready[1], listens ? "y" : "n", 1);
    ::pause();
    ::_exit(0);
  }
  char answer = 0;
  EXPECT_EQ(::read(ready[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  auto client = SocketClient::connect(directory);
  ::kill(other, SIGKILL);
  ::waitpid(other, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);
  if (client.ok()) return base::Ok{};
  return client.error();
}

// Neither side talks to another user, whatever the folder permits. Only root can be both.
TEST_F(SocketTest, OfAnotherUserIsNotTrusted) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs two users";
  server_.reset();
  std::filesystem::permissions(directory_, std::filesystem::perms::all);
  for (const uid_t owner : {uid_t{0}, kNobody}) {
    ASSERT_EQ(::chown(directory_.c_str(), owner, 0), 0);
    const base::Status connected = connect_to_another(directory_);
    ASSERT_FALSE(connected.ok()) << "anybody can have put the socket there";
    EXPECT_EQ(connected.error().refusal, base::Refusal::kNotRunning);
    EXPECT_NE(connected.error().text.find("is not trusted"), std::string::npos);
    std::filesystem::remove(directory_ + "/" + kSocketName);
  }
}

// a service of systemd runs as a user of its own, in that user's folder.
TEST_F(SocketTest, R12_RootTrustsWhoAloneWritesIntoTheFolder) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs two users";
  server_.reset();
  std::filesystem::permissions(directory_, std::filesystem::perms::owner_all);
  ASSERT_EQ(::chown(directory_.c_str(), kNobody, 0), 0);
  const base::Status connected = connect_to_another(directory_);
  EXPECT_TRUE(connected.ok()) << connected.error().text;
}

TEST_F(SocketTest, AnotherUserIsSentAway) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs two users";
  namespace fs = std::filesystem;
  const std::string path = directory_ + "/" + kSocketName;
  fs::permissions(directory_, fs::perms::all);
  fs::permissions(path, fs::perms::all);
  int result[2];
  ASSERT_EQ(::pipe(result), 0);
  const pid_t other = ::fork();
  if (other == 0) {  // system calls only: the server's thread is not here
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    char answer[200] = {};
    ssize_t size = -1;
    if (::setuid(65534) == 0 &&
        ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
      size = ::recv(socket, answer, sizeof answer, 0);
    }
    (void)!::write(result[1], answer, size > 0 ? static_cast<size_t>(size) : 1);
    ::_exit(0);
  }
  char answer[200] = {};
  const ssize_t size = ::read(result[0], answer, sizeof answer);
  ::waitpid(other, nullptr, 0);
  ::close(result[0]);
  ::close(result[1]);
  ASSERT_GT(size, 4);
  const base::Bytes message(answer + 4, answer + size);
  auto told = decode_answer(message);
  ASSERT_FALSE(told.ok());
  EXPECT_EQ(told.error().refusal, base::Refusal::kForeignPeer);
  EXPECT_TRUE(is_served(directory_));
}

// --- who has a place --------------------------------------------------------------

class Places : public ::testing::Test {
 protected:
  class Ends : public EchoService {
   public:
    void ended(uint64_t session) override { sessions.push_back(session); }
    std::vector<uint64_t> sessions;
  };
  bool add(bool bridged, std::chrono::seconds at, bool silent = false) {
    Connection connection;
    connection.bridged = bridged;
    connection.silent = silent;
    return connections_.add(connection, Instant() + at);
  }
  using seconds = std::chrono::seconds;
  Ends service_;
  Connections connections_{service_};
};

TEST_F(Places, TheLongestIdleMakesRoom) {
  for (size_t i = 0; i < kMaxConnections; ++i) EXPECT_TRUE(add(false, seconds(i)));
  connections_[0].active = Instant() + seconds(50);
  EXPECT_TRUE(add(false, seconds(60)));
  EXPECT_EQ(service_.sessions, std::vector<uint64_t>{2});
  EXPECT_EQ(connections_.size(), kMaxConnections);
}

TEST_F(Places, WhoIsBusyKeepsHis) {
  for (size_t i = 0; i < kMaxConnections; ++i) EXPECT_TRUE(add(false, seconds(0)));
  EXPECT_FALSE(add(false, seconds(0))) << "all have just come";
  for (size_t i = 0; i < kMaxConnections; ++i) connections_[i].out = {1};
  EXPECT_FALSE(add(false, seconds(5))) << "all wait for an answer";
  EXPECT_TRUE(service_.sessions.empty());
}

TEST_F(Places, WhoNeverAskedMakesRoomAtOnce) {
  for (size_t i = 0; i < kMaxConnections; ++i) EXPECT_TRUE(add(false, seconds(0), i == 5));
  EXPECT_TRUE(add(false, seconds(0)));
  EXPECT_EQ(service_.sessions, std::vector<uint64_t>{6});
  EXPECT_FALSE(add(false, seconds(0)));
}

// What only looks connects again by itself; what changes something has brought more than that.
TEST_F(Places, WatchersKeepNobodyOut) {
  for (size_t i = 0; i < kMaxConnections; ++i) EXPECT_TRUE(add(false, seconds(i / 8)));
  const auto ask = [&](Connection& row, Command command, seconds at) {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    row.socket = Descriptor(ends[0]);
    const Descriptor peer(ends[1]);
    const base::Bytes request = frame(encode(Request{.command = command}));
    ASSERT_GT(::send(peer.get(), request.data(), request.size(), 0), 0);
    EXPECT_TRUE(row.attend(POLLIN, service_, Instant() + at));
  };
  for (size_t i = 0; i < kMaxConnections; ++i) {
    ask(connections_[i], i == 15 ? Command::kUpload : Command::kGet, seconds(9));
  }
  connections_[14].bridged = true;
  EXPECT_FALSE(add(true, seconds(9)));
  EXPECT_TRUE(add(false, seconds(9)));
  EXPECT_EQ(service_.sessions, std::vector<uint64_t>{14});
  EXPECT_EQ(connections_[15].session, 17u);
  for (size_t i = 0; i < kMaxConnections; ++i) connections_[i].since = Instant() + seconds(9);
  EXPECT_FALSE(add(false, seconds(9))) << "all have just come";
}

TEST_F(Places, ABridgeTakesNoneFromThisMachine) {
  for (size_t i = 1; i < kMaxConnections; ++i) EXPECT_TRUE(add(i == 1, seconds(0)));
  EXPECT_TRUE(add(true, seconds(9))) << "in place of the other bridge";
  EXPECT_EQ(service_.sessions, std::vector<uint64_t>{1});
  EXPECT_FALSE(add(true, seconds(9)));
  EXPECT_TRUE(add(false, seconds(9))) << "the last place";
  EXPECT_EQ(connections_.size(), kMaxConnections);
}

// Its answer took longer than its patience, and does not fit into what the system buffers.
TEST_F(Places, NobodyPaysForTheTimeOfAnAnswer) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
  const Descriptor peer(ends[1]);
  Connection asker;
  asker.socket = Descriptor(ends[0]);
  asker.out = base::Bytes(1u << 20);
  ASSERT_TRUE(connections_.add(asker, Instant()));
  const Instant later = Instant() + 5 * Connections::kPatience;
  const pollfd said[] = {{ends[0], POLLOUT, POLLOUT}};
  EXPECT_TRUE(connections_.attend(said, std::atomic<bool>(false), later));
  ASSERT_EQ(connections_.size(), 1u);
  EXPECT_TRUE(connections_[0].sending());
  EXPECT_FALSE(connections_.attend(said, std::atomic<bool>(true), later));
  const pollfd nothing[] = {{ends[0], POLLOUT, 0}};
  EXPECT_TRUE(connections_.attend(nothing, std::atomic<bool>(false),
                                  later + Connections::kPatience + seconds(1)));
  EXPECT_EQ(connections_.size(), 0u) << "it does not read";
}

TEST_F(Places, IdleOnesEnd) {
  EXPECT_TRUE(add(false, seconds(0)));
  EXPECT_TRUE(add(false, seconds(0)));
  connections_[1].out = {1};
  connections_.end_overdue(Instant() + Connections::kPatience);
  EXPECT_EQ(connections_.size(), 2u);
  connections_.end_overdue(Instant() + Connections::kPatience + seconds(1));
  EXPECT_EQ(service_.sessions, std::vector<uint64_t>{2}) << "stopped in the middle";
  connections_.end_overdue(Instant() + Connections::kIdle);
  EXPECT_EQ(connections_.size(), 1u);
  connections_.end_overdue(Instant() + Connections::kIdle + seconds(1));
  EXPECT_EQ(connections_.size(), 0u);
}

// A byte now and then keeps nobody: the client goes before half of an answer of a minute has come.
TEST(SocketClientTest, AnAnswerThatDripsIsGivenUp) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  auto client = SocketClient::over(Descriptor(ends[0]), "here", 1);
  int sent = 0;
  std::thread peer([&] {
    const base::Bytes answer = frame(base::Bytes(600, 1));
    for (uint8_t byte : answer) {
      if (::send(ends[1], &byte, 1, MSG_NOSIGNAL) != 1) break;
      ++sent;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ::close(ends[1]);
  });
  const base::Bytes request = {1};
  const base::Result<base::Bytes> answer = client->exchange(request);
  peer.join();
  ASSERT_FALSE(answer.ok());
  EXPECT_EQ(answer.error().refusal, base::Refusal::kNotRunning);
  EXPECT_NE(answer.error().text.find("does not answer"), std::string::npos) << answer.error().text;
  EXPECT_LT(sent, 300);
}

}  // namespace
}  // namespace vm
