#include <algorithm>
#include <limits>

#include "frontend/network/order.h"

namespace frontend::network {
namespace {

constexpr uint32_t kNoGroup = std::numeric_limits<uint32_t>::max();

// Union-find.
class Sets {
 public:
  explicit Sets(size_t count) : parents_(count) {
    for (uint32_t i = 0; i < count; ++i) parents_[i] = i;
  }
  uint32_t find(uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parents_;
};

class Splitter {
 public:
  Splitter(const Network& all, std::span<const Precedence> precedences)
      : all_(all),
        precedences_(precedences),
        sets_(all.elements.size()),
        number_(all.elements.size(), kNoGroup) {
    for (uint32_t i = 0; i < all.elements.size(); ++i) join(i);
    for (Precedence each : precedences) sets_.join(each.first, each.second);
  }

  std::vector<Part> run() {
    find_parts();
    const bool given = std::all_of(parts_.begin(), parts_.end(),
                                   [](const Group& group) { return group.last_order != 0; });
    std::stable_sort(parts_.begin(), parts_.end(), [given](const Group& a, const Group& b) {
      return given ? a.first_order < b.first_order : a.top < b.top;
    });
    if (given) merge_overlapping();
    std::vector<Part> out;
    out.reserve(parts_.size());
    for (const Group& group : parts_) out.push_back(part(group));
    return out;
  }

 private:
  struct Group {
    std::vector<uint32_t> members;  // without rails
    int32_t top = 0;
    uint32_t first_order = kNoGroup;  // of those that have one
    uint32_t last_order = 0;
    uint32_t left = kNoGroup;  // rails of the drawing
    uint32_t right = kNoGroup;
    std::vector<Link> ends;  // what is linked to the right rail
    std::vector<Precedence> precedences;
  };

  void join(uint32_t i) {
    if (is_rail(all_.elements[i])) return;
    for (const Input& input : all_.elements[i].inputs) {
      for (Link link : input.from) {
        if (!is_rail(all_.elements[link.element])) sets_.join(i, link.element);
      }
    }
  }

  void find_parts() {
    std::vector<uint32_t> part_of(all_.elements.size(), kNoGroup);  // by set
    for (uint32_t i = 0; i < all_.elements.size(); ++i) {
      const Element& element = all_.elements[i];
      if (is_rail(element)) continue;
      uint32_t& index = part_of[sets_.find(i)];
      if (index == kNoGroup) {
        index = static_cast<uint32_t>(parts_.size());
        parts_.emplace_back();
        parts_.back().top = element.position.y;
      }
      Group& group = parts_[index];
      group.top = std::min(group.top, element.position.y);
      group.members.push_back(i);
      if (element.order != 0) {
        group.first_order = std::min(group.first_order, element.order);
        group.last_order = std::max(group.last_order, element.order);
      }
      for (const Input& input : element.inputs) {
        for (Link link : input.from) {
          if (is_rail(all_.elements[link.element])) group.left = link.element;
        }
      }
    }
    for (Precedence each : precedences_) {
      parts_[part_of[sets_.find(each.first)]].precedences.push_back(each);
    }
    for (uint32_t i = 0; i < all_.elements.size(); ++i) {
      if (all_.elements[i].kind != Kind::kRightRail) continue;
      for (const Input& input : all_.elements[i].inputs) {
        for (Link link : input.from) {
          if (is_rail(all_.elements[link.element])) continue;
          Group& group = parts_[part_of[sets_.find(link.element)]];
          group.right = i;
          group.ends.push_back(link);
        }
      }
    }
  }

  // Parts that are executed in turns are one.
  void merge_overlapping() {
    std::vector<Group> merged;
    for (Group& group : parts_) {
      if (merged.empty() || merged.back().last_order < group.first_order) {
        merged.push_back(std::move(group));
        continue;
      }
      Group& into = merged.back();
      into.last_order = std::max(into.last_order, group.last_order);
      into.left = std::min(into.left, group.left);
      into.right = std::min(into.right, group.right);
      into.members.insert(into.members.end(), group.members.begin(), group.members.end());
      into.ends.insert(into.ends.end(), group.ends.begin(), group.ends.end());
      into.precedences.insert(into.precedences.end(), group.precedences.begin(),
                              group.precedences.end());
    }
    for (Group& group : merged) std::sort(group.members.begin(), group.members.end());
    parts_ = std::move(merged);
  }

  Part part(const Group& group) {
    Part out;
    if (group.left != kNoGroup) out.from.push_back(group.left);
    for (uint32_t member : group.members) {
      number_[member] = static_cast<uint32_t>(out.from.size());
      out.from.push_back(member);
    }
    if (group.right != kNoGroup) out.from.push_back(group.right);
    for (uint32_t from : out.from) out.network.elements.push_back(all_.elements[from]);
    for (Element& element : out.network.elements) {
      if (element.kind == Kind::kLeftRail) element.outputs.resize(1);
      if (element.kind == Kind::kRightRail) {
        element.inputs.resize(1);
        element.inputs[0].from = group.ends;
      }
      for (Input& input : element.inputs) {
        for (Link& link : input.from) {
          const bool rail = is_rail(all_.elements[link.element]);
          link = rail ? Link{0, 0} : Link{number_[link.element], link.output};
        }
      }
    }
    for (Precedence each : group.precedences) {
      out.precedences.push_back({number_[each.first], number_[each.second]});
    }
    return out;
  }

  const Network& all_;
  std::span<const Precedence> precedences_;
  Sets sets_;
  std::vector<uint32_t> number_;  // of an element in its part
  std::vector<Group> parts_;
};

int32_t bottom_of(const Part& part) {
  int32_t bottom = std::numeric_limits<int32_t>::min();
  for (const Element& element : part.network.elements) {
    if (is_rail(element)) continue;
    const int64_t end = int64_t{element.position.y} + std::max(element.position.height, 0);
    bottom = std::max(
        bottom, static_cast<int32_t>(std::min<int64_t>(end, std::numeric_limits<int32_t>::max())));
  }
  return bottom;
}

}  // namespace

std::vector<Part> split(const Network& all, std::span<const Precedence> precedences) {
  return Splitter(all, precedences).run();
}

std::vector<int32_t> ends_of(const std::vector<Part>& parts) {
  std::vector<int32_t> out;
  int32_t end = std::numeric_limits<int32_t>::min();
  for (const Part& part : parts) out.push_back(end = std::max(end, bottom_of(part)));
  return out;
}

size_t place_between(const std::vector<int32_t>& ends, int32_t y) {
  const auto at = std::lower_bound(ends.begin(), ends.end(), y);
  if (at == ends.end()) return ends.empty() ? 0 : ends.size() - 1;
  return static_cast<size_t>(at - ends.begin());
}

}  // namespace frontend::network
