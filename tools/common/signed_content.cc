#include "tools/common/signed_content.h"

#include "tools/common/files.h"

namespace tools {

bool is_signed_as(const std::string& path, online_change::SignedKind kind) {
  if (!is_file(path)) return false;
  base::Result<base::Bytes> first = read_first(path, online_change::kSignedKindAt + 1);
  return first.ok() && first->size() > online_change::kSignedKindAt &&
         online_change::has_signed_magic(*first) && first->back() == static_cast<uint8_t>(kind);
}

base::Result<base::Bytes> read_content(const std::string& path) {
  base::Result<base::Bytes> bytes = read_bytes(path);
  if (!bytes.ok()) return bytes;
  base::Status stripped = online_change::strip_signature(*bytes);
  if (!stripped.ok())
    return base::Error{stripped.error().refusal, path + ": " + stripped.error().text};
  return bytes;
}

}  // namespace tools
