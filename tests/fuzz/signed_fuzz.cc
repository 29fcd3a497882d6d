// Signed files, lists of revoked keys, and the stored record of them: decoded or refused with a
// reason; what is decoded is written as it was.
#include <algorithm>

#include "base/check.h"
#include "online_change/package/signed_file.h"
#include "online_change/store/trust_record.h"

namespace {

void check_stored(base::ByteSpan bytes) {
  if (const auto keys = online_change::decode_revoked(bytes); keys.ok()) {
    base::check(std::ranges::equal(online_change::encode_revoked(*keys), bytes),
                "a list is written as it was");
  }
  if (const auto record = online_change::decode_trust(bytes)) {
    base::check(std::ranges::equal(online_change::encode(*record), bytes),
                "a record is written as it was");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const base::ByteSpan bytes(data, size);
  check_stored(bytes);
  base::Bytes content(bytes.begin(), bytes.end());
  const auto file = online_change::open_signed(content);
  if (!file.ok()) {
    base::check(!file.error().text.empty(), "a reason");
    base::check(std::ranges::equal(content, bytes), "what was not opened is as it was");
    return 0;
  }
  const base::Bytes again = online_change::encode(file->statement, file->signature, content);
  base::check(std::ranges::equal(again, bytes), "the same file comes back");
  base::check(file->message == online_change::message_of(file->statement),
              "what is signed is what was read");
  check_stored(content);
  return 0;
}
