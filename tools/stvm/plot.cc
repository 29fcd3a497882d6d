#include "tools/stvm/plot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tools/common/fate_report.h"
#include "tools/stvm/svg_text.h"

namespace stvm {
namespace {

constexpr size_t kMaxColumns = 1600;
constexpr double kPlotWidth = 960;
constexpr double kPlotLeft = 60;
constexpr double kPlotRight = 16;
constexpr double kLaneHeight = 88;
constexpr double kPlotHeight = 56;
constexpr double kUpperEdge = 48;

bool is_plottable(const ir::Image& image, ir::TypeId type) {
  if (!image.types.is_scalar(type) || image.types.is_reference(type)) return false;
  const ir::Scalar scalar = image.types.scalar(type);
  return scalar != ir::Scalar::kAddr && scalar != ir::Scalar::kStr && scalar != ir::Scalar::kWstr;
}

double number_of(ir::Scalar scalar, const uint8_t* bytes) {
  uint64_t bits = 0;
  std::memcpy(&bits, bytes, ir::scalar_size(scalar));
  if (scalar == ir::Scalar::kF32) {
    return static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits)));
  }
  if (scalar == ir::Scalar::kF64) return std::bit_cast<double>(bits);
  if (!ir::is_signed(scalar)) return static_cast<double>(bits);
  const uint32_t unused = 64 - 8 * ir::scalar_size(scalar);
  return static_cast<double>(static_cast<int64_t>(bits << unused) >> unused);
}

// Three or four digits, as a person would write them.
std::string number_text(double value) { return format("%.4g", value); }

}  // namespace

base::Result<Plot> Plot::of(const vm::Controller& controller, std::vector<std::string> names) {
  if (names.empty() || names.size() > kMaxLanes) {
    return base::Error{base::Refusal::kUsage, "a plot needs --print with 1 to " +
                                                  std::to_string(kMaxLanes) + " variables"};
  }
  const ir::Image& image = controller.image();
  Plot plot;
  plot.scan_ns_ = controller.base_period_ns();
  for (std::string& name : names) {
    base::Result<ir::Symbol> symbol = ir::find_symbol(image, name);
    if (!symbol.ok()) return symbol.error();
    if (!is_plottable(image, symbol->type)) {
      return base::Error{base::Refusal::kBadValue,
                         "`" + name + "` is no number, time or BOOL that could be drawn"};
    }
    const ir::Kind kind = image.types.root_kind(symbol->type);
    const bool time = kind == ir::Kind::kTime || kind == ir::Kind::kLtime;
    plot.lanes_.push_back({std::move(name), *symbol, kind == ir::Kind::kBool, time ? "s" : "", {}});
  }
  return plot;
}

void Plot::join_neighbours(std::vector<Column>& columns) {
  for (size_t i = 0; i + 1 < columns.size(); i += 2) {
    const Column& a = columns[i];
    const Column& b = columns[i + 1];
    columns[i / 2] = {a.scan, a.first, std::min(a.low, b.low), std::max(a.high, b.high), b.last};
  }
  if (columns.size() % 2 != 0) columns[columns.size() / 2] = columns.back();
  columns.resize((columns.size() + 1) / 2);
}

// After an online change a variable is found again by its path, or keeps its last value.
void Plot::sample(const vm::Controller& controller) {
  const ir::Image& image = controller.image();
  const uint8_t* memory = const_cast<vm::Controller&>(controller).memory().data();
  const bool begins = in_column_ == 0;
  for (Lane& lane : lanes_) {
    double value = lane.columns.empty() ? 0 : lane.columns.back().last;
    const base::Result<ir::Symbol> symbol = ir::find_symbol(image, lane.name);
    if (symbol.ok() && is_plottable(image, symbol->type)) {
      value = number_of(image.types.scalar(symbol->type), memory + symbol->data);
    }
    if (!lane.unit.empty()) value /= 1e9;
    if (!std::isfinite(value)) value = lane.columns.empty() ? 0 : lane.columns.back().last;
    if (begins) {
      lane.columns.push_back({controller.cycles(), value, value, value, value});
    } else {
      Column& column = lane.columns.back();
      column.low = std::min(column.low, value);
      column.high = std::max(column.high, value);
      column.last = value;
    }
  }
  in_column_ = (in_column_ + 1) % per_column_;
  if (in_column_ != 0 || lanes_.front().columns.size() < kMaxColumns) return;
  for (Lane& lane : lanes_) join_neighbours(lane.columns);
  per_column_ *= 2;
}

std::string Plot::lane_svg(const Lane& lane, size_t number, double top, uint64_t begin,
                           uint64_t end) const {
  double low = lane.boolean ? 0 : lane.columns.front().low;
  double high = lane.boolean ? 1 : lane.columns.front().high;
  for (const Column& column : lane.columns) {
    low = std::min(low, column.low);
    high = std::max(high, column.high);
  }
  const double span = high > low ? high - low : 1;
  const double scans = static_cast<double>(std::max<uint64_t>(end - begin, 1));
  const auto x = [&](uint64_t scan) {
    return kPlotLeft +
           static_cast<double>(scan - begin) / scans * (kPlotWidth - kPlotLeft - kPlotRight);
  };
  const auto y = [&](double value) {
    return top + kPlotHeight - (value - low) / span * kPlotHeight;
  };
  const char* color = kColors[number % std::size(kColors)];
  std::string out = format("<text x=\"%.0f\" y=\"%.0f\" class=\"name\">", kPlotLeft, top - 7) +
                    escaped(lane.name) + (lane.unit.empty() ? "" : " [" + lane.unit + "]") +
                    "</text>\n";
  out += format("<rect x=\"%.0f\" y=\"%.1f\" width=\"%.0f\" height=\"%.0f\" class=\"lane\"/>\n",
                kPlotLeft, top, kPlotWidth - kPlotLeft - kPlotRight, kPlotHeight);
  const std::string texts[] = {lane.boolean ? "TRUE" : number_text(high),
                               lane.boolean ? "FALSE" : number_text(low)};
  out += format("<text x=\"%.0f\" y=\"%.1f\" class=\"tick\">%s</text>\n", kPlotLeft - 6, top + 9,
                texts[0].c_str());
  if (high > low) {
    out += format("<text x=\"%.0f\" y=\"%.1f\" class=\"tick\">%s</text>\n", kPlotLeft - 6,
                  top + kPlotHeight, texts[1].c_str());
  }
  out += "<path d=\"";
  for (size_t i = 0; i < lane.columns.size(); ++i) {
    const Column& column = lane.columns[i];
    const double at = x(column.scan);
    out += i == 0 ? format("M%.2f %.2f", at, y(column.first))
                  : format("H%.2fV%.2f", at, y(column.first));
    if (column.low < column.high) {
      out += format("V%.2fV%.2fV%.2f", y(column.low), y(column.high), y(column.last));
    }
  }
  out += format("H%.2f\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", x(end), color);
  return out;
}

std::string Plot::svg(const std::string& title) const {
  const double height = kUpperEdge + static_cast<double>(lanes_.size()) * kLaneHeight + 20;
  std::string out =
      format(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
          "height=\"%.0f\" font-family=\"sans-serif\">\n",
          kPlotWidth, height, kPlotWidth, height) +
      "<style>.name{font-size:13px;fill:#222}.tick{font-size:11px;fill:#666;text-anchor:end}"
      ".axis{font-size:11px;fill:#666;text-anchor:middle}.lane{fill:#f6f6f6;stroke:#ddd}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  out += format("<text x=\"%.0f\" y=\"20\" font-size=\"15\" fill=\"#222\">", kPlotLeft) +
         escaped(title) + "</text>\n";
  if (lanes_.front().columns.empty()) return out + "</svg>\n";
  const uint64_t begin = lanes_.front().columns.front().scan;
  const uint64_t end = std::max(begin + 1, lanes_.front().columns.back().scan + per_column_);
  for (size_t i = 0; i < lanes_.size(); ++i) {
    out += lane_svg(lanes_[i], i, kUpperEdge + static_cast<double>(i) * kLaneHeight, begin, end);
  }
  for (int i = 0; i <= 4; ++i) {
    const uint64_t scan = begin + (end - begin) * static_cast<uint64_t>(i) / 4;
    const double at = kPlotLeft + (kPlotWidth - kPlotLeft - kPlotRight) * i / 4.0;
    const std::string time = tools::duration(static_cast<int64_t>(scan - begin) * scan_ns_);
    out += format("<text x=\"%.0f\" y=\"%.0f\" class=\"axis\">%llu (%s)</text>\n",
                  std::clamp(at, kPlotLeft + 30, kPlotWidth - kPlotRight - 40), height - 18,
                  static_cast<unsigned long long>(scan), time.c_str());
  }
  out += format("<text x=\"%.0f\" y=\"%.0f\" class=\"axis\">cycle (time)</text>\n",
                kPlotLeft + (kPlotWidth - kPlotLeft - kPlotRight) / 2, height - 4);
  return out + "</svg>\n";
}

}  // namespace stvm
