#include "adapters/xml/chart_attributes.h"

#include <algorithm>
#include <tuple>

#include "base/name_case.h"

namespace xml {
namespace {

struct Row {
  std::string_view id;
  ChartAttribute attribute;
};

constexpr Row kRows[] = {
    {"38391c6d-6d4a-42f8-8ee7-9f45e5adafa8", ChartAttribute::kName},
    {"700a583f-b4d4-43e4-8c14-629c7cd3bec8", ChartAttribute::kMain},
    {"a6b08bd8-b696-47e3-9cbf-7408b61c9ff8", ChartAttribute::kEntry},
    {"a2621e18-7de3-4ea6-ae6d-89e9e0b7befd", ChartAttribute::kExit},
    {"6844a48e-46c2-4cc8-a185-a478f3b99cc0", ChartAttribute::kInitial},
    {"23bdaa98-72ec-41f7-817b-9dede5697086", ChartAttribute::kParallel},
    {"e174fc0d-80b0-4a9e-a530-ca239c249a50", ChartAttribute::kQualifier},
    {"cacf1a68-236e-47c2-b7b1-1cf9199718cb", ChartAttribute::kLeastTime},
    {"b693554c-1b01-4a8d-afde-9e3a46f7465d", ChartAttribute::kMostTime},
    {"7d894980-aeea-405c-a0f6-e2b26429c58f", ChartAttribute::kComment},
    {"01580b27-6378-448b-8ecb-0e4b795b58d6", ChartAttribute::kExclude},
    {"8294df19-5962-4dee-a874-1051dabb0e3e", ChartAttribute::kEditor},  // monitoring
    {"62e1754b-7629-4e63-9cec-10ae0c536f1f", ChartAttribute::kEditor},  // how it is copied
    {"bc882c11-1e91-4dd8-a6b8-2075724ed18b", ChartAttribute::kEditor},  // who sees its symbol
};

}  // namespace

void ChartAttributes::add(std::string_view id, std::string_view value, Node at, Reporter* report) {
  id = trimmed(id);
  if (id.starts_with('{') && id.ends_with('}')) id = id.substr(1, id.size() - 2);
  for (const Row& row : kRows) {
    if (!base::same_name(row.id, id)) continue;
    values_[row.attribute] = std::string(trimmed(value));
    return;
  }
  if (trimmed(value).empty() || report == nullptr) return;
  report->add(Code::kXmlNotUnderstood, at,
              "the attribute " + std::string(id) + " of an element of a chart is not understood");
}

const std::string& ChartAttributes::operator[](ChartAttribute attribute) const {
  static const std::string none;
  const auto found = values_.find(attribute);
  return found == values_.end() ? none : found->second;
}

bool ChartAttributes::is_true(ChartAttribute attribute) const {
  return base::same_name((*this)[attribute], "TRUE");
}

std::string ChartAttributes::action_rows(Node step, std::string_view indent,
                                         Reporter& report) const {
  std::string out;
  const auto add = [&](ChartAttribute attribute, const char* qualifier) {
    const std::string& name = (*this)[attribute];
    if (name.empty()) return;
    if (is_name(name)) {
      out += std::string(indent) + name + "(" + qualifier + ");\n";
    } else {
      report.add(Code::kXmlBadValue, step, "the action `" + name + "` of a step is no name");
    }
  };
  add(ChartAttribute::kEntry, "P1");
  add(ChartAttribute::kMain, "N");
  add(ChartAttribute::kExit, "P0");
  if (is_true(ChartAttribute::kExclude)) {
    report.add(Code::kXmlBody, step, "a step that is excluded from the build does not come in",
               "take it out of the chart");
  }
  if (const std::string& time = (*this)[ChartAttribute::kMostTime]; !time.empty()) {
    report.add(Code::kXmlLeftOut, step,
               "the longest time of a step, " + time + ", ends nothing: it was watched only");
  }
  return out;
}

std::string ChartAttributes::after_least_time(const std::string& condition, const std::string& step,
                                              const std::string& time) {
  const bool plain = time.find(' ') == std::string::npos;
  return "(" + condition + ") AND " + step + ".T >= " + (plain ? time : "(" + time + ")");
}

void OwnActions::add(const ChartAttributes& step) {
  const auto number = [&](ChartAttribute attribute, Numbered& actions) {
    if (step[attribute].empty()) return;
    actions.emplace(base::fold_name(step[attribute]), actions.size());
  };
  number(ChartAttribute::kMain, main);
  number(ChartAttribute::kEntry, entry);
  number(ChartAttribute::kExit, exit);
}

void OwnActions::add_usual(std::string_view name) { usual.insert(base::fold_name(name)); }

std::string OwnActions::conflict() const {
  const auto both = [](const Numbered& a, const auto& b, const char* what) {
    for (const auto& [name, number] : a) {
      if (b.count(name) != 0) return "the action `" + name + "` is that of " + what;
    }
    return std::string();
  };
  for (const std::string& text : {both(entry, main, "an entry and of an active step"),
                                  both(entry, exit, "an entry and of an exit"),
                                  both(main, usual, "an active step and in an action block")}) {
    if (!text.empty()) return text;
  }
  return {};
}

std::string OwnActions::head(std::string_view name) const {
  const std::string own = base::fold_name(name);
  const bool of_step = main.count(own) != 0 ||
                       ((entry.count(own) != 0 || exit.count(own) != 0) && usual.count(own) == 0);
  return of_step ? "{attribute 'no_final_scan'}\n" : "";
}

bool OwnActions::before(std::string_view a, std::string_view b) const {
  const auto place = [&](std::string_view name) {
    std::string own = base::fold_name(name);
    size_t group = 0;
    for (const Numbered* actions : {&exit, &entry, &main}) {
      const auto found = actions->find(own);
      if (found != actions->end()) return std::tuple(group, found->second, std::string());
      ++group;
    }
    return std::tuple(group, size_t{0}, std::move(own));
  };
  return place(a) < place(b);
}

}  // namespace xml
