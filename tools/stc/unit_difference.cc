#include "tools/stc/unit_difference.h"

#include <algorithm>
#include <map>
#include <set>

#include "ir/types/types.h"
#include "tools/stc/box_text.h"
#include "tools/stc/unit_slices.h"

namespace stc {
namespace {

constexpr size_t kLongestOrder = 200;  // bytes of a list of names

std::string key_of(const Unit& unit) { return unit.kind + " " + ir::fold_name(unit.name); }

// By kind and name; the second one of a name has a number.
std::map<std::string, size_t> numbers_of(const std::vector<UnitPart>& parts,
                                         std::vector<std::string>& keys) {
  std::map<std::string, size_t> out;
  std::map<std::string, size_t> counts;
  for (size_t i = 0; i < parts.size(); ++i) {
    std::string key = parts[i].kind + " " + ir::fold_name(parts[i].name);
    const size_t number = ++counts[key];
    if (number > 1) key += "#" + std::to_string(number);
    out.emplace(key, i);
    keys.push_back(std::move(key));
  }
  return out;
}

// Names of one kind that both have.
std::string order_of(const std::vector<UnitPart>& parts, const std::vector<std::string>& keys,
                     const std::string& kind, const std::map<std::string, size_t>& other) {
  std::string out;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].kind != kind || !other.contains(keys[i])) continue;
    out += (out.empty() ? "" : ", ") + ir::fold_name(parts[i].name);
  }
  return out;
}

std::string cut(std::string text) {
  if (text.size() <= kLongestOrder) return text;
  text.resize(kLongestOrder);
  text += " ...";
  return text;
}

UnitDifference begin(const Unit& unit, Differs how) {
  return {unit.kind, unit.name, unit.file, unit.line, how};
}

// What no part tells, by its lines.
UnitBody whole(const Unit& unit) {
  base::SourceMap alone;
  const base::SourcePos begin = alone.add(unit.file, unit.text);
  UnitBody body{"", BodyKind::kText, Slices(alone).lines({begin, alone.end()})};
  for (BodyLine& line : body.lines) line.number += unit.line - 1;
  return body;
}

// Their texts differ.
UnitDifference compare(const Unit& before, const Unit& after) {
  UnitDifference out = begin(after, Differs::kEdited);
  compare_parts(before.parts, after.parts, out.parts);
  compare_bodies(before.bodies, after.bodies, out.parts);
  const auto is_more = [](const PartDifference& part) { return part.how != Differs::kComments; };
  const bool in_words = std::any_of(out.parts.begin(), out.parts.end(), is_more);
  if (in_words || after.kind == kDocumentUnit) return out;
  if (before.tokens != after.tokens) {
    compare_bodies({whole(before)}, {whole(after)}, out.parts);
  } else if (!out.parts.empty() || before.comments != after.comments) {
    out.how = Differs::kComments;
  } else {
    out.how = Differs::kLayout;
  }
  return out;
}

}  // namespace

const char* differs_name(Differs how) {
  static constexpr const char* kNames[] = {"new",   "removed",  "edited",
                                           "order", "comments", "layout"};
  return kNames[static_cast<size_t>(how)];
}

void compare_parts(const std::vector<UnitPart>& before, const std::vector<UnitPart>& after,
                   std::vector<PartDifference>& out) {
  std::vector<std::string> old_keys;
  std::vector<std::string> new_keys;
  const std::map<std::string, size_t> old_parts = numbers_of(before, old_keys);
  const std::map<std::string, size_t> new_parts = numbers_of(after, new_keys);
  std::vector<std::string> kinds;
  for (size_t i = 0; i < after.size(); ++i) {
    const UnitPart& now = after[i];
    if (kinds.empty() || kinds.back() != now.kind) kinds.push_back(now.kind);
    const auto found = old_parts.find(new_keys[i]);
    if (found == old_parts.end()) {
      out.push_back({now.kind, now.name, Differs::kNew, "", now.text});
      continue;
    }
    const UnitPart& was = before[found->second];
    if (was.text == now.text || tokens_of(was.text) == tokens_of(now.text)) continue;
    out.push_back({now.kind, now.name, Differs::kEdited, was.text, now.text,
                   differing_pins(was.text, now.text)});
  }
  for (size_t i = 0; i < before.size(); ++i) {
    if (new_parts.contains(old_keys[i])) continue;
    out.push_back({before[i].kind, before[i].name, Differs::kRemoved, before[i].text});
  }
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  for (const std::string& kind : kinds) {
    const std::string was = order_of(before, old_keys, kind, new_parts);
    const std::string is = order_of(after, new_keys, kind, old_parts);
    if (was != is) out.push_back({kind, "", Differs::kOrder, cut(was), cut(is)});
  }
}

std::vector<UnitDifference> differences(const std::vector<Unit>& before,
                                        const std::vector<Unit>& after) {
  std::map<std::string, const Unit*> old_units;
  std::map<std::string, const Unit*> new_units;
  for (const Unit& unit : before) old_units.emplace(key_of(unit), &unit);
  for (const Unit& unit : after) new_units.emplace(key_of(unit), &unit);
  std::vector<UnitDifference> out;
  std::set<std::string> told;  // files: a source is told only when none of its units is
  const auto tell = [&](UnitDifference unit) {
    told.insert(unit.file);
    out.push_back(std::move(unit));
  };
  const auto look_at = [&](const Unit& unit) {
    const auto found = old_units.find(key_of(unit));
    if (found == old_units.end()) {
      if (unit.kind != kSourceUnit) tell(begin(unit, Differs::kNew));
    } else if (found->second->text != unit.text || found->second->comments != unit.comments) {
      tell(compare(*found->second, unit));
    }
  };
  for (const Unit& unit : after) {
    if (unit.kind != kSourceUnit) look_at(unit);
  }
  for (const Unit& unit : before) {
    if (unit.kind == kSourceUnit || new_units.contains(key_of(unit))) continue;
    tell(begin(unit, Differs::kRemoved));
  }
  for (const Unit& unit : after) {
    if (unit.kind == kSourceUnit && !told.contains(unit.file)) look_at(unit);
  }
  return out;
}

}  // namespace stc
