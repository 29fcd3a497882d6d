// The picture of a timing chart: a row for each task, for receptions, transmissions and, where
// there was a change, for its configuration.
#include <algorithm>
#include <iterator>

#include "tools/stvm/svg_text.h"
#include "tools/stvm/timing_chart.h"
#include "tools/stvm/timing_scale.h"

namespace stvm {
namespace {

constexpr double kWidth = 960;
constexpr double kLeft = 130;
constexpr double kRight = 24;
constexpr double kUpperMargin = 44;
constexpr double kTaskHeight = 40;
constexpr double kBar = 20;     // of a running task, and of configuration
constexpr double kDotStep = 9;  // between the dots of two tasks
constexpr double kDotRadius = 3;

const char* color_of(size_t lane) { return kColors[lane % std::size(kColors)]; }

class Picture {
 public:
  explicit Picture(int64_t end_ns) : end_ns_(std::max<int64_t>(end_ns, 1)) {}

  double x(int64_t at_ns) const {
    const double share = static_cast<double>(at_ns) / static_cast<double>(end_ns_);
    return kLeft + share * (kWidth - kLeft - kRight);
  }
  void name(const std::string& text, double y) {
    out += format("<text x=\"%.0f\" y=\"%.1f\" class=\"name\">", kLeft - 12, y) + escaped(text) +
           "</text>\n";
  }
  void line(int64_t at_ns, double top, double bottom, const char* style) {
    out += format("<path d=\"M%.2f %.1fV%.1f\" class=\"%s\"/>\n", x(at_ns), top, bottom, style);
  }
  void base_line(double y) {
    out += format("<path d=\"M%.0f %.1fH%.0f\" class=\"base\"/>\n", kLeft, y, kWidth - kRight);
  }
  void bar(const TimeSpan& span, double top, double height, const char* color, const char* style) {
    out += format(
        "<rect x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%.1f\" fill=\"%s\" "
        "class=\"%s\"/>\n",
        x(span.from_ns), top, std::max(x(span.to_ns) - x(span.from_ns), 0.8), height, color, style);
  }
  // The line of an exchange of one task alone.
  void own_line(int64_t at_ns, double top, double bottom, const char* color) {
    out += format("<path d=\"M%.2f %.1fV%.1f\" stroke=\"%s\" stroke-dasharray=\"2 2\"/>\n",
                  x(at_ns), top, bottom, color);
  }
  void dot(int64_t at_ns, double y, const char* color) {
    out += format("<circle cx=\"%.2f\" cy=\"%.1f\" r=\"%.0f\" fill=\"%s\"/>\n", x(at_ns), y,
                  kDotRadius, color);
  }
  // Points downwards at the top of a row.
  void release(int64_t at_ns, double y) {
    out += format("<path d=\"M%.2f %.1fl-3.5 -6h7z\" class=\"due\"/>\n", x(at_ns), y);
  }
  void cross(int64_t at_ns, double y) {
    out += format("<path d=\"M%.2f %.1fl7 7m0 -7l-7 7\" class=\"missed\"/>\n", x(at_ns) - 3.5,
                  y - 3.5);
  }
  void text(double at, double y, const char* style, const std::string& words) {
    out += format("<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", at, y, style) + escaped(words) +
           "</text>\n";
  }

  std::string out;

 private:
  int64_t end_ns_;
};

constexpr const char* kStyle =
    "<style>text{font-size:12px;fill:#444}.name{font-size:13px;fill:#222;text-anchor:end}"
    ".tick{font-size:11px;fill:#666;text-anchor:middle}.base{stroke:#ccc;fill:none}"
    ".cycle{stroke:#e4e4e4;fill:none}.io{stroke:#888;fill:none}.due{fill:#222}"
    ".wait{opacity:.5}.scan{stroke:#fff}.below{opacity:.28}"
    ".first{fill:#0072b2}.other{fill:#999}"
    ".missed{stroke:#c00;stroke-width:2;fill:none}"
    ".switch{stroke:#222;stroke-width:1.5;stroke-dasharray:4 3;fill:none}</style>\n";

void draw_axis(Picture& picture, int64_t end_ns, double top) {
  const TimeScale scale = TimeScale::of(end_ns, 10);
  for (int64_t at_ns = 0; at_ns <= end_ns; at_ns += scale.step_ns) {
    picture.line(at_ns, top, top + 5, "io");
    picture.text(picture.x(at_ns), top + 18, "tick", scale.text(at_ns));
  }
}

void draw_legend(Picture& picture, double y, bool own) {
  constexpr struct {
    const char* shape;  // its left edge is 0, and the line of the text
    const char* style;
    const char* words;
    double width;
  } kSigns[] = {
      {"M6 -1l-3.5 -6h7z", "due", "due", 60},
      {"M0 -10h12v12h-12z", "first", "running", 90},
      {"M0 -10h12v12h-12z", "first below", "suspended", 106},
      {"M0 -4h12v4h-12z", "other wait", "due, others run", 130},
      {"M3 -8l7 7m0 -7l-7 7", "missed", "missed, trapped", 130},
      {"M10 -4a3 3 0 1 0 -6 0a3 3 0 1 0 6 0", "first", "inputs that its scan reads, outputs of it",
       0},
  };
  double at = kLeft;
  for (const auto& sign : kSigns) {
    picture.out += format("<path transform=\"translate(%.0f %.0f)\" d=\"%s\" class=\"%s\"/>\n", at,
                          y, sign.shape, sign.style);
    picture.text(at + 16, y, "note", sign.words);
    at += sign.width;
  }
  if (own) {
    picture.text(kLeft, y - 18, "note",
                 "dashed: received or sent for the task of that colour alone");
  }
}

double dots_height(size_t lanes) { return static_cast<double>(lanes) * kDotStep + 12; }

// A row of receptions or transmissions. Its dots say by colour and height of which task they are.
void draw_exchange(Picture& picture, const char* name, double top,
                   const std::vector<int64_t>& times, const std::vector<TimingLane>& lanes,
                   std::vector<int64_t> TimingLane::*of, std::vector<int64_t> TimingLane::*own) {
  const double height = dots_height(lanes.size());
  picture.name(name, top + height / 2 + 4);
  picture.base_line(top + height);
  for (const int64_t at_ns : times) picture.line(at_ns, top, top + height, "io");
  for (size_t i = 0; i < lanes.size(); ++i) {
    const double y = top + 6 + kDotStep * (static_cast<double>(i) + 0.5);
    for (const int64_t at_ns : lanes[i].*own) {
      picture.own_line(at_ns, top, top + height, color_of(i));
    }
    for (const int64_t at_ns : lanes[i].*of) picture.dot(at_ns, y, color_of(i));
  }
}

void draw_task(Picture& picture, const TimingLane& lane, const char* color, double floor) {
  picture.name(lane.task, floor - 6);
  picture.base_line(floor);
  for (const TimeSpan& span : lane.due) picture.bar(span, floor - 4, 4, "#999", "wait");
  for (const TimeSpan& span : lane.suspended) {
    picture.bar(span, floor - kBar, kBar, color, "below");
  }
  for (const TimeSpan& span : lane.running) picture.bar(span, floor - kBar, kBar, color, "scan");
  for (const int64_t at_ns : lane.released) picture.release(at_ns, floor - kBar - 2);
  for (const int64_t at_ns : lane.missed) picture.cross(at_ns, floor - kBar - 6);
  for (const int64_t at_ns : lane.trapped) picture.cross(at_ns, floor - kBar / 2);
}

void draw_change(Picture& picture, const std::vector<TimeSpan>& spans,
                 const std::vector<int64_t>& switches, double floor) {
  picture.name("configuration", floor - 6);
  picture.base_line(floor);
  for (const TimeSpan& span : spans) picture.bar(span, floor - kBar, kBar, "#e69f00", "scan");
  for (const int64_t at_ns : switches) {
    picture.line(at_ns, kUpperMargin - 6, floor, "switch");
    picture.text(picture.x(at_ns) + 4, floor - kBar - 6, "note", "switch");
  }
}

std::string head(double height, const std::string& title) {
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
             "width=\"%.0f\" height=\"%.0f\" font-family=\"sans-serif\">\n",
             kWidth, height, kWidth, height) +
         kStyle + "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         format("<text x=\"%.0f\" y=\"22\" style=\"font-size:15px\">", kLeft) + escaped(title) +
         "</text>\n";
}

}  // namespace

std::string TimingChart::svg(const std::string& title) const {
  const double dots = dots_height(lanes_.size());
  const double tasks_top = kUpperMargin + dots + 10;
  const double sent_top = tasks_top + static_cast<double>(lanes_.size()) * kTaskHeight + 10;
  const bool change = !configuration_.empty() || !switches_.empty();
  const double bottom = sent_top + dots + 10 + (change ? kTaskHeight : 0);
  const double height = bottom + (has_own() ? 82 : 64);
  Picture picture(end_ns_);
  picture.out = head(height, title + (cut_ ? " (the beginning of a longer run)" : ""));
  for (const int64_t at_ns : cycles_) picture.line(at_ns, kUpperMargin, bottom, "cycle");
  draw_exchange(picture, "inputs received", kUpperMargin, received_, lanes_, &TimingLane::inputs,
                &TimingLane::own_received);
  for (size_t i = 0; i < lanes_.size(); ++i) {
    draw_task(picture, lanes_[i], color_of(i),
              tasks_top + static_cast<double>(i + 1) * kTaskHeight);
  }
  draw_exchange(picture, "outputs sent", sent_top, sent_, lanes_, &TimingLane::outputs,
                &TimingLane::own_sent);
  if (change) draw_change(picture, configuration_, switches_, bottom);
  draw_axis(picture, end_ns_, bottom);
  draw_legend(picture, height - 16, has_own());
  return picture.out + "</svg>\n";
}

}  // namespace stvm
