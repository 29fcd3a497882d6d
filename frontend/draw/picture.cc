#include "frontend/draw/picture.h"

#include <algorithm>
#include <optional>

#include "base/wrapped.h"
#include "frontend/draw/pictures.h"
#include "frontend/draw/shapes.h"
#include "frontend/network/expressions.h"

namespace frontend::draw {

namespace {

constexpr double kLineHeight = 17;
constexpr double kMinWidth = 480;
constexpr size_t kCommentColumns = 100;
constexpr double kMaxCoil = 200;  // what is wider does not move the coils of other rungs

// Lines of a comment, those of a text of any length.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (size_t begin = 0; begin <= text.size();) {
    size_t end = std::min(text.find('\n', begin), text.size());
    out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

double heading(Svg& svg, const network::Network& network, size_t number, double y) {
  std::string head = std::to_string(number);
  svg.text(kLeft, y + 12, head, Type::kBold);
  double x = kLeft + text_width(head) + 12;
  if (!network.label.empty()) {
    svg.text(x, y + 12, network.label.text + ':', Type::kBold);
    x += text_width(network.label.text) + 20;
  }
  double at = y;
  if (!network.title.empty() || network.disabled) {
    svg.text(x, y + 12, network.title, Type::kBold);
    if (!network.title.empty()) x += text_width(network.title) + 14;
    if (network.disabled) svg.text(x, y + 12, "disabled", Type::kNote);
    at += kLineHeight;
    x = kLeft + text_width(head) + 12;
  }
  auto comment = [&](const std::string& text) {
    for (const std::string& paragraph : lines_of(text)) {
      for (const std::string& line : base::wrapped(paragraph, kCommentColumns)) {
        svg.text(x, at + 12, line, Type::kComment);
        at += kLineHeight;
      }
    }
  };
  for (const std::string& text : network.comments) comment(text);
  for (const network::Element& element : network.elements) {
    for (const std::string& text : element.comments) comment(text);
  }
  return std::max(at, y + kLineHeight) + 4;
}

// Nothing flows through what is disabled.
Look look_at(const network::Network& network, Look look) {
  if (network.disabled) look.live = nullptr;
  return look;
}

}  // namespace

std::vector<std::string> variables(const network::Body& body) {
  std::vector<std::string> out;
  for (const network::Network& network : body.networks) {
    for (const network::Element& element : network.elements) {
      if (element.kind == network::Kind::kBlock && !element.operand.empty()) {
        for (const network::Output& output : element.outputs) {
          out.push_back(element.operand.text + '.' + output.name);
        }
      } else if (element.kind != network::Kind::kJump) {
        const std::string text =
            network::operand_with(element, [](const network::Input&) { return std::string("0"); });
        for (std::string& path : variables_in(text)) out.push_back(std::move(path));
      }
    }
  }
  return out;
}

std::string draw_body(const network::Body& body, std::string_view title, const Look& look) {
  Svg svg;
  svg.text(kLeft, 28, title, Type::kTitle);
  const bool ladder = body.language == network::Language::kLadder;
  std::vector<std::optional<Rung>> rungs;
  double width = kMinWidth;
  double coil = 0;  // room for the last one of each rung: they stand below each other
  for (const network::Network& network : body.networks) {
    std::optional<network::Placement> placement;
    if (ladder) placement = network::place(network);
    rungs.emplace_back();
    if (!placement) continue;
    rungs.back().emplace(network, std::move(*placement), look_at(network, look));
    if (rungs.back()->coil() <= kMaxCoil) coil = std::max(coil, rungs.back()->coil());
  }
  for (std::optional<Rung>& rung : rungs) {
    if (!rung) continue;
    rung->widen_coil(coil);
    width = std::max(width, rung->width());
  }
  double y = 46;
  for (size_t n = 0; n < body.networks.size(); ++n) {
    const network::Network& network = body.networks[n];
    y = heading(svg, network, n + 1, y);
    bool empty = true;
    for (const network::Element& element : network.elements) {
      empty = empty && !network::is_placed(element.kind) && element.kind != network::Kind::kSink;
    }
    if (empty) continue;
    if (network.disabled) svg.begin_disabled();
    if (rungs[n]) {
      rungs[n]->draw(svg, y, width);
      y += rungs[n]->height() + 22;
    } else {
      y += draw_boxes(svg, network, y, look_at(network, look), ladder ? width : 0) + 22;
    }
    if (network.disabled) svg.end_disabled();
  }
  return svg.finish(title);
}

}  // namespace frontend::draw
