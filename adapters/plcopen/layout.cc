// Places for a drawing that has none: inputs left of what uses them, networks below each other.
#include "adapters/plcopen/layout.h"

#include <algorithm>
#include <limits>

#include "adapters/plcopen/geometry.h"
#include "frontend/network/order.h"

namespace plcopen {

namespace network = frontend::network;
using network::Element;
using network::Kind;
using network::Link;

namespace {

Extent extent_of(const Element& element) {
  if (element.kind == Kind::kContact || element.kind == Kind::kCoil) return kContactExtent;
  if (element.kind == Kind::kLeftRail || element.kind == Kind::kRightRail) return kRailExtent;
  if (element.kind != Kind::kBlock) {
    return extent_of_text(static_cast<int>(std::min<size_t>(element.operand.text.size(), 400)));
  }
  size_t in = 0;
  for (const network::Input& input : element.inputs) in = std::max(in, input.name.size());
  size_t out = 0;
  for (const network::Output& output : element.outputs) out = std::max(out, output.name.size());
  return extent_of_box(static_cast<int>(std::min<size_t>(in + out, 400)),
                       static_cast<int>(std::min<size_t>(element.type.text.size(), 400)),
                       std::max(element.inputs.size(), element.outputs.size()));
}

}  // namespace

// Columns by the longest way from an input, rows one below the other.
Layout lay_out(const network::Network& network, int32_t top, bool by_order) {
  const size_t count = network.elements.size();
  std::vector<Place> out(count);
  std::vector<size_t> column(count, 0);
  std::vector<int32_t> row(count, 0);
  std::vector<int32_t> wide;  // by column
  std::vector<int32_t> free;  // by column
  int32_t bottom = top;
  for (size_t i = 0; i < count; ++i) {
    int32_t y = std::numeric_limits<int32_t>::max();  // the highest of what feeds it
    for (const network::Input& input : network.elements[i].inputs) {
      for (Link link : input.from) {
        if (link.element >= i) continue;
        column[i] = std::max(column[i], column[link.element] + 1);
        y = std::min(y, row[link.element]);
      }
    }
    if (y == std::numeric_limits<int32_t>::max()) y = top;
    const size_t at = column[i];
    if (free.size() <= at) free.resize(at + 1, top);
    if (wide.size() <= at) wide.resize(at + 1, 0);
    const Extent extent = extent_of(network.elements[i]);
    wide[at] = std::max(wide[at], extent.width);
    y = by_order ? top + 50 * static_cast<int32_t>(i) : std::max(y, free[at]);
    row[i] = y;
    // The first pins of a row are on one line.
    const bool box = network.elements[i].kind == Kind::kBlock;
    out[i].y = by_order || box ? y : y + kFirstPin - pin_of(extent);
    free[at] = out[i].y + extent.height + 30;
    bottom = std::max(bottom, free[at]);
  }
  std::vector<int32_t> left = {20};        // of each column
  constexpr int32_t kFar = 1'000'000'000;  // what is deeper stands there, one over the other
  for (int32_t each : wide) {
    left.push_back(std::min(left.back() + (by_order ? 150 : each + 60), kFar));
  }
  for (size_t i = 0; i < count; ++i) out[i].x = left[column[i]];
  return {std::move(out), bottom};
}

bool acts(Kind kind) {
  return kind == Kind::kCoil || kind == Kind::kSink || kind == Kind::kBlock ||
         kind == Kind::kJump || kind == Kind::kReturn;
}

bool in_order(const network::Network& network, const std::vector<Place>& at, bool with_contacts) {
  network::Network probe = network;
  for (size_t i = 0; i < at.size(); ++i) {
    probe.elements[i].position = {at[i].x, at[i].y, 0, 0, true};
    probe.elements[i].order = 0;
    probe.elements[i].id = i;
  }
  uint64_t last = 0;
  for (network::Part& part : network::split(probe, {})) {
    if (!network::order(part.network, {}).empty()) return false;
    for (const Element& element : part.network.elements) {
      if (!acts(element.kind) && !(with_contacts && element.kind == Kind::kContact)) continue;
      if (element.id < last) return false;
      last = element.id;
    }
  }
  return true;
}

}  // namespace plcopen
