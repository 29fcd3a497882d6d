#include "tools/stvm/agent_order.h"

#include <algorithm>

#include "base/archive.h"
#include "online_change/package/signed_file.h"

namespace stvm {
namespace {

constexpr uint32_t kOrderVersion = 1;
constexpr size_t kMostOrderText = 1024;

constexpr auto agent_file_fields = [](auto& a, auto& file) {
  a(file.digest);
  a(file.size);
};

constexpr auto order_fields = [](auto& a, auto& order) {
  a.enumerator(order.act, kLastAgentAct);
  a(order.plan);
  a(order.wave);
  a(order.note);
  a(order.base);
  agent_file_fields(a, order.fleet);
  agent_file_fields(a, order.package);
  a(order.source);
  a(order.stage_flags);
  a(order.switch_flags);
  a(order.matching);
  a(order.guard);
  a(order.window_ms);
};

base::Error bad_order(const std::string& why) {
  return {base::Refusal::kBadFormat, "order to an agent: " + why};
}

bool is_bounded(const AgentOrder& order) {
  const bool short_texts =
      order.note.size() <= kMostOrderText && order.source.size() <= kMostOrderText;
  const bool small = order.fleet.size <= kMostAgentFile && order.package.size <= kMostAgentFile;
  return short_texts && small && online_change::is_signed_name(order.plan) && order.wave != 0 &&
         order.window_ms >= 0;
}

}  // namespace

base::Bytes encode(const AgentOrder& order) {
  base::WriteArchive out;
  for (const char c : online_change::kOrderMagic) out(static_cast<uint8_t>(c));
  out(kOrderVersion);
  order_fields(out, order);
  return out.take();
}

base::Result<AgentOrder> decode_agent_order(base::ByteSpan bytes) {
  if (!online_change::has_order_magic(bytes)) return bad_order("no magic number");
  base::ReadArchive in(bytes.subspan(online_change::kOrderMagic.size()));
  uint32_t version = 0;
  in(version);
  if (!in.failed() && version != kOrderVersion) {
    return bad_order("version " + std::to_string(version) + ", this program reads " +
                     std::to_string(kOrderVersion));
  }
  AgentOrder order;
  order_fields(in, order);
  if (!in.done() || !is_bounded(order)) return bad_order("it is damaged");
  return order;
}

}  // namespace stvm
