// <addData> of steps, transitions and jumps, as CODESYS writes it: attributes by their ids.
#include "adapters/plcopen/reader.h"

namespace plcopen {

bool is_chart_data(Node data) { return xml::attribute(data, "name").ends_with("/sfc/element"); }

xml::ChartAttributes chart_attributes(Node element, Reporter* report) {
  xml::ChartAttributes out;
  for (Node data : vendor_parts(element)) {
    if (!is_chart_data(data)) continue;
    for (Node each : xml::children(xml::child(data, "attributes"), "attribute")) {
      out.add(xml::attribute(each, "guid"), xml::text_of(each), each, report);
    }
  }
  return out;
}

bool is_chart_of_codesys(Node pou) {
  for (Node body : xml::children(pou, "body")) {
    for (Node chart : xml::children(body, "SFC")) {
      for (Node step : xml::children(chart, "step")) {
        for (Node data : vendor_parts(step)) {
          if (is_chart_data(data)) return true;
        }
      }
    }
  }
  return false;
}

xml::OwnActions own_actions(Node pou) {
  xml::OwnActions out;
  for (Node body : xml::children(pou, "body")) {
    for (Node chart : xml::children(body, "SFC")) {
      for (Node step : xml::children(chart, "step")) out.add(chart_attributes(step, nullptr));
      for (Node block : xml::children(chart, "actionBlock")) {
        for (Node action : xml::children(block, "action")) {
          const std::string_view name = xml::attribute(xml::child(action, "reference"), "name");
          if (!name.empty()) out.add_usual(name);
        }
      }
    }
  }
  return out;
}

}  // namespace plcopen
