// Where the broker is, of a fleet or of one agent: the table [broker] of fleet.toml, or of a file
// that has nothing else.
//
//   [broker]
//   url = "mqtts://broker:8883"
//   ca = "/etc/stvm/ca.pem"            # else the certificates of the machine
//   user = "line1"                     # with password_file; or certificate and key
//   prefix = "plant"                   # of all topics; "stc"
//   files = "https://files/fleet"      # agents get files there; else over the broker
//   files_folder = "/srv/fleet"        # and the tool puts them here
#pragma once

#include <memory>

#include "adapters/mqtt/broker.h"
#include "tools/common/toml.h"

namespace stvm {

using ConnectBroker = base::Result<std::unique_ptr<mqtt::Broker>> (*)(const mqtt::Settings&);

struct FleetBroker {
  mqtt::Settings settings;  // without client and will
  std::string prefix = "stc";
  std::string files;
  std::string files_folder;
};

// Is a key one of that table?
bool is_broker_key(const std::string& key);
// Mistakes with line and column (kBadProject), also where there is no such table.
base::Result<FleetBroker> parse_broker(const std::string& file, const std::string& text);
base::Result<FleetBroker> read_broker(const std::string& file);
// The table again, for a list of those who are left.
std::string broker_text(const FleetBroker& broker);

}  // namespace stvm
