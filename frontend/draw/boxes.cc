// Boxes and wires: every element stands in the layer behind those that it is linked to; between
// two layers is a channel in which wires change their height, each on a track of its own. A link
// over several layers has a lane in each of those between. Links to what is executed later are
// written, not drawn. A bridge of ladder is drawn so, too: it hangs on the left rail, and its coils
// stand in the last layer, at the right rail.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "frontend/draw/pictures.h"
#include "frontend/draw/shapes.h"

namespace frontend::draw {

using network::Element;
using network::Kind;
using network::Link;

namespace {

constexpr double kNodeGap = 14;
constexpr double kTrack = 10;
constexpr double kChannelEnd = 12;  // wire between a track and a frame
constexpr double kNudge = 6;
constexpr double kRailGap = 16;
constexpr double kTurn = 19;  // from the first pin of a box up to its number

using Net = std::pair<uint32_t, uint32_t>;  // element and output

struct Target {
  uint32_t node = 0;
  uint32_t row = 0;  // of its inputs
};

struct Node {
  uint32_t element = 0;
  bool lane = false;
  Net net;  // of a lane
  uint32_t layer = 0;
  double y = 0;  // first pin
  double up = 0;
  double down = 0;
  double width = 0;
  double left = 0;   // of its frame in its width
  double right = 0;  // the same, other side
  std::optional<Box> box;
  std::optional<Symbol> symbol;
  bool powered = false;                          // a wire leads from the left rail to it
  uint32_t turn = 0;                             // in the order of execution; 0: not shown
  std::string note;                              // of a sink: address and comment
  std::string text;                              // of sources and sinks
  std::string operand;                           // in front of its only input
  std::vector<std::pair<Net, uint32_t>> inputs;  // nets and rows where they arrive
};

class BoxPicture {
 public:
  BoxPicture(Svg& svg, const network::Network& network, const Look& look, double rails)
      : svg_(svg),
        network_(network),
        look_(look),
        live_(look.live),
        rails_(rails),
        sinks_(network),
        power_(network, look.live) {}

  double run(double top) {
    find_nodes();
    find_layers();
    add_lanes();
    double x = is_ladder() ? kLeft + kRailGap : kLeft;
    double height = 0;
    for (uint32_t layer = 0; layer < layers_.size(); ++layer) {
      double bottom = place(layer, top);
      height = std::max(height, bottom - top);
      x = layer == 0 ? x : channel(layer - 1, x);
      ends_.clear();
      for (uint32_t n : layers_[layer]) draw(nodes_[n], x);
      for (uint32_t n : layers_[layer]) note_sources(nodes_[n], x);
      x += widths_[layer];
    }
    if (is_ladder()) rails(top, top + height, std::max(x + kRailGap, kLeft + rails_));
    return height;
  }

 private:
  struct RailWire {  // from an element to the right rail
    double x = 0;
    double y = 0;
    Ink ink = Ink::kPlain;
  };
  struct End {  // where a net leaves a layer
    double x = 0;
    double y = 0;
  };

  void find_nodes();
  void mark_sources();
  bool is_written(uint32_t element, Link link) const;
  bool is_attached(uint32_t element, uint32_t output) const;
  void add_node(uint32_t element);
  void connect(Node& node, const network::Input& input, uint32_t row);
  void find_layers();
  void add_lanes();
  double place(uint32_t layer, double top);
  double wanted(const Node& node) const;
  bool touches_other(const Node& node) const;
  double channel(uint32_t layer, double x);
  void draw(const Node& node, double x);
  void note_sources(const Node& node, double x);
  bool is_ladder() const { return rails_ > 0; }
  bool is_end(uint32_t element) const;
  void rails(double top, double bottom, double right);
  Ink power_ink() const { return live_ != nullptr ? Ink::kOn : Ink::kPlain; }
  Ink net_ink(Net net) const { return ink(power_.output({net.first, net.second})); }

  Svg& svg_;
  const network::Network& network_;
  const Look& look_;
  const Live* live_;
  double rails_;  // 0: there are none
  uint32_t turns_ = 0;
  std::vector<RailWire> to_rail_;
  network::Sinks sinks_;
  Power power_;
  std::vector<bool> sources_;                 // sources and rails that have a node of their own
  std::vector<std::vector<uint32_t>> users_;  // inputs at each output
  std::vector<uint32_t> number_;              // node of an element; kNoPin: none
  std::vector<Node> nodes_;
  std::vector<std::vector<uint32_t>> layers_;
  std::vector<double> widths_;
  std::map<Net, uint32_t> wired_;  // the last layer that a net reaches
  std::map<Net, End> ends_;        // of the nets that leave the layer drawn last
};

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

// Wires from `layer` to the next one; returns where that one begins.
double BoxPicture::channel(uint32_t layer, double x) {
  struct Way {
    Net net;
    End from;
    std::vector<double> to;
    double low = 0;
    double high = 0;
    uint32_t track = 0;
  };
  std::map<Net, Way> ways;
  std::map<double, std::vector<Net>> arrivals;  // by height
  for (uint32_t n : layers_[layer + 1]) {
    const Node& node = nodes_[n];
    for (const auto& [net, row] : node.inputs) {
      auto end = ends_.find(net);
      if (end == ends_.end()) continue;
      Way& way = ways[net];
      way.net = net;
      way.from = end->second;
      way.to.push_back(node.y + row * kPinRow);
      arrivals[way.to.back()].push_back(net);
    }
  }
  std::vector<Way*> bent;
  for (auto& [net, way] : ways) {
    std::sort(way.to.begin(), way.to.end());
    way.low = std::min(way.from.y, way.to.front());
    way.high = std::max(way.from.y, way.to.back());
    if (way.low < way.high) bent.push_back(&way);
  }
  std::sort(bent.begin(), bent.end(), [](const Way* a, const Way* b) {
    return a->low != b->low ? a->low < b->low : a->net < b->net;
  });
  std::vector<double> tracks;  // how far down each is in use
  for (Way* way : bent) {
    while (way->track < tracks.size() && tracks[way->track] + kNudge > way->low) ++way->track;
    if (way->track == tracks.size()) tracks.push_back(0);
    tracks[way->track] = way->high;
  }
  double begin = x + kChannelEnd;
  double end = begin + static_cast<double>(tracks.size()) * kTrack + kChannelEnd;
  for (const auto& [net, way] : ways) {
    Ink colour = net_ink(net);
    double at = begin + way.track * kTrack;
    if (way.low < way.high) svg_.line(at, way.low, at, way.high, colour);
    svg_.line(way.from.x, way.from.y, way.low < way.high ? at : end, way.from.y, colour);
    bool through = false;
    for (double y : way.to) {
      if (way.low < way.high) svg_.line(at, y, end, y, colour);
      through = through || y == way.from.y;
      if (y != way.from.y && y > way.low && y < way.high) svg_.dot(at, y, colour);
    }
    bool inside = way.from.y > way.low && way.from.y < way.high;
    if (way.low < way.high && (through || inside)) svg_.dot(at, way.from.y, colour);
  }
  // Where several nets arrive, they meet: the last one at the track that is next to the pin.
  for (const auto& [y, nets] : arrivals) {
    if (nets.size() < 2) continue;
    double at = 0;
    Truth power = Truth::kFalse;
    for (const Net& net : nets) {
      const Way& way = ways[net];
      if (way.low < way.high) at = std::max(at, begin + way.track * kTrack);
      power = any(power, power_.output({net.first, net.second}));
    }
    if (at > 0) svg_.dot(at, y, ink(power));
    if (at > 0 && live_ != nullptr) svg_.line(at, y, end, y, ink(power));
  }
  return end;
}

void BoxPicture::draw(const Node& node, double x) {
  for (const auto& [net, row] : node.inputs) {
    double y = node.y + row * kPinRow;
    double to = node.lane ? x : x + node.left;
    if (to > x) svg_.line(x, y, to, y, net_ink(net));
  }
  if (node.lane) return;
  if (node.powered) svg_.line(kLeft, node.y, x, node.y, power_ink());
  if (node.box) {
    if (node.turn != 0) {
      svg_.text(x + node.right + 4, node.y - kTurn, std::to_string(node.turn), Type::kNote);
    }
    return draw_box(svg_, *node.box, x, node.y);
  }
  double left = x + node.left;
  if (!node.operand.empty()) svg_.text(x, node.y + 4, node.operand);
  const Element& element = network_.elements[node.element];
  if (node.symbol) {
    Ink in = element.inputs.empty() ? Ink::kPlain : ink(power_.input(element.inputs[0]));
    Ink out = element.outputs.empty() ? in : net_ink({node.element, 0});
    if (node.turn != 0) {
      svg_.text(x + node.width + 2, node.y - 4, std::to_string(node.turn), Type::kNote);
    }
    const bool passes_on = is_ladder() && is_end(node.element) && !element.outputs.empty();
    if (passes_on) to_rail_.push_back({left + node.symbol->width, node.y, out});
    return draw_symbol(svg_, *node.symbol, left, node.symbol->width, node.y, in, out);
  }
  if (element.kind == Kind::kSink) {
    network::Input plain = element.inputs[0];
    plain.modifier = network::Modifier::kNone;
    Ink in = ink(power_.input(plain));
    svg_.line(left, node.y, left + 18, node.y, in);
    bool ring = node.operand.empty() && element.inputs[0].modifier == network::Modifier::kNegated;
    if (ring) svg_.ring(left + 4, node.y, 4);
    svg_.arrow_right(left + 20, node.y, in);
    svg_.text(left + 24, node.y + 4, node.text);
    double behind = left + 32 + text_width(node.text);
    auto beside = [&](const std::string& text, Type type) {
      svg_.text(behind, node.y + 4, text, type);
      if (!text.empty()) behind += text_width(text, type) + 8;
    };
    beside(live_ != nullptr ? live_->shown(element.operand.text) : "", Type::kValue);
    beside(node.note, Type::kNote);
    if (node.turn != 0) beside(std::to_string(node.turn), Type::kNote);
    return;
  }
  svg_.text(left, node.y + 4, node.text);
}

// Where its outputs leave it; a lane hands on what it got.
void BoxPicture::note_sources(const Node& node, double x) {
  if (node.lane) {
    ends_[node.net] = {x, node.y};
    svg_.line(x, node.y, x + widths_[node.layer], node.y, net_ink(node.net));
    ends_[node.net].x = x + widths_[node.layer];
    return;
  }
  const Element& element = network_.elements[node.element];
  for (uint32_t pin = 0; pin < element.outputs.size(); ++pin) {
    double y = node.y + (node.box ? pin * kPinRow : 0);
    if (wired_.count({node.element, pin}) != 0) ends_[{node.element, pin}] = {x + node.right, y};
  }
}

}  // namespace

double draw_boxes(Svg& svg, const network::Network& network, double y, const Look& look,
                  double rails) {
  return BoxPicture(svg, network, look, rails).run(y);
}

}  // namespace frontend::draw
