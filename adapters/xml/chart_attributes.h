// What CODESYS and TwinCAT keep of an element of a chart, by the ids that both give it: above all
// the actions of a step itself. They run when the step is entered, while it is active, and when it
// is left, once or without a final scan.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "adapters/xml/document.h"

namespace xml {

enum class ChartAttribute : uint8_t {
  kName,  // of a transition: its condition
  kMain,
  kEntry,
  kExit,
  kInitial,
  kParallel,
  kQualifier,
  kLeastTime,
  kMostTime,
  kComment,
  kExclude,
  kEditor,  // of it alone
};

class ChartAttributes {
 public:
  // `id` with or without braces. An unknown one is reported to `report`, which may be null.
  void add(std::string_view id, std::string_view value, Node at, Reporter* report);
  // Empty: none.
  const std::string& operator[](ChartAttribute attribute) const;
  bool is_true(ChartAttribute attribute) const;

  // The rows of a step, each with `indent`: `Open(P1);`. What does not come in is reported.
  std::string action_rows(Node step, std::string_view indent, Reporter& report) const;
  // `condition` of a transition, where its step has to stay for a time.
  static std::string after_least_time(const std::string& condition, const std::string& step,
                                      const std::string& time);

 private:
  std::map<ChartAttribute, std::string> values_;
};

// The actions of steps themselves, by folded names, with their numbers in the order of the chart.
// In a scan those of exits run first, then those of entries, then those of active steps, each in
// the order of the chart, and then all other actions in the order of their names.
struct OwnActions {
  using Numbered = std::map<std::string, size_t>;
  Numbered main;
  Numbered entry;
  Numbered exit;
  std::set<std::string> usual;  // in the action block of a step
  void add(const ChartAttributes& step);
  void add_usual(std::string_view name);
  // An action that would have to run twice in a scan, or with a final scan and without one: why it
  // cannot be in both places. Empty: there is none.
  std::string conflict() const;
  // What stands in front of such an ACTION: its attribute, or nothing.
  std::string head(std::string_view name) const;
  // The ACTIONs of a POU are written in this order.
  bool before(std::string_view a, std::string_view b) const;
};

}  // namespace xml
