// <SFC>, a chart of TwinCAT -> steps and transitions as text. A chart there is a list in which
// steps and transitions alternate; a branch is one element with a list for each of its ways.
#pragma once

#include <string>

#include "adapters/xml/chart_attributes.h"
#include "adapters/xml/document.h"

namespace twincat {

// Empty, after reports (E1082, E1083), when something of it does not come in. `object`: the POU,
// whose <Transition>s conditions may name.
std::string chart_text(xml::Node sfc, xml::Node object, const std::string& what,
                       xml::Reporter& report);
xml::OwnActions own_actions(xml::Node sfc);

}  // namespace twincat
