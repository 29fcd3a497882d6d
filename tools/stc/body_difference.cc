#include <algorithm>
#include <map>
#include <string_view>

#include "frontend/network/same.h"
#include "frontend/network/write.h"
#include "ir/types/types.h"
#include "tools/stc/box_text.h"
#include "tools/stc/difference.h"
#include "tools/stc/unit_difference.h"
#include "tools/stc/unit_slices.h"

namespace stc {
namespace {

namespace network = frontend::network;

constexpr size_t kLinesAround = 2;  // lines around those that differ

using Views = std::vector<std::string_view>;

std::string prefix_of(const UnitBody& body) { return body.name.empty() ? "" : body.name + ", "; }

// --- lines -------------------------------------------------------------------------

std::string joined(const std::vector<BodyLine>& lines, size_t begin, size_t end) {
  std::string out;
  for (size_t i = begin; i < end; ++i) out += lines[i].text + '\n';
  return out;
}

std::string place_text(const std::vector<BodyLine>& lines, size_t begin, size_t end) {
  if (begin == end) {
    if (begin == 0) return "at the beginning";
    return "after line " + std::to_string(lines[begin - 1].number);
  }
  const std::string first = std::to_string(lines[begin].number);
  const std::string last = std::to_string(lines[end - 1].number);
  return first == last ? "line " + first : "lines " + first + " to " + last;
}

// Differences near each other are one piece.
void compare_lines(const UnitBody& before, const UnitBody& after,
                   std::vector<PartDifference>& out) {
  std::vector<std::string> texts[2];
  Views views[2];
  const std::vector<BodyLine>* const lines[2] = {&before.lines, &after.lines};
  for (int side : {0, 1}) {
    for (const BodyLine& line : *lines[side]) texts[side].push_back(squeezed(line.text));
    views[side].assign(texts[side].begin(), texts[side].end());
  }
  const std::vector<LineChange> changes = changes_between(views[0], views[1]);
  for (size_t first = 0; first < changes.size();) {
    size_t last = first + 1;
    while (last < changes.size() && changes[last].a - changes[last - 1].a_end <= 2 * kLinesAround) {
      ++last;
    }
    const LineChange all{changes[first].a, changes[last - 1].a_end, changes[first].b,
                         changes[last - 1].b_end};
    const std::string was = joined(before.lines, all.a, all.a_end);
    const std::string is = joined(after.lines, all.b, all.b_end);
    const bool same = tokens_of(was) == tokens_of(is);
    if (!same || comments_of(was) != comments_of(is)) {
      PartDifference part{"lines", prefix_of(after) + place_text(after.lines, all.b, all.b_end),
                          same ? Differs::kComments : Differs::kEdited};
      size_t a = all.a - std::min(kLinesAround, all.a);
      for (; a < all.a; ++a) part.lines.push_back({' ', before.lines[a].text});
      for (size_t n = first; n < last; ++n) {
        for (; a < changes[n].a; ++a) part.lines.push_back({' ', before.lines[a].text});
        for (; a < changes[n].a_end; ++a) part.lines.push_back({'-', before.lines[a].text});
        for (size_t b = changes[n].b; b < changes[n].b_end; ++b) {
          part.lines.push_back({'+', after.lines[b].text});
        }
      }
      const size_t end = std::min(all.a_end + kLinesAround, before.lines.size());
      for (; a < end; ++a) part.lines.push_back({' ', before.lines[a].text});
      out.push_back(std::move(part));
    }
    first = last;
  }
}

// --- rungs -------------------------------------------------------------------------

struct Rung {
  std::string text;     // as `stc fmt` draws it, with its comments
  std::string program;  // what it does, without comments
  std::string writes;   // what it is known by
};

Rung rung_of(network::Network whole) {
  Rung rung;
  for (const network::Element& element : whole.elements) {
    const bool writes = element.kind == network::Kind::kCoil ||
                        element.kind == network::Kind::kSink ||
                        element.kind == network::Kind::kBlock;
    if (writes) rung.writes += ir::fold_name(element.operand.text) + ';';
  }
  network::Body body{network::Language::kLadder, {std::move(whole)}, {}};
  rung.text = network::write_ladder(body, 0).value_or(std::string());
  if (rung.text.empty()) rung.text = network::write_fbd(body, 0);
  body.networks[0].comments.clear();
  for (network::Element& element : body.networks[0].elements) element.comments.clear();
  rung.program = network::canonical(body);
  return rung;
}

std::vector<Rung> rungs_of(const network::Body& body) {
  std::vector<Rung> out;
  for (const network::Network& one : body.networks) out.push_back(rung_of(one));
  return out;
}

void add_text(const std::string& text, char sign, std::vector<DifferingLine>& out) {
  for (std::string_view rest = text; !rest.empty();) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    if (end != 0) out.push_back({sign, std::string(rest.substr(0, end))});
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void compare_rungs(const UnitBody& before, const UnitBody& after,
                   std::vector<PartDifference>& out) {
  const std::vector<Rung> was = rungs_of(before.diagram);
  const std::vector<Rung> is = rungs_of(after.diagram);
  Views from, to;
  for (const Rung& rung : was) from.push_back(rung.text);
  for (const Rung& rung : is) to.push_back(rung.text);
  const auto add = [&](size_t number, Differs how, const Rung* old_rung, const Rung* new_rung) {
    PartDifference part{"rung", prefix_of(after) + std::to_string(number + 1), how};
    if (old_rung != nullptr) add_text(old_rung->text, '-', part.lines);
    if (new_rung != nullptr) add_text(new_rung->text, '+', part.lines);
    out.push_back(std::move(part));
  };
  for (const LineChange& change : changes_between(from, to)) {
    size_t a = change.a;
    for (size_t b = change.b; b < change.b_end; ++b) {
      size_t twin = a;
      while (twin < change.a_end && was[twin].writes != is[b].writes) ++twin;
      if (twin == change.a_end) {
        add(b, Differs::kNew, nullptr, &is[b]);
        continue;
      }
      for (; a < twin; ++a) add(a, Differs::kRemoved, &was[a], nullptr);
      const bool same = was[a].program == is[b].program;
      if (was[a].text != is[b].text) {
        add(b, same ? Differs::kComments : Differs::kEdited, &was[a], &is[b]);
      }
      ++a;
    }
    for (; a < change.a_end; ++a) add(a, Differs::kRemoved, &was[a], nullptr);
  }
}

// --- boxes -------------------------------------------------------------------------

std::vector<UnitPart> boxes_of(const UnitBody& body) {
  std::vector<UnitPart> out;
  const std::vector<network::Network>& networks = body.diagram.networks;
  for (size_t i = 0; i < networks.size(); ++i) {
    std::string prefix = prefix_of(body);
    const std::string& label = networks[i].label.text;
    if (!label.empty()) {
      prefix += "network " + label + ", ";
    } else if (networks.size() > 1) {
      prefix += "network " + std::to_string(i + 1) + ", ";
    }
    for (UnitPart& part : box_parts(networks[i], prefix)) out.push_back(std::move(part));
  }
  return out;
}

void compare_boxes(const UnitBody& before, const UnitBody& after,
                   std::vector<PartDifference>& out) {
  compare_parts(boxes_of(before), boxes_of(after), out);
}

const char* language_of(const UnitBody& body) {
  static constexpr const char* kNames[] = {"text", "ladder", "FBD"};
  return kNames[static_cast<size_t>(body.kind)];
}

void compare_body(const UnitBody& before, const UnitBody& after, std::vector<PartDifference>& out) {
  if (before.kind != after.kind) {
    out.push_back({"body", after.name, Differs::kEdited, language_of(before), language_of(after)});
  } else if (after.kind == BodyKind::kText) {
    compare_lines(before, after, out);
  } else if (after.kind == BodyKind::kLadder) {
    compare_rungs(before, after, out);
  } else {
    compare_boxes(before, after, out);
  }
}

const UnitBody* body_named(const std::vector<UnitBody>& bodies, const std::string& name) {
  for (const UnitBody& body : bodies) {
    if (ir::same_name(body.name, name)) return &body;
  }
  return nullptr;
}

}  // namespace

void compare_bodies(const std::vector<UnitBody>& before, const std::vector<UnitBody>& after,
                    std::vector<PartDifference>& out) {
  for (const UnitBody& body : after) {
    const UnitBody* const was = body_named(before, body.name);
    if (was != nullptr) {
      compare_body(*was, body, out);
    } else {
      out.push_back({"body", body.name, Differs::kNew, "", language_of(body)});
    }
  }
  for (const UnitBody& body : before) {
    if (body_named(after, body.name) != nullptr) continue;
    out.push_back({"body", body.name, Differs::kRemoved, language_of(body), ""});
  }
}

}  // namespace stc
