// Titles, comments and labels of a drawing, and networks that are disabled -> heads of networks.
#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "adapters/plcopen/drawing.h"
#include "frontend/fbd/read.h"
#include "frontend/ladder/read.h"
#include "frontend/network/head.h"

namespace plcopen {

using network::Element;
using network::Kind;

// Each is shown by a comment (plcopen.h, kDisabledData).
std::vector<Drawing::Inserted> Drawing::disabled_networks(const std::vector<int32_t>& ends) {
  std::vector<Inserted> out;
  for (const Remark& remark : remarks_) {
    if (!remark.disabled) continue;
    const bool last = ends.empty() || remark.y > ends.back();
    Inserted made{
        last ? ends.size() : network::place_between(ends, remark.y), remark.row, {}, true};
    const std::string text = xml::text_of(remark.disabled);
    base::Diagnostics unheard;  // nobody looks at what is disabled
    network::Body body = xml::attribute(remark.disabled, "language") == "LADDER"
                             ? frontend::ladder::read(text, base::SourcePos{0}, unheard)
                             : frontend::fbd::read(text, base::SourcePos{0}, unheard);
    if (!body.networks.empty()) made.network.elements = std::move(body.networks[0].elements);
    made.network.disabled = true;
    made.network.headed = true;
    out.push_back(std::move(made));
  }
  return out;
}

std::optional<network::Text> Drawing::place_remark(Remark& remark, network::Network& own) {
  if (remark.title && own.title.empty()) {
    own.title = network::title_of(remark.text);
    own.headed = own.headed || !own.title.empty();
  } else if (!remark.label) {
    own.comments.push_back(std::move(remark.text));
  } else {
    const bool has_one = !own.label.empty();
    network::Text before = std::exchange(own.label, network::Text{std::move(remark.text), {}});
    if (has_one) return before;
  }
  return std::nullopt;
}

void Drawing::place_remarks(const std::vector<network::Part>& parts, network::Body& body) {
  const std::vector<int32_t> ends = network::ends_of(parts);
  std::vector<Inserted> inserted = disabled_networks(ends);
  std::map<int32_t, size_t> rows;  // what stands beside the comment of a disabled network is its
  for (size_t i = 0; i < inserted.size(); ++i) rows.emplace(inserted[i].y, i);
  for (Remark& remark : remarks_) {
    if (remark.disabled) continue;
    const auto insert_label = [&](size_t before, network::Text label) {
      inserted.push_back({before, remark.row, {}});
      inserted.back().network.label = std::move(label);
    };
    const auto row = rows.find(remark.row);
    if (row != rows.end()) {
      auto above = place_remark(remark, inserted[row->second].network);
      if (above) insert_label(inserted[row->second].before, *std::move(above));
      continue;
    }
    // A label below everything is the end of the body.
    if (remark.label && !ends.empty() && remark.y > ends.back()) {
      insert_label(ends.size(), {std::move(remark.text), {}});
      continue;
    }
    if (body.networks.empty()) body.networks.emplace_back();
    const size_t below = network::place_between(ends, remark.y);
    auto above = place_remark(remark, body.networks[below]);
    if (above) insert_label(below, *std::move(above));
  }
  std::ranges::stable_sort(inserted, [](const Inserted& a, const Inserted& b) {
    return std::tuple(a.before, a.y, a.disabled) < std::tuple(b.before, b.y, b.disabled);
  });
  std::vector<network::Network> all;
  auto next = inserted.begin();
  for (size_t i = 0; i <= body.networks.size(); ++i) {
    const bool last = i == body.networks.size();
    for (; next != inserted.end() && (last || next->before <= i); ++next) {
      all.push_back(std::move(next->network));
    }
    if (!last) all.push_back(std::move(body.networks[i]));
  }
  body.networks = std::move(all);
}

bool Drawing::does_something(const network::Network& part) {
  return std::any_of(part.elements.begin(), part.elements.end(), [](const Element& element) {
    return element.kind == Kind::kCoil || element.kind == Kind::kSink ||
           element.kind == Kind::kBlock || element.kind == Kind::kJump ||
           element.kind == Kind::kReturn;
  });
}

// Networks without effect have no text; what stands in front of them belongs to the next.
void Drawing::drop_idle(network::Body& body) {
  std::vector<network::Network> kept;
  std::vector<std::string> comments;
  for (network::Network& part : body.networks) {
    part.comments.insert(part.comments.begin(), comments.begin(), comments.end());
    comments.clear();
    if (!does_something(part) && (!part.disabled || part.elements.empty())) {
      part.elements.clear();
      if (part.label.empty()) {
        if (!part.title.empty()) part.comments.insert(part.comments.begin(), part.title);
        comments = std::move(part.comments);
        continue;
      }
    }
    kept.push_back(std::move(part));
  }
  if (!comments.empty()) {
    kept.emplace_back();
    kept.back().comments = std::move(comments);
  }
  // In text a title ends the network above, and so does whatever follows below it.
  bool below = false;
  for (network::Network& part : kept) {
    part.headed = part.headed || (below && part.label.empty());
    below = part.headed;
  }
  body.networks = std::move(kept);
}

}  // namespace plcopen
