// Diagrams as text: whole bodies.
#include <utility>

#include "adapters/plcopen/drawing.h"
#include "adapters/xml/diagram_text.h"
#include "base/name_case.h"
#include "frontend/fbd/read.h"
#include "frontend/network/same.h"

namespace plcopen {
namespace {

// Variables and actions that a body sees, between blanks.
std::string names_around(Node body) {
  std::string out;
  auto add = [&](Node list, const char* kind) {
    for (Node each : xml::children(list, kind)) {
      out += ' ' + std::string(xml::attribute(each, "name"));
    }
  };
  for (Node owner = body.parent(); owner; owner = owner.parent()) {
    add(xml::child(owner, "actions"), "action");
    Node interface = xml::child(owner, "interface");
    for (Node list : xml::children(interface)) add(list, "variable");
    if (interface) out += ' ' + xml::text_of(interface);  // as CODESYS keeps it
  }
  return out;
}

}  // namespace

bool add_all(Node body, Drawing& drawing, const std::string& name, Reporter& report) {
  bool good = true;
  for (Node node : xml::children(body)) {
    if (xml::is(node, "addData") || xml::is(node, "documentation")) continue;
    if (drawing.add(node)) continue;
    report.add(Code::kXmlBody, node,
               xml::shown(node) + " in the body of " + name + " is not understood");
    good = false;
  }
  return drawing.connect() && good;
}

std::string drawing_text(Drawing& drawing, Node at, const std::string& member, std::string elements,
                         Reporter& report) {
  network::Body made = drawing.body();
  if (drawing.failed()) return error_text("a drawing was not imported");
  if (made.networks.empty()) return {};
  const bool whole = member.empty() || base::same_name(member, report.pou());
  const std::string path = whole ? report.pou() : report.pou() + "." + member;
  xml::KeptDrawing& kept = report.out().kept.drawings[base::fold_name(path)];
  kept = {made, {}, report.origin(at) == at ? std::move(elements) : std::string()};
  xml::DiagramText out = xml::diagram_text(made, names_around(at), report.as_fbd(at));
  if (!out.rows.empty()) {
    base::Diagnostics unheard;
    kept.text = network::canonical(frontend::fbd::read(out.rows, base::SourcePos{0}, unheard));
  }
  return std::move(out.text);
}

std::string diagram_text(Node body, const std::string& name, Reporter& report) {
  Drawing drawing(xml::is(body, "LD"), report);
  if (!add_all(body, drawing, name, report) || drawing.failed()) {
    return error_text("the body of " + name + " was not imported");
  }
  std::string text =
      drawing_text(drawing, body, name.substr(name.rfind(' ') + 1), plain_xml(body), report);
  return drawing.failed() ? error_text("the body of " + name + " was not imported") : text;
}

}  // namespace plcopen
