// A connection to a broker of MQTT 3.1.1: messages to topics, and what comes on them. The broker is
// not trusted: whoever uses this checks what comes. Connections are kept by a thread of their own,
// which connects again where one is lost, with pauses that grow to half a minute.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/result.h"

namespace mqtt {

inline constexpr size_t kMostPayload = 1u << 20;  // bytes; what is longer is dropped
// Messages that nobody has taken yet, and their bytes: pieces of one file and what comes beside.
inline constexpr size_t kMostWaiting = 4096;
inline constexpr size_t kMostWaitingBytes = 96u << 20;
// What was published, and the broker has not said that it has it.
inline constexpr size_t kMostLeaving = 4096;
inline constexpr size_t kMostLeavingBytes = 256u << 20;

struct Message {
  std::string topic;
  base::Bytes payload;
  bool retained = false;  // of one that comes: the broker had it already
};

struct Event {
  enum class Kind : uint8_t { kConnected, kLost, kMessage };
  Kind kind = Kind::kMessage;
  Message message;
  std::string text;  // of kLost: why
};

// One connection. publish(), subscribe() and unsubscribe() may be called by any thread, wait() by
// one. What is published while there is no connection goes out when there is one; subscriptions
// end with the connection, and are made again by whoever hears kConnected.
class Broker {
 public:
  virtual ~Broker() = default;
  // At least once (QoS 1). `retained`: the broker keeps it for whoever subscribes later; an empty
  // payload takes that back. kNotRunning; kTooMany: it is too long, or the broker does not take
  // what was published before.
  virtual base::Status publish(const std::string& topic, base::ByteSpan payload, bool retained) = 0;
  virtual base::Status subscribe(const std::string& filter) = 0;
  virtual base::Status unsubscribe(const std::string& filter) = 0;
  // What has happened; nullopt: nothing for so long.
  virtual std::optional<Event> wait(int64_t ms) = 0;
  // What was published has left for the broker, and it has said so. False: not in that time.
  virtual bool flush(int64_t ms) = 0;
};

struct Settings {
  std::string url;          // "mqtts://host:port"; "mqtt://" to this machine only
  std::string ca;           // file of the certificates that are trusted; "": those of the machine
  std::string certificate;  // of this side, with `key`; "": none
  std::string key;
  std::string user;
  std::string password_file;    // its first line
  std::string client;           // its name at the broker; two of one name put each other out
  std::optional<Message> will;  // published by the broker when this connection is lost; retained
  int keep_alive_s = 30;
};

struct Address {
  std::string host;
  uint16_t port = 0;
  bool tls = true;
};
// kUsage: it is no such URL, or one without TLS to another machine.
base::Result<Address> parse_url(std::string_view url);

// With this build's library. It returns before there is a connection. kNoBroker: the build has no
// library; kUsage; kFileNotFound and its like: of the files that settings name.
base::Result<std::unique_ptr<Broker>> connect(const Settings& settings);

}  // namespace mqtt
