#include "adapters/plcopen/for_others.h"

#include "frontend/network/write.h"

namespace plcopen {

frontend::network::Body for_others(frontend::network::Body body) {
  for (frontend::network::Network& each : body.networks) {
    if (!each.disabled) continue;
    frontend::network::Body alone{body.language, {}, {}};
    alone.networks.emplace_back().elements = each.elements;
    std::string text = frontend::network::write_ladder(alone, 0).value_or(std::string());
    if (text.empty()) text = frontend::network::write_fbd(alone, 0);
    each.comments.push_back(std::string(kDisabledMark) + text);
    each.elements.clear();
  }
  return body;
}

void report_heads(const frontend::network::Body& body, base::Diagnostics& diagnostics) {
  for (const frontend::network::Network& each : body.networks) {
    if (each.title.empty() && !each.disabled) continue;
    return diagnostics.add(base::DiagnosticCode::kXmlLeftOut, each.span,
                           "titles of networks, and networks that are disabled, are comments in "
                           "IEC 61131-10, and stay comments when they are read again");
  }
}

}  // namespace plcopen
