// Wires between the layers of a picture of boxes, and what stands in them.
#include <algorithm>

#include "frontend/draw/box_picture.h"

namespace frontend::draw {

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

}  // namespace frontend::draw
