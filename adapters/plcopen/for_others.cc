#include "adapters/plcopen/for_others.h"

#include "frontend/network/write.h"

namespace plcopen {

frontend::network::Body for_others(frontend::network::Body body) {
  for (frontend::network::Network& each : body.networks) {
    if (!each.title.empty()) each.comments.insert(each.comments.begin(), each.title);
    if (!each.disabled) continue;
    frontend::network::Body alone{body.language, {}, {}};
    alone.networks.emplace_back().elements = each.elements;
    std::string text = frontend::network::write_ladder(alone, 0).value_or(std::string());
    if (text.empty()) text = frontend::network::write_fbd(alone, 0);
    each.comments.push_back("disabled:\n" + text);
    each.elements.clear();
  }
  return body;
}

}  // namespace plcopen
