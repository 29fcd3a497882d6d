// <NWL>, a ladder or a function block diagram of TwinCAT -> the model of networks. A network there
// is a list of trees: what is wired into a box or coil stands inside of it.
#pragma once

#include <optional>
#include <string>

#include "adapters/xml/document.h"
#include "frontend/network/network.h"

namespace twincat {

// nullopt, after reports (E1083): something of it has no meaning here. `what`: how messages call
// the body.
std::optional<frontend::network::Body> read_networks(xml::Node nwl, const std::string& what,
                                                     xml::Reporter& report);

}  // namespace twincat
