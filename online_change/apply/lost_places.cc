#include "online_change/apply/lost_places.h"

#include <optional>
#include <unordered_map>

#include "online_change/diff/instance_match.h"

namespace online_change {
namespace {

std::string_view base_name(std::string_view name) { return name.substr(0, name.find('[')); }

bool is_lost(const FateRow& row) {
  return row.may_lose && (row.fate == Fate::kDropped || row.fate == Fate::kInitialised);
}

class Finder {
 public:
  Finder(const ir::Image& old_image, const ir::Image& new_image)
      : old_(old_image), new_(new_image), match_(match_instances(old_image, new_image)) {
    by_type_.resize(old_.types.size());
    for (const uint32_t id : match_.old_order) {
      if (id == 0) continue;
      by_path_.emplace(ir::fold_name(old_.instance_path(id)), id);
      by_type_[old_.instances[id].type.index].push_back(id);
    }
    retyped_to_.assign(old_.instances.size(), kNoInstance);
    for (uint32_t id = 0; id < match_.retyped_from.size(); ++id) {
      if (match_.retyped_from[id] != kNoInstance) retyped_to_[match_.retyped_from[id]] = id;
    }
  }

  LostPlace find(uint32_t number, const FateRow& row) const {
    LostPlace out{number, {}, {}};
    const uint32_t first = instance_of(row.path, out.inside);
    if (first == 0) out.instances = {first};
    for (const uint32_t id : by_type_[old_.instances[first].type.index]) {
      if (id == first || is_like(id, first, out.inside.empty())) out.instances.push_back(id);
    }
    return out;
  }

 private:
  // The innermost instance on the way to `path`; what is left of it is `inside`.
  uint32_t instance_of(const std::string& path, std::string& inside) const {
    const std::string folded = ir::fold_name(path);
    for (size_t end = path.size(); end != std::string::npos && end != 0;) {
      const auto found = by_path_.find(folded.substr(0, end));
      if (found != by_path_.end()) {
        inside = path.substr(end);
        return found->second;
      }
      end = path.find_last_of(".[", end - 1);
    }
    inside = path;
    return 0;
  }

  // Do both, which have one type, share a row? Of whole instances those that go in the same way.
  bool is_like(uint32_t id, uint32_t first, bool whole) const {
    const uint32_t after = match_.new_of_old[id];
    const uint32_t first_after = match_.new_of_old[first];
    if (!whole) {
      return after != kNoInstance && first_after != kNoInstance &&
             new_.instances[after].type == new_.instances[first_after].type;
    }
    const ir::Instance& one = old_.instances[id];
    const ir::Instance& other = old_.instances[first];
    return after == kNoInstance && type_after(id) == type_after(first) &&
           old_.instances[one.parent].type == old_.instances[other.parent].type &&
           ir::same_name(base_name(one.name), base_name(other.name)) && parent_lives_on(one);
  }
  std::optional<ir::TypeId> type_after(uint32_t id) const {
    if (retyped_to_[id] == kNoInstance) return std::nullopt;
    return new_.instances[retyped_to_[id]].type;
  }
  bool parent_lives_on(const ir::Instance& instance) const {
    return instance.parent == 0 || match_.new_of_old[instance.parent] != kNoInstance;
  }

  const ir::Image& old_;
  const ir::Image& new_;
  InstanceMatch match_;
  std::vector<uint32_t> retyped_to_;  // by old ID
  std::unordered_map<std::string, uint32_t> by_path_;
  std::vector<std::vector<uint32_t>> by_type_;  // old IDs, parents first
};

}  // namespace

std::string LostPlace::path(const ir::Image& old_image, size_t number) const {
  const uint32_t id = instances[number];
  return id == 0 ? inside : old_image.instance_path(id) + inside;
}

std::vector<LostPlace> lost_places(const Plan& plan, const ir::Image& old_image,
                                   const ir::Image& new_image) {
  std::vector<LostPlace> out;
  std::optional<Finder> finder;
  for (uint32_t i = 0; i < plan.fates.size(); ++i) {
    if (!is_lost(plan.fates[i])) continue;
    if (!finder) finder.emplace(old_image, new_image);
    out.push_back(finder->find(i, plan.fates[i]));
  }
  return out;
}

}  // namespace online_change
