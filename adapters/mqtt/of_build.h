// The broker's connection of this build, or the word that it has none.
#pragma once

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

}  // namespace mqtt
