// Fleet files: decoded or refused with a reason; what is decoded is stored as it was.
#include <algorithm>

#include "base/check.h"
#include "online_change/package/fleet_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const base::ByteSpan bytes(data, size);
  const auto file = online_change::decode_fleet_file(bytes);
  if (!file.ok()) {
    base::check(!file.error().text.empty(), "a reason");
    return 0;
  }
  const auto again = online_change::decode_fleet_file(online_change::encode(*file));
  base::check(again.ok() && again->author == file->author && again->text == file->text &&
                  again->original == file->original && again->edited == file->edited,
              "the same content comes back");
  return 0;
}
