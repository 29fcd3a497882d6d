// A broker of MQTT 3.1.1 that says to one client whatever a test wants: it keeps to the protocol's
// form and to nothing else. Blocks; each call fails the test when the client is gone.
#pragma once

#include <cstdint>
#include <string>

#include "base/bytes.h"

class FalseBroker {
 public:
  FalseBroker();  // listens on a port of the own machine that is free
  ~FalseBroker();
  FalseBroker(const FalseBroker&) = delete;
  FalseBroker& operator=(const FalseBroker&) = delete;

  std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }
  // Waits for a client and takes it.
  void welcome();
  // Without a word of the client's.
  void send(const std::string& topic, base::ByteSpan payload);
  // The client has had everything that was sent before, and this, on the topic "seen".
  void send_and_hear();
  // The next message of the client's, of which it is told that it came (or not).
  struct Published {
    std::string topic;
    size_t size = 0;
    uint16_t number = 0;
  };
  Published next_published();
  void acknowledge(uint16_t number);

 private:
  struct Packet {
    uint8_t head = 0;
    base::Bytes body;
  };
  Packet receive();
  void receive_exactly(uint8_t* to, size_t count);
  void write(base::ByteSpan bytes);
  void write_publish(uint8_t head, const std::string& topic, uint16_t number,
                     base::ByteSpan payload);

  int listener_ = -1;
  int client_ = -1;
  uint16_t port_ = 0;
};
