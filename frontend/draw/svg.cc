#include "frontend/draw/svg.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "frontend/lex/characters.h"
#include "frontend/network/element_text.h"
#include "ir/types/utf.h"

namespace frontend::draw {

namespace {

constexpr double kMargin = 16;

constexpr const char* kStyle =
    "svg{--g:#fff;--i:#1a1f26;--m:#5b6673;--f:#f3f5f8;--on:#0a7d33;--of:#9aa5b1}\n"
    "@media(prefers-color-scheme:dark){svg{--g:#14181d;--i:#dde3ea;--m:#93a0ad;--f:#1f262e;"
    "--on:#3ddc74;--of:#5c6873}}\n"
    ".g{fill:#fff;fill:var(--g)}\n"
    ".l,.k,.r{stroke:#1a1f26;stroke:var(--i);stroke-width:1.4;fill:none}\n"
    ".k{stroke-width:2.6}\n"
    ".r{stroke-width:3}\n"
    ".b{stroke:#1a1f26;stroke:var(--i);stroke-width:1.4;fill:#f3f5f8;fill:var(--f)}\n"
    ".d{fill:#1a1f26;fill:var(--i)}\n"
    ".on{stroke:#0a7d33;stroke:var(--on);stroke-width:3}\n"
    ".of{stroke:#9aa5b1;stroke:var(--of)}\n"
    ".d.on,text.on{fill:#0a7d33;fill:var(--on);stroke:none}\n"
    ".d.of,text.of{fill:#9aa5b1;fill:var(--of);stroke:none}\n"
    "text{font:12px monospace;fill:#1a1f26;fill:var(--i);white-space:pre}\n"
    ".tb{font-weight:bold}\n"
    ".ts{font-size:11px}\n"
    ".tc{font:italic 12px sans-serif;fill:#5b6673;fill:var(--m)}\n"
    ".tt{font:bold 15px sans-serif}\n"
    ".tv{font-size:11px;fill:#0a7d33;fill:var(--on)}\n"
    ".tn{font:11px sans-serif;fill:#5b6673;fill:var(--m)}\n"
    ".x{opacity:.5}\n"
    ".x .l{stroke-dasharray:5 4}\n";

std::string number(double value) {
  double rounded = std::round(value * 10) / 10;
  char buffer[32];
  bool whole = rounded == std::floor(rounded);
  std::snprintf(buffer, sizeof buffer, whole ? "%.0f" : "%.1f", rounded);
  return buffer;
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + number(value) + '"';
}

std::string style(const char* base, Ink ink) {
  const char* state = ink == Ink::kOn ? " on" : ink == Ink::kOff ? " of" : "";
  return std::string(" class=\"") + base + state + '"';
}

// XML has no characters below the blank but tab and line ends, which a line of text has not.
std::string escaped(std::string_view text) {
  bool utf8 = network::is_utf8(text);
  std::string out;
  for (char c : text) {
    auto byte = static_cast<uint8_t>(c);
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += ' ';
    } else if (byte >= 0x80 && !utf8) {
      out += ir::utf8(byte);
    } else {
      out += c;
    }
  }
  return out;
}

const char* type_class(Type type) {
  switch (type) {
    case Type::kMono:
      return "";
    case Type::kBold:
      return "tb";
    case Type::kSmall:
      return "ts";
    case Type::kComment:
      return "tc";
    case Type::kTitle:
      return "tt";
    case Type::kValue:
      return "tv";
    case Type::kNote:
      return "tn";
  }
  return "";
}

double column_width(Type type) {
  switch (type) {
    case Type::kSmall:
    case Type::kValue:
      return 6.7;
    case Type::kComment:
      return 6.6;
    case Type::kNote:
      return 6.1;
    case Type::kTitle:
      return 9;
    default:
      return 7.3;
  }
}

}  // namespace

double text_columns(std::string_view text) {
  if (!network::is_utf8(text)) return static_cast<double>(text.size());
  double columns = 0;
  while (!text.empty()) {
    ir::Utf8Character c = ir::read_utf8(text);
    columns += c.code >= 0x1100 && c.code != 0x2026 ? 2 : 1;
    text.remove_prefix(c.bytes);
  }
  return columns;
}

double text_width(std::string_view text, Type type) {
  return text_columns(text) * column_width(type);
}

void Svg::grow(double x, double y) {
  width_ = std::max(width_, x);
  height_ = std::max(height_, y);
}

void Svg::begin_disabled() { body_ += "<g class=\"x\">\n"; }
void Svg::end_disabled() { body_ += "</g>\n"; }

void Svg::line(double x1, double y1, double x2, double y2, Ink ink) {
  body_ += "<line" + style("l", ink) + attribute("x1", x1) + attribute("y1", y1) +
           attribute("x2", x2) + attribute("y2", y2) + "/>\n";
  grow(std::max(x1, x2), std::max(y1, y2));
}

void Svg::thick_line(double x1, double y1, double x2, double y2, Ink ink) {
  body_ += "<line" + style("k", ink) + attribute("x1", x1) + attribute("y1", y1) +
           attribute("x2", x2) + attribute("y2", y2) + "/>\n";
  grow(std::max(x1, x2), std::max(y1, y2));
}

void Svg::rail(double x, double y1, double y2) {
  body_ += "<line class=\"r\"" + attribute("x1", x) + attribute("y1", y1) + attribute("x2", x) +
           attribute("y2", y2) + "/>\n";
  grow(x, y2);
}

void Svg::rect(double x, double y, double width, double height, Ink ink) {
  body_ += "<rect" + style("b", ink) + attribute("x", x) + attribute("y", y) +
           attribute("width", width) + attribute("height", height) + "/>\n";
  grow(x + width, y + height);
}

void Svg::dot(double x, double y, Ink ink) {
  body_ += "<circle" + style("d", ink) + attribute("cx", x) + attribute("cy", y) +
           attribute("r", 3) + "/>\n";
  grow(x + 3, y + 3);
}

void Svg::ring(double x, double y, double radius) {
  body_ += "<circle class=\"b\"" + attribute("cx", x) + attribute("cy", y) +
           attribute("r", radius) + "/>\n";
  grow(x + radius, y + radius);
}

void Svg::arrow_down(double x, double y, Ink ink) {
  body_ += "<path" + style("d", ink) + " d=\"M" + number(x) + ' ' + number(y) + "l-4 -8h8z\"/>\n";
  grow(x + 4, y);
}

void Svg::arrow_right(double x, double y, Ink ink) {
  body_ += "<path" + style("d", ink) + " d=\"M" + number(x) + ' ' + number(y) + "l-8 -4v8z\"/>\n";
  grow(x, y + 4);
}

void Svg::arc(double x, double y, double height, bool left, Ink ink) {
  double half = height / 2;
  body_ += "<path" + style("l", ink) + " d=\"M" + number(x) + ' ' + number(y - half) + 'Q' +
           number(left ? x - 8 : x + 8) + ' ' + number(y) + ' ' + number(x) + ' ' +
           number(y + half) + "\"/>\n";
  grow(x + 8, y + half);
}

void Svg::text(double x, double y, std::string_view text, Type type, Anchor anchor, Ink ink) {
  if (text.empty()) return;
  double width = text_width(text, type);
  std::string classes = type_class(type);
  const char* state = ink == Ink::kOn ? "on" : ink == Ink::kOff ? "of" : "";
  if (!classes.empty() && *state != 0) classes += ' ';
  classes += state;
  body_ += "<text" + attribute("x", x) + attribute("y", y);
  if (!classes.empty()) body_ += " class=\"" + classes + '"';
  if (anchor == Anchor::kMiddle) body_ += " text-anchor=\"middle\"";
  if (anchor == Anchor::kEnd) body_ += " text-anchor=\"end\"";
  body_ += '>' + escaped(text) + "</text>\n";
  double right = anchor == Anchor::kStart    ? x + width
                 : anchor == Anchor::kMiddle ? x + width / 2
                                             : x;
  grow(right, y + 4);
}

std::string Svg::finish(std::string_view title) const {
  std::string width = number(std::ceil(width_ + kMargin));
  std::string height = number(std::ceil(height_ + kMargin));
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
         "\" viewBox=\"0 0 " + width + ' ' + height + "\">\n<title>" + escaped(title) +
         "</title>\n<style>\n" + kStyle + "</style>\n<rect class=\"g\" width=\"" + width +
         "\" height=\"" + height + "\"/>\n" + body_ + "</svg>\n";
}

}  // namespace frontend::draw
