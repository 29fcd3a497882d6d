// The trust file of a controller (`stvm serve --trust`, `stc key verify --trust`): which keys it
// takes programs from, each with a name and its time. A text in the subset of TOML of toml.h.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "online_change/package/signed_file.h"

namespace tools {

inline constexpr size_t kMostTrustedKeys = 256;
inline constexpr uint64_t kMostTrustBytes = 1 << 18;  // of the file

struct TrustedKey {
  std::string name;  // as messages call it
  online_change::PublicKey key{};
  base::Digest id{};
  int64_t from_s = 0;           // UTC, since 1970
  int64_t until_s = INT64_MAX;  // from then on nobody trusts it
  bool revokes = false;         // signs lists of revoked keys
};

struct TrustFile {
  std::string name;             // of the controller, which targets are compared with
  bool local_unsigned = false;  // policy: who asks on this machine needs no signature
  std::vector<TrustedKey> keys;
  const TrustedKey* find(const base::Digest& id) const;
};

// Errors: kBadKeys with file, line and column.
base::Result<TrustFile> parse_trust_file(std::string_view file, std::string_view text);
// Those of read_text() too.
base::Result<TrustFile> read_trust_file(const std::string& path);
// The key that has signed it and may, at that time: kUnknownKey, kBadSignature, kKeyEnded,
// kSignatureExpired. It borrows from `trust`.
base::Result<const TrustedKey*> check_signature(const TrustFile& trust,
                                                const online_change::SignedFile& file,
                                                online_change::VerifySignature verify,
                                                int64_t now_s);
// Is it in its time? kKeyEnded.
base::Status check_key(const TrustedKey& key, int64_t now_s);
// The lines of one key.
std::string trust_lines(const TrustedKey& key);

}  // namespace tools
