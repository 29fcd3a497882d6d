#include "online_change/apply/lost_places.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <unordered_map>

#include "base/limits.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/symbols.h"
#include "online_change/diff/instance_match.h"

namespace online_change {
namespace {

// Each level of instances may be an element of an array: two separators.
constexpr int kMostParts = 2 * (base::kMaxNesting + 1);

bool is_lost(const FateRow& row) {
  return row.may_lose && (row.fate == Fate::kDropped || row.fate == Fate::kInitialised);
}

struct Range {
  int64_t low = 0;
  uint64_t count = 1;
};

// Reads "0..9" or "7" at `at`.
Range read_range(const std::string& path, size_t& at) {
  const auto number = [&] {
    const size_t begin = at;
    while (at < path.size() && path[at] != '.' && path[at] != ',' && path[at] != ']') ++at;
    return std::strtoll(path.substr(begin, at - begin).c_str(), nullptr, 10);
  };
  Range out{number(), 1};
  if (path.compare(at, 2, "..") == 0) {
    at += 2;
    out.count = static_cast<uint64_t>(number() - out.low) + 1;
  }
  return out;
}

std::vector<Range> ranges_of(const std::string& path) {
  std::vector<Range> out;
  for (size_t at = 0; at < path.size();) {
    if (path[at++] != '[') continue;
    for (bool more = true; more; ++at) {
      out.push_back(read_range(path, at));
      more = at < path.size() && path[at] == ',';
    }
  }
  return out;
}

uint64_t elements_in(const std::string& path) {
  uint64_t all = 1;
  for (const Range& range : ranges_of(path)) all *= range.count;
  return all;
}

class LossFinder {
 public:
  LossFinder(const ir::Image& old_image, const ir::Image& new_image)
      : old_(old_image), new_(new_image), match_(match_instances(old_image, new_image)) {
    retyped_to_.assign(old_.instances.size(), kNoInstance);
    for (uint32_t id = 0; id < match_.retyped_from.size(); ++id) {
      if (match_.retyped_from[id] != kNoInstance) retyped_to_[match_.retyped_from[id]] = id;
    }
    group_of_.assign(old_.instances.size(), 0);
    out_.groups.push_back({0});
    for (const uint32_t id : match_.old_order) {
      if (id != 0) take_in(id);
    }
  }

  void add(const FateRow& row) {
    std::string inside;
    const uint32_t id = instance_of(row.path, inside);
    LostPlaces::Row place{row.fate == Fate::kDropped, group_of_[id], std::move(inside)};
    place.elements = elements_in(place.inside);
    place.outside = row.reason.starts_with(kOutsideBounds);
    const base::Result<ir::Symbol> next = ir::find_symbol(new_names_.of(new_), row.path);
    place.constant = row.fate == Fate::kInitialised && next.ok() && next->constant;
    out_.rows.push_back(std::move(place));
  }
  LostPlaces take() { return std::move(out_); }

 private:
  void take_in(uint32_t id) {
    const std::string path = ir::fold_name(old_.instance_path(id));
    longest_ = std::max(longest_, path.size());
    by_path_.emplace(path, id);
    const auto [found, fresh] =
        groups_.emplace(key_of(id), static_cast<uint32_t>(out_.groups.size()));
    if (fresh) out_.groups.emplace_back();
    group_of_[id] = found->second;
    out_.groups[found->second].push_back(id);
  }

  // Instances that share the rows of the planner. Of those that live on: both types. Of those that
  // go, as wholes: the same name in the same type of owner, and the same type there now.
  std::string key_of(uint32_t id) const {
    const ir::Instance& instance = old_.instances[id];
    const std::string type = std::to_string(instance.type.index);
    if (const uint32_t after = match_.new_of_old[id]; after != kNoInstance) {
      return type + ">" + std::to_string(new_.instances[after].type.index);
    }
    const uint32_t now = retyped_to_[id];
    const uint32_t next = now == kNoInstance ? UINT32_MAX : new_.instances[now].type.index;
    const bool parent_goes = match_.new_of_old[instance.parent] == kNoInstance;
    return type + (parent_goes ? "-" : ".") +
           std::to_string(old_.instances[instance.parent].type.index) + "." +
           ir::fold_name(base_name(instance.name)) + "." + std::to_string(next);
  }

  // The innermost instance on the way to `path`; what is left of it is `inside`.
  uint32_t instance_of(const std::string& path, std::string& inside) const {
    const std::string folded = ir::fold_name(path.substr(0, longest_ + 1));
    size_t end = path.size() <= longest_ ? path.size() : folded.find_last_of(".[");
    for (int part = 0; part < kMostParts && end != std::string::npos && end != 0; ++part) {
      const auto found = by_path_.find(folded.substr(0, end));
      if (found != by_path_.end()) {
        inside = path.substr(end);
        return found->second;
      }
      end = folded.find_last_of(".[", end - 1);
    }
    inside = path;
    return 0;
  }

  const ir::Image& old_;
  const ir::Image& new_;
  ir::NamesOnDemand new_names_;
  InstanceMatch match_;
  std::vector<uint32_t> retyped_to_;  // by old ID
  std::vector<uint32_t> group_of_;    // by old ID
  std::map<std::string, uint32_t> groups_;
  std::unordered_map<std::string, uint32_t> by_path_;
  size_t longest_ = 0;  // of the paths
  LostPlaces out_;
};

}  // namespace

std::string element_of(const std::string& inside, uint64_t number) {
  const std::vector<Range> ranges = ranges_of(inside);
  std::vector<std::string> indices(ranges.size());
  for (size_t i = ranges.size(); i-- > 0;) {
    indices[i] = std::to_string(ranges[i].low + static_cast<int64_t>(number % ranges[i].count));
    number /= ranges[i].count;
  }
  std::string out;
  size_t next = 0;
  for (size_t at = 0; at < inside.size();) {
    out += inside[at];
    if (inside[at++] != '[') continue;
    for (bool more = true; more;) {
      (void)read_range(inside, at);
      out += indices[next++];
      more = at < inside.size() && inside[at] == ',';
      if (more) out += inside[at++];
    }
  }
  return out;
}

LostPlaces lost_places(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image) {
  std::optional<LossFinder> finder;
  for (const FateRow& row : plan.fates) {
    if (!is_lost(row)) continue;
    if (!finder) finder.emplace(old_image, new_image);
    finder->add(row);
  }
  return finder ? finder->take() : LostPlaces();
}

}  // namespace online_change
