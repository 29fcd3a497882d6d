// A chart as elements, laid out from top to bottom: a row for every step between the initial one
// and the farthest, a column for every branch. What leads upwards is a jump.
#include <algorithm>
#include <map>
#include <numeric>
#include <queue>

#include "adapters/plcopen/writer.h"
#include "base/name_case.h"

namespace plcopen {

namespace {

constexpr uint32_t kRow = 160;  // units between steps
constexpr uint32_t kColumn = 200;
constexpr int kActionHeight = 20;
constexpr const char* kQualifiers[] = {"N", "R", "S", "L", "D", "P", "P0", "P1", "SD", "DS", "SL"};

}  // namespace

class ChartWriter {
 public:
  ChartWriter(Writer& writer, const frontend::Chart& chart, Node sfc)
      : writer_(writer), chart_(chart), sfc_(sfc) {}

  void run() {
    find_rows();
    find_priorities();
    for (size_t i = 0; i < chart_.transitions.size(); ++i) leave(i);
    for (size_t i = 0; i < chart_.transitions.size(); ++i) enter(i);
    for (size_t i = 0; i < chart_.steps.size(); ++i) step(i);
  }

 private:
  static constexpr uint32_t kNone = 0xffffffffu;

  size_t step_of(const frontend::Name& name) const {
    auto found = by_name_.find(base::fold_name(name.text));
    return found == by_name_.end() ? chart_.steps.size() : found->second;
  }

  // Rows by the shortest way from an initial step, columns in the order of the text.
  void find_rows() {
    const size_t count = chart_.steps.size();
    row_.assign(count, kNone);
    column_.assign(count, 0);
    above_.assign(count, {});
    outgoing_.assign(count, 0);
    divergence_.assign(count, 0);
    for (size_t i = 0; i < count; ++i) by_name_[base::fold_name(chart_.steps[i].name.text)] = i;
    std::vector<std::vector<size_t>> next(count);
    for (const frontend::ChartTransition& transition : chart_.transitions) {
      for (const frontend::Name& from : transition.from) {
        const size_t a = step_of(from);
        if (a == count) continue;
        ++outgoing_[a];
        for (const frontend::Name& to : transition.to) {
          if (step_of(to) != count) next[a].push_back(step_of(to));
        }
      }
    }
    std::queue<size_t> open;
    auto reach = [&](size_t at, uint32_t row) {
      if (row_[at] != kNone) return;
      row_[at] = row;
      open.push(at);
    };
    for (size_t i = 0; i < count; ++i) {
      if (chart_.steps[i].initial) reach(i, 0);
    }
    for (size_t i = 0; i < count || !open.empty();) {
      if (open.empty()) {
        reach(i++, 0);  // those that nothing leads to
        continue;
      }
      const size_t at = open.front();
      open.pop();
      for (size_t to : next[at]) reach(to, row_[at] + 1);
    }
    std::map<uint32_t, uint32_t> used;
    for (size_t i = 0; i < count; ++i) column_[i] = used[row_[i]]++;
  }

  // Readers take alternatives from left to right, which says nothing where one of them leaves
  // several steps: all that compete with it have a priority then.
  void find_priorities() {
    std::vector<size_t> group(chart_.steps.size() + 1);  // by step: another step of it, or itself
    std::iota(group.begin(), group.end(), size_t{0});
    const auto group_of = [&](const frontend::Name& step) {
      size_t at = step_of(step);
      while (group[at] != at) at = group[at] = group[group[at]];
      return at;
    };
    for (const frontend::ChartTransition& transition : chart_.transitions) {
      for (const frontend::Name& from : transition.from) {
        group[group_of(from)] = group_of(transition.from[0]);
      }
    }
    std::map<size_t, std::vector<size_t>> competing;  // transitions, by group
    for (size_t i = 0; i < chart_.transitions.size(); ++i) {
      const std::vector<frontend::Name>& from = chart_.transitions[i].from;
      if (!from.empty()) competing[group_of(from[0])].push_back(i);
    }
    for (auto& [step, transitions] : competing) {
      const auto any = [&](auto&& has) {
        return std::any_of(transitions.begin(), transitions.end(),
                           [&](size_t i) { return has(chart_.transitions[i]); });
      };
      const bool several = any([](const auto& each) { return each.from.size() > 1; });
      const bool silent = any([](const auto& each) { return !each.has_priority; });
      if (!several || !silent || transitions.size() == 1) continue;
      const auto rank = [&](size_t i) {
        const frontend::ChartTransition& each = chart_.transitions[i];
        return each.has_priority ? uint64_t{each.priority} : uint64_t{1} << 32;
      };
      std::stable_sort(transitions.begin(), transitions.end(),
                       [&](size_t a, size_t b) { return rank(a) < rank(b); });
      for (size_t i = 0; i < transitions.size(); ++i) priority_[transitions[i]] = i + 1;
    }
  }

  Node element(const char* name, uint32_t x, uint32_t y) {
    Node node = sfc_.append_child(name);
    node.append_attribute("localId") = ++ids_;
    Node position = node.append_child("position");
    position.append_attribute("x") = x;
    position.append_attribute("y") = y;
    return node;
  }
  static void hang(Node node, uint32_t id) {
    node.append_child("connectionPointIn")
        .append_child("connection")
        .append_attribute("refLocalId") = id;
  }
  uint32_t step_id(size_t index) const { return 1'000'000 + static_cast<uint32_t>(index); }

  // The transition, with what lies between it and the steps above.
  void leave(size_t number) {
    const frontend::ChartTransition& transition = chart_.transitions[number];
    std::vector<uint32_t> from;
    uint32_t row = 0;
    for (const frontend::Name& name : transition.from) {
      const size_t at = step_of(name);
      if (at == chart_.steps.size()) continue;
      row = std::max(row, row_[at]);
      uint32_t id = step_id(at);
      if (outgoing_[at] > 1) {
        if (divergence_[at] == 0) {
          Node node =
              element("selectionDivergence", 50 + kColumn * column_[at], 50 + kRow * row_[at] + 30);
          divergence_[at] = ids_;
          hang(node, id);
        }
        id = divergence_[at];
      }
      from.push_back(id);
    }
    const uint32_t x = 50 + kColumn * static_cast<uint32_t>(number);
    if (from.size() > 1) {
      Node node = element("simultaneousConvergence", x, 50 + kRow * row + 45);
      for (uint32_t id : from) hang(node, id);
      from = {ids_};
    }
    Node node = element("transition", x, 50 + kRow * row + 60);
    transition_id_.push_back(ids_);
    const auto given = priority_.find(number);
    if (given != priority_.end()) {
      node.append_attribute("priority") = given->second;
    } else if (transition.has_priority) {
      node.append_attribute("priority") = transition.priority;
    }
    if (!from.empty()) hang(node, from[0]);
    bool list = false;
    const std::string text = writer_.condition_of(transition, list);
    Node inside = node.append_child("condition").append_child("inline");
    inside.append_attribute("name") = std::string(transition.name.text).c_str();
    writer_.put_text(inside, list ? "IL" : "ST", text);
  }

  // What lies between a transition and the steps below.
  void enter(size_t number) {
    const frontend::ChartTransition& transition = chart_.transitions[number];
    uint32_t row = 0;
    for (const frontend::Name& name : transition.from) {
      const size_t at = step_of(name);
      if (at != chart_.steps.size()) row = std::max(row, row_[at]);
    }
    const uint32_t x = 50 + kColumn * static_cast<uint32_t>(number);
    uint32_t from = transition_id_[number];
    if (transition.to.size() > 1) {
      hang(element("simultaneousDivergence", x, 50 + kRow * row + 90), from);
      from = ids_;
    }
    for (const frontend::Name& name : transition.to) {
      const size_t at = step_of(name);
      if (at != chart_.steps.size() && row_[at] > row) {
        above_[at].push_back(from);
        continue;
      }
      Node jump = element("jumpStep", x, 50 + kRow * row + 110);
      jump.append_attribute("targetName") = std::string(name.text).c_str();
      hang(jump, from);
    }
  }

  void step(size_t index) {
    const frontend::ChartStep& step = chart_.steps[index];
    const uint32_t x = 50 + kColumn * column_[index];
    const uint32_t y = 50 + kRow * row_[index];
    std::vector<uint32_t> above = above_[index];
    if (above.size() > 1) {
      Node node = element("selectionConvergence", x, y - 15);
      for (uint32_t id : above) hang(node, id);
      above = {ids_};
    }
    Node node = element("step", x, y);
    node.attribute("localId") = step_id(index);
    node.append_attribute("name") = std::string(step.name.text).c_str();
    if (step.initial) node.append_attribute("initialStep") = "true";
    if (!above.empty()) hang(node, above[0]);
    node.append_child("connectionPointOut").append_attribute("formalParameter") = "";
    if (step.uses.empty()) return;
    node.append_child("connectionPointOutAction").append_attribute("formalParameter") = "";
    Node block = element("actionBlock", x + 60, y);
    hang(block, step_id(index));
    uint32_t row = 0;
    for (const frontend::ActionUse& use : step.uses) {
      Node action = block.append_child("action");
      action.append_attribute("localId") = ++ids_;
      action.append_attribute("qualifier") = kQualifiers[static_cast<uint32_t>(use.qualifier)];
      if (use.time.valid()) {
        action.append_attribute("duration") = writer_.flat(writer_.tree_[use.time].span).c_str();
      }
      if (!use.indicators.empty()) {
        action.append_attribute("indicator") =
            writer_.flat(writer_.tree_[use.indicators[0]].span).c_str();
      }
      if (use.indicators.size() > 1) {
        writer_.fail(use.span, "an action with several indicators has no element in PLCopen XML");
      }
      Node relative = action.append_child("relPosition");
      relative.append_attribute("x") = 0;
      relative.append_attribute("y") = kActionHeight * static_cast<int>(row++);
      action.append_child("reference").append_attribute("name") =
          std::string(use.action.text).c_str();
    }
  }

  Writer& writer_;
  const frontend::Chart& chart_;
  Node sfc_;
  uint32_t ids_ = 0;
  std::map<std::string, size_t> by_name_;
  std::vector<uint32_t> row_;
  std::vector<uint32_t> column_;
  std::vector<uint32_t> outgoing_;            // transitions behind a step
  std::vector<uint32_t> divergence_;          // id below a step; 0: none
  std::vector<std::vector<uint32_t>> above_;  // ids that lead to a step directly
  std::vector<uint32_t> transition_id_;
  std::map<size_t, size_t> priority_;  // of transitions that need one
};

void Writer::chart(Node body, const frontend::Chart& chart) {
  ChartWriter(*this, chart, body.append_child("SFC")).run();
}

}  // namespace plcopen
