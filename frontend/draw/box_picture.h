// The inside of draw_boxes (pictures.h): where the boxes of a network stand, and its wires.
// Boxes and wires: every element stands in the layer behind those that it is linked to; between
// two layers is a channel in which wires change their height, each on a track of its own. A link
// over several layers has a lane in each of those between. Links to what is executed later are
// written, not drawn. A bridge of ladder is drawn so, too: it hangs on the left rail, and its coils
// stand in the last layer, at the right rail.
#pragma once

#include <map>
#include <optional>

#include "frontend/draw/pictures.h"
#include "frontend/draw/shapes.h"

namespace frontend::draw {

using network::Element;
using network::Kind;
using network::Link;

inline constexpr double kNodeGap = 14;
inline constexpr double kTrack = 10;
inline constexpr double kChannelEnd = 12;  // wire between a track and a frame
inline constexpr double kNudge = 6;
inline constexpr double kRailGap = 16;
inline constexpr double kTurn = 19;  // from the first pin of a box up to its number

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

}  // namespace frontend::draw
