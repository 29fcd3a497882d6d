// <action> of an action block: how a step uses it.
#include <algorithm>

#include "adapters/plcopen/reader.h"

namespace plcopen {

std::string action_use(Node action, const std::string& name, Reporter& report) {
  static constexpr const char* kQualifiers[] = {"N",  "R",  "S",  "L",  "D", "P",
                                                "P0", "P1", "SD", "DS", "SL"};
  std::string qualifier(xml::trimmed(xml::attribute(action, "qualifier")));
  if (qualifier.empty()) qualifier = "N";
  const bool known = std::any_of(std::begin(kQualifiers), std::end(kQualifiers),
                                 [&](const char* each) { return qualifier == each; });
  if (!known) {
    report.add(Code::kXmlBadValue, action, "`" + qualifier + "` is no action qualifier",
               "known are N R S L D P P0 P1 SD DS SL");
  }
  std::string out = name + "(" + qualifier;
  std::string time(xml::trimmed(xml::attribute(action, "duration")));
  const bool timed = qualifier == "L" || qualifier == "D" || qualifier.size() == 2;
  if (!time.empty() && timed && qualifier[0] != 'P') {
    const bool bare = time[0] >= '0' && time[0] <= '9';
    if (bare) time = "T#" + time;
    if (is_plain_operand(time)) {
      out += ", " + time;
    } else {
      report.add(Code::kXmlBadValue, action, "duration `" + time + "` is neither time nor variable",
                 "write it like T#5s");
    }
  }
  std::string indicator(xml::trimmed(xml::attribute(action, "indicator")));
  if (!indicator.empty() && !is_plain_operand(indicator)) {
    report.add(Code::kXmlBadValue, action, "indicator `" + indicator + "` is no variable");
  } else if (!indicator.empty()) {
    out += ", " + indicator;
  }
  return out + ");";
}

bool is_negated(Node node, Reporter& report) {
  const std::string text(xml::attribute(node, "negated"));
  const std::optional<bool> value = xml::boolean(text);
  if (!text.empty() && !value) {
    report.add(Code::kXmlBadValue, node, "negated=\"" + text + "\" is neither true nor false");
  }
  return value.value_or(false);
}

}  // namespace plcopen
