#include "online_change/store/edits_record.h"

#include <algorithm>
#include <string_view>

#include "base/digest_reader.h"
#include "base/tool_limits.h"

namespace online_change {
namespace {

constexpr size_t kLeastBytes = 2 * sizeof(base::Digest) + 48;  // of an edit

base::Bytes read_blob(base::ByteReader& in) {
  const base::ByteSpan bytes = in.blob();
  return base::Bytes(bytes.begin(), bytes.end());
}

// E and a number, as a controller makes them: people read it, and it is counted on from there.
bool is_name(std::string_view name) {
  constexpr size_t kMostDigits = 18;
  if (name.size() < 2 || name.size() > 1 + kMostDigits || name[0] != 'E') return false;
  return name.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

}  // namespace

base::Bytes encode(const std::vector<StoredEdit>& edits) {
  base::ByteWriter out;
  out.u32(static_cast<uint32_t>(edits.size()));
  for (const StoredEdit& edit : edits) {
    out.text(edit.name);
    out.text(edit.who);
    out.i64(edit.time_ns);
    out.u64(edit.cycle);
    out.u32(edit.stage_flags);
    out.u32(edit.switch_flags);
    out.raw(edit.from);
    out.raw(edit.to);
    out.blob(edit.package);
    out.u64(edit.retained_cycle);
    out.blob(edit.retained);
  }
  return out.take();
}

std::optional<std::vector<StoredEdit>> decode_edits(base::ByteSpan payload) {
  base::ByteReader in(payload);
  const size_t count = in.count(kLeastBytes);
  if (count > base::kMostEditsOnTrial) return std::nullopt;
  std::vector<StoredEdit> edits(count);
  for (StoredEdit& edit : edits) {
    edit.name = in.text();
    if (!is_name(edit.name)) return std::nullopt;
    edit.who = in.text();
    edit.time_ns = in.i64();
    edit.cycle = in.u64();
    edit.stage_flags = in.u32();
    edit.switch_flags = in.u32();
    edit.from = base::read_digest(in);
    edit.to = base::read_digest(in);
    edit.package = read_blob(in);
    edit.retained_cycle = in.u64();
    edit.retained = read_blob(in);
  }
  if (!in.done()) return std::nullopt;
  return edits;
}

std::vector<StoredEdit> way_between(const std::vector<StoredEdit>& edits,
                                    const base::Digest& boots, const base::Digest& trial) {
  const auto last = std::find_if(edits.rbegin(), edits.rend(),
                                 [&](const StoredEdit& edit) { return edit.to == trial; });
  const auto end = last.base();
  const auto begin =
      std::find_if(edits.begin(), end, [&](const StoredEdit& edit) { return edit.from == boots; });
  for (auto edit = begin; edit != end; ++edit) {
    if (edit != begin && std::prev(edit)->to != edit->from) return {};
  }
  return {begin, end};
}

}  // namespace online_change
