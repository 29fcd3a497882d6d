#include "vm/runtime/asked_values.h"

#include <algorithm>

#include "vm/runtime/live_copy.h"

namespace vm {
namespace {

// Several tools may watch. A request's size is bounded by that of a message.
constexpr size_t kMostKept = 4;

base::Error too_much(const std::string& name) {
  return {base::Refusal::kTooMany, "one request reads " + std::to_string(kMaxReadBytes) +
                                       " bytes of variables; with `" + name +
                                       "` it would be more: name fewer of them, or parts"};
}

base::Result<AskedValues::Request> looked_up(const ir::VerifiedImage& version,
                                             const std::vector<std::string>& names) {
  AskedValues::Request out;
  ir::ValueRanges ranges(version.image(), kMaxReadBytes);
  for (const std::string& name : names) {
    base::Result<ir::NamedSymbol> named = ir::named_symbol(version.names(), name);
    if (!named.ok()) return named.error();
    if (!ranges.add(named->symbol)) return too_much(named->path);
    std::string type = ir::type_text(version.image(), named->symbol);
    out.variables.push_back({std::move(*named), std::move(type)});
  }
  out.ranges = ranges.take();
  return out;
}

}  // namespace

base::Result<const AskedValues::Request*> AskedValues::find(const ir::VerifiedImage& version,
                                                            const std::vector<std::string>& names) {
  const auto again = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
    return kept.version == version.digest() && kept.names == names;
  });
  if (again != kept_.end()) {
    std::rotate(again, again + 1, kept_.end());
    return &kept_.back().request;
  }
  base::Result<Request> request = looked_up(version, names);
  if (!request.ok()) return request.error();
  if (kept_.size() == kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({version.digest(), names, std::move(*request)});
  return &kept_.back().request;
}

}  // namespace vm
