#include <algorithm>
#include <cmath>

#include "frontend/draw/box_picture.h"
#include "frontend/network/expressions.h"

namespace frontend::draw {

// A link that is written beside its pin.
bool BoxPicture::is_written(uint32_t element, Link link) const {
  Kind kind = network_.elements[link.element].kind;
  bool plain = kind == Kind::kSource || kind == Kind::kLeftRail;
  return link.element >= element || (plain && !sources_[link.element]);
}

// Nothing follows it in the rung.
bool BoxPicture::is_end(uint32_t element) const {
  for (const uint32_t users : users_[element]) {
    if (users > 0) return false;
  }
  return network::is_placed(network_.elements[element].kind);
}

void BoxPicture::rails(double top, double bottom, double right) {
  svg_.rail(kLeft, top, bottom);
  svg_.rail(right, top, bottom);
  for (const RailWire& wire : to_rail_) svg_.line(wire.x, wire.y, right, wire.y, wire.ink);
}

// Sources at an input where others arrive, too.
void BoxPicture::mark_sources() {
  sources_.assign(network_.elements.size(), false);
  for (const Element& element : network_.elements) users_.emplace_back(element.outputs.size());
  for (const Element& element : network_.elements) {
    for (const network::Input& input : element.inputs) {
      for (Link link : input.from) ++users_[link.element][link.output];
      if (input.from.size() < 2) continue;
      for (Link link : input.from) sources_[link.element] = true;
    }
  }
}

// Are all users of an output sinks? Then these are written beside it.
bool BoxPicture::is_attached(uint32_t element, uint32_t output) const {
  const std::vector<uint32_t>& sinks = sinks_.at(element, output);
  for (uint32_t sink : sinks) {
    if (network_.elements[sink].inputs[0].from.size() != 1) return false;
    if (network_.elements[sink].inputs[0].modifier > network::Modifier::kNegated) return false;
  }
  return !sinks.empty() && sinks.size() == users_[element][output];
}

void BoxPicture::find_nodes() {
  mark_sources();
  number_.assign(network_.elements.size(), network::kNoPin);
  for (uint32_t i = 0; i < network_.elements.size(); ++i) {
    const Element& element = network_.elements[i];
    if (element.kind == Kind::kRightRail) continue;
    bool plain = element.kind == Kind::kSource || element.kind == Kind::kLeftRail;
    if (plain && !sources_[i]) continue;
    if (element.kind == Kind::kSink && element.inputs[0].from.size() == 1) {
      Link from = element.inputs[0].from[0];
      bool of_box = network_.elements[from.element].kind == Kind::kBlock && from.element < i;
      if (of_box && is_attached(from.element, from.output)) continue;
    }
    add_node(i);
  }
}

void BoxPicture::connect(Node& node, const network::Input& input, uint32_t row) {
  for (Link link : input.from) {
    if (!is_written(node.element, link)) node.inputs.push_back({{link.element, link.output}, row});
  }
}

void BoxPicture::add_node(uint32_t i) {
  const Element& element = network_.elements[i];
  Node node;
  node.element = i;
  if (element.kind == Kind::kBlock) {
    std::vector<bool> attached;
    for (uint32_t pin = 0; pin < element.outputs.size(); ++pin) {
      attached.push_back(is_attached(i, pin));
    }
    node.box = make_box(network_, sinks_, i, attached,
                        {network::kNoPin, network::kNoPin, &look_, &power_, false});
    for (uint32_t row = 0; row < node.box->inputs.size(); ++row) {
      connect(node, element.inputs[node.box->inputs[row].pin], row);
    }
    node.up = node.box->up;
    node.down = node.box->down;
    node.left = node.box->before;
    node.right = node.box->before + node.box->width;
    node.width = node.right + node.box->behind;
  } else {
    bool plain = element.kind == Kind::kSource || element.kind == Kind::kLeftRail;
    if (!plain) {
      connect(node, element.inputs[0], 0);
      const auto& from = element.inputs[0].from;
      const bool rail =
          from.size() == 1 && network_.elements[from[0].element].kind == Kind::kLeftRail;
      node.powered = is_ladder() && rail && node.inputs.empty();
      if (from.size() == 1 && node.inputs.empty() && !node.powered) {
        node.operand =
            network::pin_value(element.inputs[0].modifier, written_operand(network_, from[0]));
      }
    }
    node.left = node.operand.empty() ? 0 : text_width(node.operand) + 6;
    if (plain || element.kind == Kind::kSink) {
      node.text =
          element.kind == Kind::kSink ? sink_text(element) : written_operand(network_, {i, 0});
      node.up = 9;
      node.down = 9;
      node.right = node.left + text_width(node.text) + (element.kind == Kind::kSink ? 24 : 4);
      if (element.kind == Kind::kSink) node.note = short_note(look_, element.operand.text);
    } else {
      node.symbol = make_symbol(element, look_);
      node.up = node.symbol->up;
      node.down = node.symbol->down;
      node.right = node.left + node.symbol->width;
    }
    node.width = node.right;
  }
  const bool acts = element.kind != Kind::kSource && element.kind != Kind::kLeftRail;
  if (!is_ladder() && acts) node.turn = ++turns_;
  number_[i] = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back(std::move(node));
}

void BoxPicture::find_layers() {
  for (Node& node : nodes_) {
    for (const auto& [net, row] : node.inputs) {
      node.layer = std::max(node.layer, nodes_[number_[net.first]].layer + 1);
    }
    if (layers_.size() <= node.layer) layers_.resize(node.layer + 1);
  }
  for (Node& node : nodes_) {
    if (is_ladder() && is_end(node.element)) node.layer = static_cast<uint32_t>(layers_.size()) - 1;
  }
  for (uint32_t n = 0; n < nodes_.size(); ++n) layers_[nodes_[n].layer].push_back(n);
}

void BoxPicture::add_lanes() {
  for (const Node& node : nodes_) {
    for (const auto& [net, row] : node.inputs) wired_[net] = std::max(wired_[net], node.layer);
  }
  for (const auto& [net, to] : wired_) {
    for (uint32_t layer = nodes_[number_[net.first]].layer + 1; layer < to; ++layer) {
      Node lane;
      lane.lane = true;
      lane.element = net.first;
      lane.net = net;
      lane.layer = layer;
      lane.up = lane.down = 3;
      lane.inputs.push_back({net, 0});
      layers_[layer].push_back(static_cast<uint32_t>(nodes_.size()));
      nodes_.push_back(std::move(lane));
    }
  }
  for (const std::vector<uint32_t>& layer : layers_) {
    double width = 0;
    for (uint32_t n : layer) width = std::max(width, nodes_[n].width);
    widths_.push_back(width);
  }
}

// Where its first wired pin would be as high as what it is linked to.
double BoxPicture::wanted(const Node& node) const {
  double sum = 0;
  uint32_t count = 0;
  for (const auto& [net, row] : node.inputs) {
    auto end = ends_.find(net);
    if (end == ends_.end()) continue;
    if (count == 0) sum = end->second.y - row * kPinRow;
    ++count;
  }
  return sum;
}

// Would a wire that arrives run into one of another net that leaves at the same height?
bool BoxPicture::touches_other(const Node& node) const {
  for (const auto& [net, row] : node.inputs) {
    double y = node.y + row * kPinRow;
    for (const auto& [other, end] : ends_) {
      if (std::abs(end.y - y) >= kNudge - 1) continue;
      const bool meets = std::any_of(node.inputs.begin(), node.inputs.end(), [&](const auto& in) {
        return in.first == other && in.second == row;
      });
      if (!meets) return true;
    }
  }
  return false;
}

double BoxPicture::place(uint32_t layer, double top) {
  std::vector<uint32_t>& order = layers_[layer];
  std::vector<double> want(nodes_.size());
  for (uint32_t n : order) want[n] = wanted(nodes_[n]);
  if (layer > 0) {
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return want[a] < want[b]; });
  }
  double bottom = top - kNodeGap;
  for (uint32_t n : order) {
    Node& node = nodes_[n];
    node.y = std::max(want[n], bottom + kNodeGap + node.up);
    for (int tries = 0; tries < 200 && touches_other(node); ++tries) node.y += kNudge;
    bottom = node.y + node.down;
  }
  return bottom;
}

double draw_boxes(Svg& svg, const network::Network& network, double y, const Look& look,
                  double rails) {
  const network::Network drawn = network::with_expression_boxes(network);
  return BoxPicture(svg, drawn, look, rails).run(y);
}

}  // namespace frontend::draw
