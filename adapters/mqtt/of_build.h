// The broker's connection of this build, or the word that it has none.
#pragma once

#include <string>
#include <vector>

#include "adapters/mqtt/broker.h"

namespace mqtt {

inline base::Result<std::unique_ptr<Broker>> connect_in_this_build(const Settings& settings) {
#ifdef STC_HAS_MQTT
  return connect(settings);
#else
  return base::Error{base::Refusal::kNoBroker,
                     settings.url +
                         ": this program was built without libmosquitto (package "
                         "libmosquitto-dev)"};
#endif
}

// As `--version` names it.
inline std::vector<std::string> adapters_of_this_build() {
#ifdef STC_HAS_MQTT
  return {"mqtt"};
#else
  return {};
#endif
}

}  // namespace mqtt
