// Lines, boxes and texts -> an SVG document: self-contained, readable on light and on dark ground,
// with no other font than the generic ones. Coordinates are pixels at 100 %, y goes down. Texts are
// escaped; what is no UTF-8 is taken for Latin-1.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace frontend::draw {

enum class Ink : uint8_t {
  kPlain,
  kOn,   // powered, active
  kOff,  // known to be neither
};

enum class Anchor : uint8_t { kStart, kMiddle, kEnd };

enum class Type : uint8_t {
  kMono,     // operands
  kBold,     // names of boxes and steps
  kSmall,    // pins, qualifiers
  kComment,  // in a proportional font
  kTitle,
  kValue,  // live
  kNote,   // comments and addresses of operands, numbers of the order of execution
};

class Svg {
 public:
  void line(double x1, double y1, double x2, double y2, Ink ink = Ink::kPlain);
  void thick_line(double x1, double y1, double x2, double y2, Ink ink = Ink::kPlain);
  void rail(double x, double y1, double y2);
  void rect(double x, double y, double width, double height, Ink ink = Ink::kPlain);
  void dot(double x, double y, Ink ink = Ink::kPlain);
  void ring(double x, double y, double radius);                // of a negated pin
  void arrow_down(double x, double y, Ink ink = Ink::kPlain);  // its tip
  void arrow_right(double x, double y, Ink ink = Ink::kPlain);
  void arc(double x, double y, double height, bool left, Ink ink = Ink::kPlain);  // of a coil
  void text(double x, double y, std::string_view text, Type type = Type::kMono,
            Anchor anchor = Anchor::kStart, Ink ink = Ink::kPlain);

  // What is drawn in between is pale, and its lines are dashed.
  void begin_disabled();
  void end_disabled();

  double width() const { return width_; }
  double height() const { return height_; }
  std::string finish(std::string_view title) const;

 private:
  void grow(double x, double y);

  std::string body_;
  double width_ = 0;
  double height_ = 0;
};

// Columns of a text: East Asian characters take two.
double text_columns(std::string_view text);
double text_width(std::string_view text, Type type = Type::kMono);

}  // namespace frontend::draw
