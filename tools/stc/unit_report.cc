#include "tools/stc/unit_report.h"

#include <algorithm>

#include "base/visible_text.h"

namespace stc {
namespace {

constexpr size_t kWidth = 80;

std::string head_of(const UnitDifference& unit) {
  std::string out = unit.kind + " " + unit.name;
  if (unit.name != unit.file) out += " (" + unit.file + ":" + std::to_string(unit.line) + ")";
  switch (unit.how) {
    case Differs::kNew:
      return out + ": new";
    case Differs::kRemoved:
      return out + ": removed";
    case Differs::kComments:
      return out + ": only comments differ";
    case Differs::kLayout:
      return out + ": only the layout differs";
    default:
      return out;
  }
}

std::string in_one_or_two(const std::string& name, std::string before, std::string after) {
  if (before.empty()) before = "none";
  if (after.empty()) after = "none";
  const std::string one = "  " + name + ": " + before + " -> " + after + "\n";
  if (one.size() <= kWidth + 1) return one;
  return "  " + name + ":\n    - " + before + "\n    + " + after + "\n";
}

std::string text_of(const PartDifference& part) {
  std::string name = part.kind + (part.name.empty() ? "" : " " + part.name);
  if (part.kind == "lines") name = part.name;
  switch (part.how) {
    case Differs::kNew:
      name += " is new";
      if (!part.after.empty() && part.after != part.name) {
        return "  " + name + ": " + part.after + "\n";
      }
      break;
    case Differs::kRemoved:
      name += " is gone";
      if (!part.before.empty() && part.before != part.name) {
        return "  " + name + ": " + part.before + "\n";
      }
      break;
    case Differs::kOrder:
      return in_one_or_two(part.kind + "s in another order", part.before, part.after);
    case Differs::kComments:
      name += ", only comments";
      break;
    default:
      if (!part.what.empty()) return "  " + name + ": " + part.what + "\n";
      if (part.lines.empty()) return in_one_or_two(name, part.before, part.after);
  }
  std::string out = "  " + name + (part.lines.empty() ? "\n" : ":\n");
  for (const DifferingLine& line : part.lines) {
    out += "    " + std::string(1, line.sign) + " " + line.text + "\n";
  }
  return out;
}

}  // namespace

std::string difference_text(const std::vector<UnitDifference>& units) {
  if (units.empty()) return "the sources are the same\n";
  std::string out;
  bool program = false;
  for (const UnitDifference& unit : units) {
    out += head_of(unit) + "\n";
    for (const PartDifference& part : unit.parts) out += text_of(part);
    program = program || (unit.how != Differs::kComments && unit.how != Differs::kLayout);
  }
  if (!program) out += "only comments and layout differ: the program is the same\n";
  return base::visible_lines(out);  // texts of an image that somebody sent
}

void difference_json(const std::vector<UnitDifference>& units, tools::JsonWriter& json) {
  json.key("units").begin_array();
  for (const UnitDifference& unit : units) {
    json.begin_object().field("kind", unit.kind).field("name", unit.name);
    json.field("file", unit.file).field("line", unit.line);
    json.field("change", differs_name(unit.how)).key("differences").begin_array();
    for (const PartDifference& part : unit.parts) {
      json.begin_object().field("kind", part.kind).field("name", part.name);
      json.field("change", differs_name(part.how));
      json.field("before", part.before).field("after", part.after).field("what", part.what);
      json.key("lines").begin_array();
      for (const DifferingLine& line : part.lines) {
        json.value(std::string(1, line.sign) + " " + line.text);
      }
      json.end_array().end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace stc
