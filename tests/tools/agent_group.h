// For agents.cc: some hundred agents in a process of their own, each with a controller.
// libmosquitto waits by select(), which knows 1,024 descriptors, and each connection has three.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "adapters/mqtt/broker.h"
#include "online_change/package/signed_file.h"

namespace agents_bench {

inline constexpr const char* kPrefix = "bench";
inline constexpr size_t kMostOfGroup = 250;

struct Place {
  std::string mosquitto;
  std::string folder;
  std::string url;
  std::string source;
  std::string fleet_file;
};

inline std::string controller_name(size_t number) { return "plc" + std::to_string(number); }

base::Result<std::unique_ptr<mqtt::Broker>> connect_to(const Place& place,
                                                       const std::string& client,
                                                       std::optional<mqtt::Message> will);
uint64_t resident_kb(int pid);

// What all agents of a group have sent and got since they began.
struct Traffic {
  uint64_t messages = 0;
  uint64_t bytes = 0;
  uint64_t agents_kb = 0;  // memory that connecting them took
};

// The controllers with numbers from `begin` to `end`, and their agents. Each call waits until it is
// done.
class GroupProcess {
 public:
  GroupProcess(const Place& place, const online_change::PublicKey& key, size_t begin, size_t end);
  ~GroupProcess();
  GroupProcess(const GroupProcess&) = delete;
  GroupProcess& operator=(const GroupProcess&) = delete;

  void connect() { ask('c'); }
  // Every second one is away, and comes again.
  void cut_half() { ask('-'); }
  void connect_half() { ask('+'); }
  Traffic traffic() { return ask('t'); }
  // Each edit was made once and accepted once, whatever the network did.
  void check_journals() { ask('j'); }

 private:
  Traffic ask(char what);

  pid_t pid_ = -1;
  int channel_ = -1;
};

}  // namespace agents_bench
