#include "vm/runtime/asked_values.h"

#include "vm/runtime/live_copy.h"

namespace vm {
namespace {

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
  for (const Kept& kept : kept_) {
    if (kept.version == version.digest() && kept.names == names) return &kept.request;
  }
  base::Result<Request> request = looked_up(version, names);
  if (!request.ok()) return request.error();
  Kept& kept = kept_[oldest_++ % kMostKept];
  kept.version = version.digest();
  kept.names = names;
  kept.request = std::move(*request);
  return &kept.request;
}

}  // namespace vm
