#include "online_change/apply/lost_places.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>

#include "base/limits.h"
#include "online_change/diff/instance_match.h"

namespace online_change {
namespace {

// Each level of instances may be an element of an array: two separators.
constexpr int kMostParts = 2 * (base::kMaxNesting + 1);

std::string_view base_name(std::string_view name) { return name.substr(0, name.find('[')); }

bool is_lost(const FateRow& row) {
  return row.may_lose && (row.fate == Fate::kDropped || row.fate == Fate::kInitialised);
}

class Finder {
 public:
  Finder(const ir::Image& old_image, const ir::Image& new_image)
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

  void add(uint32_t fate, const std::string& path) {
    std::string inside;
    const uint32_t id = instance_of(path, inside);
    out_.rows.push_back({fate, group_of_[id], std::move(inside)});
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
  InstanceMatch match_;
  std::vector<uint32_t> retyped_to_;  // by old ID
  std::vector<uint32_t> group_of_;    // by old ID
  std::map<std::string, uint32_t> groups_;
  std::unordered_map<std::string, uint32_t> by_path_;
  size_t longest_ = 0;  // of the paths
  LostPlaces out_;
};

}  // namespace

uint64_t LostPlaces::count() const {
  uint64_t all = 0;
  for (const Row& row : rows) all += groups[row.group].size();
  return all;
}

LostPlaces lost_places(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image) {
  std::optional<Finder> finder;
  for (uint32_t i = 0; i < plan.fates.size(); ++i) {
    if (!is_lost(plan.fates[i])) continue;
    if (!finder) finder.emplace(old_image, new_image);
    finder->add(i, plan.fates[i].path);
  }
  return finder ? finder->take() : LostPlaces();
}

}  // namespace online_change
