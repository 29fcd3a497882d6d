// The inside of chart.cc: one chart, from the elements of the drawing to text.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapters/plcopen/drawing.h"
#include "adapters/plcopen/reader.h"

namespace plcopen {

struct ChartAction {
  Node node;
  std::string name;  // of an ACTION or variable
  std::string body;  // of one that stands in the step; empty: elsewhere
};

struct ChartElement {
  Node node;
  std::string name;           // steps: as the text has it
  std::vector<size_t> above;  // elements
  std::vector<size_t> below;
  std::vector<ChartAction> actions;  // steps
};

// From an element to the next one; `joined`: after a convergence or divergence of simultaneous
// branches, so several are meant.
struct Way {
  const ChartElement* from;
  const ChartElement* to;
  bool joined;
};

class Chart {
 public:
  Chart(Node sfc, Node pou, Reporter& report)
      : sfc_(sfc), pou_(pou), report_(report), drawing_(true, report) {}
  std::string text();
  // Names, folded, of actions that stand in steps, and of methods that conditions call.
  std::set<std::string> made_members;

 private:
  void collect();
  void add_condition_element(Node node);
  void connect();
  void add_actions(Node block);
  std::string step_name(Node node);
  void reserve_names();
  // Names of the steps that a transition leaves (`up`) or enters, through what lies between.
  std::vector<std::string> steps_beside(const ChartElement& transition, bool up);
  void push_neighbours(const ChartElement& element, bool up, bool joined, std::vector<Way>& todo);
  std::string jump_target(const ChartElement& jump);
  const ChartElement& left_by(const ChartElement& transition) const;
  std::vector<const ChartElement*> transitions() const;  // as they are asked
  std::string step_text(const ChartElement& step);
  std::string transition_text(const ChartElement& transition);
  std::string condition(const ChartElement& transition, const std::string& step);
  std::string late_condition(const ChartElement& transition, const std::vector<std::string>& from);
  std::string plain_condition(const ChartElement& transition, const std::string& step);
  std::string body_condition(Node body, const std::string& name, const std::string& step);
  bool is_too_much(Node transition);
  std::string linked_condition(Node point, Node transition, const std::string& step);
  std::string method_call(const std::string& name, const std::string& body);
  bool take_boxes(const Drawing& part);
  void report_idle_boxes();
  std::string priority(Node transition);

  Node sfc_;
  Node pou_;
  Reporter& report_;
  Drawing drawing_;                     // conditions
  std::vector<ChartElement> elements_;  // in the order of the drawing
  std::map<uint64_t, size_t> by_id_;
  std::map<std::string, Node> transitions_;   // that have names, folded
  std::map<const void*, std::string> calls_;  // of methods for bodies of those
  std::string methods_;
  std::vector<Node> boxes_;            // of function blocks, for conditions
  std::set<const void*> taken_boxes_;  // those that a condition has
  std::string comments_;
  xml::Names steps_;
  std::map<std::string, std::string> renamed_;      // steps, by their folded names in XML
  xml::Names actions_;                              // and what else actions may not be called
  std::map<std::string, std::string> least_times_;  // by step
  bool prioritised_ = false;
  static constexpr size_t kMaxWays = 5'000'000;  // of all transitions together
  static constexpr size_t kWaysOfCopy = 20;      // that an element of a copied network counts for
  size_t ways_ = 0;                              // that were followed
  bool reported_ = false;                        // that they are too many
  std::set<const ChartElement*> followed_;       // for one transition: each once, so loops end
};

}  // namespace plcopen
