#include "tests/unit/mqtt/false_broker.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/check.h"

namespace {

constexpr uint8_t kConnect = 1;
constexpr uint8_t kPublish = 3;
constexpr uint8_t kPuback = 4;
constexpr uint8_t kOnce = 0x02;  // QoS 1
constexpr uint16_t kSeen = 7;    // the number of the message that the client confirms

}  // namespace

FalseBroker::FalseBroker() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  base::check(listener_ >= 0 && ::bind(listener_, any, size) == 0 && ::listen(listener_, 1) == 0 &&
                  ::getsockname(listener_, any, &size) == 0,
              "a port of the own machine is listened on");
  port_ = ntohs(address.sin_port);
}

FalseBroker::~FalseBroker() {
  if (client_ >= 0) ::close(client_);
  ::close(listener_);
}

void FalseBroker::welcome() {
  client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  base::check(client_ >= 0, "a client comes");
  base::check(receive().head >> 4 == kConnect, "a client begins with CONNECT");
  const uint8_t accepted[] = {0x20, 2, 0, 0};
  write(accepted);
}

void FalseBroker::send(const std::string& topic, base::ByteSpan payload) {
  write_publish(kPublish << 4, topic, 0, payload);
}

void FalseBroker::send_and_hear() {
  write_publish(kPublish << 4 | kOnce, "seen", kSeen, {});
  while (receive().head >> 4 != kPuback) {
  }
}

FalseBroker::Published FalseBroker::next_published() {
  for (;;) {
    const Packet packet = receive();
    if (packet.head >> 4 != kPublish) continue;
    const size_t length = size_t{packet.body[0]} << 8 | packet.body[1];
    const auto* const text = reinterpret_cast<const char*>(packet.body.data()) + 2;
    const uint8_t* const behind = packet.body.data() + 2 + length;
    return {std::string(text, length), packet.body.size() - length - 4,
            static_cast<uint16_t>(behind[0] << 8 | behind[1])};
  }
}

void FalseBroker::acknowledge(uint16_t number) {
  const uint8_t bytes[] = {kPuback << 4, 2, static_cast<uint8_t>(number >> 8),
                           static_cast<uint8_t>(number)};
  write(bytes);
}

FalseBroker::Packet FalseBroker::receive() {
  Packet packet;
  receive_exactly(&packet.head, 1);
  size_t length = 0;
  for (int shift = 0;; shift += 7) {
    uint8_t more = 0;
    receive_exactly(&more, 1);
    length |= size_t{more & 0x7fu} << shift;
    if (more < 0x80) break;
  }
  packet.body.resize(length);
  receive_exactly(packet.body.data(), length);
  return packet;
}

void FalseBroker::receive_exactly(uint8_t* to, size_t count) {
  while (count > 0) {
    const ssize_t got = ::recv(client_, to, count, 0);
    base::check(got > 0, "the client is there");
    to += got;
    count -= static_cast<size_t>(got);
  }
}

void FalseBroker::write(base::ByteSpan bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    base::check(sent > 0, "the client is there");
    bytes = bytes.subspan(static_cast<size_t>(sent));
  }
}

void FalseBroker::write_publish(uint8_t head, const std::string& topic, uint16_t number,
                                base::ByteSpan payload) {
  base::Bytes bytes{head};
  const bool numbered = (head & kOnce) != 0;
  size_t length = 2 + topic.size() + (numbered ? 2 : 0) + payload.size();
  for (; length >= 0x80; length >>= 7) bytes.push_back(static_cast<uint8_t>(length | 0x80));
  bytes.push_back(static_cast<uint8_t>(length));
  bytes.push_back(static_cast<uint8_t>(topic.size() >> 8));
  bytes.push_back(static_cast<uint8_t>(topic.size()));
  bytes.insert(bytes.end(), topic.begin(), topic.end());
  if (numbered) {
    bytes.push_back(static_cast<uint8_t>(number >> 8));
    bytes.push_back(static_cast<uint8_t>(number));
  }
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  write(bytes);
}
