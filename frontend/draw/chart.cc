#include <algorithm>

#include "base/wrapped.h"
#include "frontend/draw/chart_parts.h"
#include "frontend/draw/pictures.h"
#include "frontend/draw/shapes.h"

namespace frontend::draw {

namespace {

constexpr double kStepHeight = 36;
constexpr double kActionRow = 22;
constexpr double kLine = 16;
constexpr double kBranchGap = 28;
constexpr size_t kWrap = 44;  // columns of a condition

const char* qualifier_text(ActionQualifier qualifier) {
  static constexpr const char* kTexts[] = {"N",  "R",  "S",  "L",  "D", "P",
                                           "P0", "P1", "SD", "DS", "SL"};
  return kTexts[static_cast<size_t>(qualifier)];
}

std::string text_of(const base::SourceMap& sources, base::SourceSpan span) {
  if (!span.begin.valid()) return {};
  uint32_t file = sources.file_of(span.begin);
  if (file >= sources.file_count()) return {};
  uint32_t base = sources.begin(file).offset;
  return std::string(
      sources.text(file).substr(span.begin.offset - base, span.end.offset - span.begin.offset));
}

struct Size {
  double axis = 0;  // of the line down, from the left
  double width = 0;
  double height = 0;
};

struct Action {
  std::string qualifier;
  std::string name;
  std::string indicators;
};

class ChartPicture {
 public:
  ChartPicture(const Tree& tree, const base::SourceMap& sources, const Chart& chart,
               const Live* live)
      : tree_(tree), sources_(sources), net_(sfc::resolve(chart)), live_(live) {}

  std::string run(std::string_view title) {
    svg_.text(kLeft, 28, title, Type::kTitle);
    double x = kLeft;
    for (const Sequence& sequence : chart_parts(net_)) {
      Size size = measure(sequence);
      draw(sequence, x + size.axis, 50);
      x += size.width + 2 * kBranchGap;
    }
    return svg_.finish(title);
  }

 private:
  Size measure(const Sequence& sequence);
  Size measure(const Part& part);
  Size measure_branches(const Part& part);
  double draw(const Sequence& sequence, double x, double y);
  double draw(const Part& part, double x, double y);
  double draw_step(uint32_t step, double x, double y);
  double draw_transition(uint32_t transition, double x, double y);
  double draw_branches(const Part& part, double x, double y);
  void bar(double from, double to, double y, bool twice, Ink ink);

  std::vector<Action> actions(const ChartStep& step) const;
  std::vector<std::string> condition(const sfc::Transition& transition) const;
  std::string text(ExprId expr) const {
    return expr.valid() ? text_of(sources_, tree_[expr].span) : std::string();
  }
  std::string_view step_name(uint32_t step) const { return net_.steps[step].decl->name.text; }
  double step_width(uint32_t step) const {
    return std::max(76.0, text_width(step_name(step), Type::kBold) + 26);
  }
  std::string waits_for(uint32_t transition) const;
  Truth active(uint32_t step) const {
    if (live_ == nullptr) return Truth::kUnknown;
    return live_->truth(std::string(step_name(step)) + ".X");
  }

  const Tree& tree_;
  const base::SourceMap& sources_;
  sfc::Net net_;
  const Live* live_;
  Svg svg_;
};

std::vector<Action> ChartPicture::actions(const ChartStep& step) const {
  std::vector<Action> out;
  for (const ActionUse& use : step.uses) {
    Action action{qualifier_text(use.qualifier), std::string(use.action.text), {}};
    if (use.time.valid()) action.qualifier += ' ' + text(use.time);
    for (ExprId indicator : use.indicators) {
      action.indicators += (action.indicators.empty() ? "" : ", ") + text(indicator);
    }
    out.push_back(std::move(action));
  }
  return out;
}

std::vector<std::string> ChartPicture::condition(const sfc::Transition& transition) const {
  const ChartTransition& decl = *transition.decl;
  std::string head(decl.name.text);
  if (decl.has_priority) {
    head += (head.empty() ? "" : " ") + ("[" + std::to_string(decl.priority) + "]");
  }
  std::vector<std::string> out = base::wrapped(text(decl.condition), kWrap);
  if (!head.empty()) out.insert(out.begin(), head);
  if (out.empty()) out.push_back("?");
  return out;
}

std::string ChartPicture::waits_for(uint32_t transition) const {
  std::string out;
  for (uint32_t step : net_.transitions[transition].from) {
    out += (out.empty() ? "" : ", ") + std::string(step_name(step));
  }
  return out;
}

Size ChartPicture::measure(const Sequence& sequence) {
  Size out;
  double behind = 0;
  for (const Part& part : sequence) {
    Size size = measure(part);
    out.axis = std::max(out.axis, size.axis);
    behind = std::max(behind, size.width - size.axis);
    out.height += size.height;
  }
  out.width = out.axis + behind;
  return out;
}

Size ChartPicture::measure(const Part& part) {
  switch (part.kind) {
    case PartKind::kStep: {
      double width = step_width(part.number);
      double rows = static_cast<double>(net_.steps[part.number].decl->uses.size());
      Size size{width / 2, width, std::max(kStepHeight, rows * kActionRow) + kLine};
      double q = 0, n = 0, i = 0;
      for (const Action& action : actions(*net_.steps[part.number].decl)) {
        q = std::max(q, text_width(action.qualifier, Type::kSmall) + 12);
        n = std::max(n, text_width(action.name) + 12);
        i = std::max(i, text_width(action.indicators, Type::kSmall) + 12);
      }
      if (rows > 0) size.width += 18 + q + n + (i > 12 ? i : 0);
      if (live_ != nullptr) size.width += 70;
      return size;
    }
    case PartKind::kTransition: {
      std::vector<std::string> lines = condition(net_.transitions[part.number]);
      double width = 0;
      for (const std::string& line : lines) width = std::max(width, text_width(line));
      return {14, 34 + width, std::max(30.0, static_cast<double>(lines.size()) * 15 + 16)};
    }
    case PartKind::kJump:
      return {8, 16 + text_width(step_name(part.number), Type::kBold), 44};
    case PartKind::kJoin:
      return {8, 16 + text_width(waits_for(part.number)), 44};
    case PartKind::kWaits:
      return {30, 70 + text_width(waits_for(part.number)), 34};
    default:
      return measure_branches(part);
  }
}

Size ChartPicture::measure_branches(const Part& part) {
  Size out;
  for (size_t b = 0; b < part.branches.size(); ++b) {
    Size size = measure(part.branches[b]);
    if (b == 0) out.axis = size.axis;
    out.width += size.width + (b == 0 ? 0 : kBranchGap);
    out.height = std::max(out.height, size.height);
  }
  out.height += 3 * kLine;
  return out;
}

double ChartPicture::draw(const Sequence& sequence, double x, double y) {
  for (const Part& part : sequence) y = draw(part, x, y);
  return y;
}

double ChartPicture::draw(const Part& part, double x, double y) {
  switch (part.kind) {
    case PartKind::kStep:
      return draw_step(part.number, x, y);
    case PartKind::kTransition:
      return draw_transition(part.number, x, y);
    case PartKind::kJump:
      svg_.line(x, y, x, y + 16);
      svg_.arrow_down(x, y + 24);
      svg_.text(x, y + 38, step_name(part.number), Type::kBold, Anchor::kStart);
      return y + 44;
    case PartKind::kJoin:
      svg_.line(x, y, x, y + 16);
      bar(x - 8, x + 24, y + 16, true, Ink::kPlain);
      svg_.text(x, y + 36, waits_for(part.number), Type::kMono);
      return y + 44;
    case PartKind::kWaits:
      svg_.text(x + 36, y + 18, waits_for(part.number));
      bar(x - 30, x + 30, y + 12, true, Ink::kPlain);
      svg_.line(x, y + 15, x, y + 34);
      return y + 34;
    default:
      return draw_branches(part, x, y);
  }
}

double ChartPicture::draw_step(uint32_t number, double x, double y) {
  const ChartStep& step = *net_.steps[number].decl;
  double width = step_width(number);
  double left = x - width / 2;
  Truth now = active(number);
  Ink frame = now == Truth::kTrue ? Ink::kOn : Ink::kPlain;
  svg_.rect(left, y, width, kStepHeight, frame);
  if (step.initial) svg_.rect(left + 4, y + 4, width - 8, kStepHeight - 8, frame);
  svg_.text(x, y + kStepHeight / 2 + 4, step.name.text, Type::kBold, Anchor::kMiddle,
            now == Truth::kTrue ? Ink::kOn : Ink::kPlain);
  std::vector<Action> rows = actions(step);
  double q = 0, n = 0, i = 0;
  for (const Action& action : rows) {
    q = std::max(q, text_width(action.qualifier, Type::kSmall) + 12);
    n = std::max(n, text_width(action.name) + 12);
    i = std::max(i, text_width(action.indicators, Type::kSmall) + 12);
  }
  double right = left + width;
  double at = y;
  if (!rows.empty()) svg_.line(right, y + 11, right + 18, y + 11);
  for (const Action& action : rows) {
    double from = right + 18;
    svg_.rect(from, at, q, kActionRow);
    svg_.text(from + q / 2, at + 15, action.qualifier, Type::kSmall, Anchor::kMiddle);
    svg_.rect(from + q, at, n, kActionRow);
    Ink name = live_ != nullptr ? ink(live_->truth(action.name)) : Ink::kPlain;
    svg_.text(from + q + 6, at + 15, action.name, Type::kMono, Anchor::kStart, name);
    if (i > 12) {
      svg_.rect(from + q + n, at, i, kActionRow);
      svg_.text(from + q + n + 6, at + 15, action.indicators, Type::kSmall);
    }
    at += kActionRow;
  }
  if (now == Truth::kTrue) {
    const std::string* time = live_->find(std::string(step.name.text) + ".T");
    double beside = rows.empty() ? right + 8 : right + 26 + q + n + (i > 12 ? i : 0);
    if (time != nullptr) svg_.text(beside, y + 15, *time, Type::kValue);
  }
  double bottom = y + std::max(kStepHeight, static_cast<double>(rows.size()) * kActionRow) + kLine;
  svg_.line(x, y + kStepHeight, x, bottom, frame);
  return bottom;
}

double ChartPicture::draw_transition(uint32_t number, double x, double y) {
  std::vector<std::string> lines = condition(net_.transitions[number]);
  double height = std::max(30.0, static_cast<double>(lines.size()) * 15 + 16);
  const ChartTransition& decl = *net_.transitions[number].decl;
  std::string expression = text(decl.condition);
  Ink colour =
      live_ != nullptr && decl.condition.valid() ? ink(live_->truth(expression)) : Ink::kPlain;
  svg_.line(x, y, x, y + height);
  svg_.thick_line(x - 12, y + 10, x + 12, y + 10, colour);
  double at = y + 14;
  for (const std::string& line : lines) {
    svg_.text(x + 20, at, line, Type::kMono, Anchor::kStart, colour);
    at += 15;
  }
  if (live_ != nullptr) {
    svg_.text(x + 28 + text_width(lines.back()), at - 15, live_->shown(expression), Type::kValue);
  }
  return y + height;
}

void ChartPicture::bar(double from, double to, double y, bool twice, Ink ink) {
  svg_.line(from, y, to, y, ink);
  if (twice) svg_.line(from, y + 3, to, y + 3, ink);
}

// Simultaneous branches stand between double lines, alternatives between single ones.
double ChartPicture::draw_branches(const Part& part, double x, double y) {
  bool twice = part.kind == PartKind::kSimultaneous;
  double over = twice ? 8 : 0;
  Size whole = measure_branches(part);
  double bottom = y + whole.height;
  double top = y + kLine;
  double low = bottom - kLine;
  double left = x - whole.axis;
  double last = x;
  double last_meeting = x;
  bool meets = false;
  svg_.line(x, y, x, top);
  for (size_t b = 0; b < part.branches.size(); ++b) {
    Size size = measure(part.branches[b]);
    double axis = left + size.axis;
    svg_.line(axis, top + (twice ? 3 : 0), axis, top + kLine / 2);
    double end = draw(part.branches[b], axis, top + kLine / 2);
    if (part.meets[b]) {
      svg_.line(axis, end, axis, low);
      meets = true;
      last_meeting = axis;
    }
    last = axis;
    left += size.width + kBranchGap;
  }
  bar(x - over, last + over, top, twice, Ink::kPlain);
  if (!meets) return bottom;
  double first_meeting = x;
  bar(std::min(first_meeting, last_meeting) - over, last_meeting + over, low, twice, Ink::kPlain);
  svg_.line(x, low + (twice ? 3 : 0), x, bottom);
  return bottom;
}

}  // namespace

std::vector<std::string> variables(const Tree& tree, const base::SourceMap& sources,
                                   const Chart& chart) {
  std::vector<std::string> out;
  for (const ChartStep& step : chart.steps) {
    out.push_back(std::string(step.name.text) + ".X");
    out.push_back(std::string(step.name.text) + ".T");
    for (const ActionUse& use : step.uses) out.emplace_back(use.action.text);
  }
  for (const ChartTransition& transition : chart.transitions) {
    if (!transition.condition.valid()) continue;
    std::string condition = text_of(sources, tree[transition.condition].span);
    for (std::string& path : variables_in(condition)) out.push_back(std::move(path));
  }
  return out;
}

std::string draw_chart(const Tree& tree, const base::SourceMap& sources, const Chart& chart,
                       std::string_view title, const Live* live) {
  return ChartPicture(tree, sources, chart, live).run(title);
}

}  // namespace frontend::draw
