// C9: in the middle of an answer that takes long, the server sees that its asker has gone, and what
// others ask that cannot wait; what can is answered behind it. Over a real socket; nothing waits for
// time, only for what the other side does.
#include <gtest/gtest.h>

#include <sys/socket.h>
#include <sys/un.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "vm/runtime/descriptor.h"
#include "vm/runtime/frames.h"
#include "vm/runtime/mailbox.h"
#include "vm/runtime/socket_client.h"
#include "vm/runtime/socket_server.h"

namespace vm {
namespace {

base::Bytes text(const char* words) {
  const std::string all = words;
  return {all.begin(), all.end()};
}

// A switch takes until somebody aborts it, or its asker has gone.
class LongService : public Service {
 public:
  base::Bytes answer(base::ByteSpan bytes, bool&) override {
    base::Result<Request> request = decode_request(bytes);
    if (!request.ok()) return encode_answer(request.error());
    if (request->command != Command::kSwitch) return encode_answer(text("behind"));
    begun = true;
    while (!aborted && !alone) meanwhile();
    ++ended_switches;
    return encode_answer(text("aborted"));
  }
  std::optional<base::Bytes> answer_urgent(const std::string&, base::ByteSpan bytes) override {
    base::Result<Request> request = decode_request(bytes);
    if (!request.ok() || request->command != Command::kAbort) return std::nullopt;
    aborted = true;
    return encode_answer(text("done"));
  }
  void asker_left() override { alone = true; }

  std::atomic<bool> begun{false};
  std::atomic<bool> aborted{false};
  std::atomic<bool> alone{false};
  std::atomic<int> ended_switches{0};
};

class Meanwhile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string path = ::testing::TempDir() + "meanwhile-XXXXXX";
    ASSERT_NE(::mkdtemp(path.data()), nullptr);
    directory_ = path;
    auto server = SocketServer::open(directory_, service_);
    ASSERT_TRUE(server.ok()) << base::to_string(server.error());
    server_ = std::move(*server);
  }
  void TearDown() override {
    server_.reset();
    std::filesystem::remove_all(directory_);
  }
  base::Bytes ask(Transport& client, Command command) {
    base::Result<base::Bytes> answer = client.exchange(encode(Request{.command = command}));
    if (!answer.ok()) return {};
    base::Result<base::Bytes> body = decode_answer(*answer);
    return body.ok() ? *body : base::Bytes();
  }
  void wait_until_begun() const {
    while (!service_.begun) std::this_thread::yield();
  }

  std::string directory_;
  LongService service_;
  std::unique_ptr<SocketServer> server_;
};

TEST_F(Meanwhile, C9_SomebodyElseEndsIt) {
  auto asker = SocketClient::connect(directory_);
  auto known = SocketClient::connect(directory_);
  ASSERT_TRUE(asker.ok() && known.ok());
  base::Bytes answer;
  std::thread asking([&] { answer = ask(**asker, Command::kSwitch); });
  wait_until_begun();
  base::Bytes held;
  std::thread patient([&] { held = ask(**known, Command::kStatus); });
  auto newcomer = SocketClient::connect(directory_);
  ASSERT_TRUE(newcomer.ok());
  EXPECT_EQ(ask(**newcomer, Command::kAbort), text("done"));
  asking.join();
  patient.join();
  EXPECT_EQ(answer, text("aborted"));
  EXPECT_EQ(held, text("behind")) << "what can wait is answered behind it";
  EXPECT_EQ(ask(**newcomer, Command::kStatus), text("behind"));
}

TEST_F(Meanwhile, C9_ItsAskerHasGone) {
  const std::string path = directory_ + "/" + kSocketName;
  // One that ends in the middle of its question's answer, as Ctrl-C ends a tool.
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const base::Bytes request = frame(encode(Request{.command = Command::kSwitch}));
  ASSERT_EQ(::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(request.size()));
  wait_until_begun();
  EXPECT_FALSE(service_.alone);
  ::shutdown(socket.get(), SHUT_RDWR);
  while (service_.ended_switches == 0) std::this_thread::yield();
  EXPECT_TRUE(service_.alone);
}

// Who waits for a boundary is asked whether it is still worth it; meanwhile the job cannot begin.
TEST(Mailbox, C9_AWaitThatNobodyWantsAnyMoreEnds) {
  Mailbox mailbox;
  int asked = 0;
  bool ran = false;
  mailbox.give_up = [&] {
    mailbox.serve();
    EXPECT_FALSE(ran);
    return ++asked == 3;
  };
  EXPECT_EQ(mailbox.run([&] { ran = true; }, INT64_C(1'000'000'000'000)),
            Mailbox::Outcome::kTimeout);
  EXPECT_EQ(asked, 3);
  mailbox.serve();
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace vm
