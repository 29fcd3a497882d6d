#include "adapters/plcopen/reader.h"

namespace plcopen {
namespace {

std::string parts_text(Node node, bool named, Reporter& report) {
  std::string out;
  for (Node part : xml::children(node, "value")) {
    std::string text = value_text(part, report);
    std::string_view times = xml::attribute(part, "repetitionValue");
    if (named) {
      text = std::string(report.required_name(part, "member")) + " := " + text;
    } else if (!times.empty() && times != "1") {
      if (times.find_first_not_of("0123456789") != std::string_view::npos) {
        report.add(Code::kXmlBadValue, part,
                   "repetitionValue `" + std::string(times) + "` is no number");
      }
      text = std::string(times) + "(" + text + ")";
    }
    out += (out.empty() ? "" : ", ") + text;
  }
  return out;
}

}  // namespace

std::string value_text(Node value, Reporter& report) {
  Node node = xml::first_element(value);
  if (!node) return {};
  if (xml::is(node, "simpleValue")) {
    return std::string(xml::trimmed(xml::attribute(node, "value")));
  }
  if (xml::is(node, "arrayValue")) return "[" + parts_text(node, false, report) + "]";
  if (xml::is(node, "structValue")) return "(" + parts_text(node, true, report) + ")";
  report.add(Code::kXmlBadValue, node, xml::shown(node) + " is no value");
  return {};
}

}  // namespace plcopen
