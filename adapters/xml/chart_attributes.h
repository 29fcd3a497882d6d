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

// The actions of steps themselves, by folded names: those that run while a step is active have no
// final scan; those of the entry run first in a scan.
struct OwnActions {
  std::set<std::string> main;
  std::set<std::string> entry;
  std::set<std::string> exit;
  std::set<std::string> usual;  // in the action block of a step
  void add(const ChartAttributes& step);
  void add_usual(std::string_view name);
  // An action that would have to run twice in a scan, or with a final scan and without one: why it
  // cannot be in both places. Empty: there is none.
  std::string conflict() const;
  // What stands in front of such an ACTION: its attribute, or nothing.
  std::string head(std::string_view name) const;
  bool is_entry(std::string_view name) const;
};

}  // namespace xml
