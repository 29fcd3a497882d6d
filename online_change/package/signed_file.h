// A signed file (F-03): an image, a package, a fleet file, a list of revoked keys or an order to an
// agent, wrapped byte for byte, with a statement in front of it that a key has signed. It says
// what the content is, for whom, until when, and where in a plan it stands; its hash binds the
// content. Nothing here checks a signature: who knows keys does (tools/stvm/key_trust.h), by the
// adapter adapters/keys.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace online_change {

using PublicKey = std::array<uint8_t, 32>;  // Ed25519
using Signature = std::array<uint8_t, 64>;
// True: the owner of `key` has signed `message`.
using VerifySignature = bool (*)(const PublicKey& key, base::ByteSpan message,
                                 const Signature& signature);

// Numbers are in files.
enum class SignedKind : uint8_t { kImage = 0, kPackage = 1, kFleet = 2, kRevoked = 3, kOrder = 4 };
inline constexpr uint32_t kSignedKinds = 5;
const char* signed_kind_name(SignedKind kind);  // "image"

inline constexpr size_t kMostSignedName = 64;  // bytes of a plan or target

struct Statement {
  SignedKind kind = SignedKind::kPackage;
  base::Digest key{};      // SHA-256 of the public key
  std::string plan;        // files of one plan come in the order of their sequences
  uint64_t sequence = 0;   // its place in the plan
  int64_t made_s = 0;      // UTC, since 1970
  int64_t expires_s = 0;   // likewise: from then on it is refused
  std::string target;      // the controller that it is for; "": any
  uint64_t size = 0;       // of the content
  base::Digest content{};  // SHA-256
};

struct SignedFile {
  Statement statement;
  base::Bytes message;  // what the signature is of
  Signature signature{};
};

inline constexpr std::string_view kSignedMagic = "STCSIGND";
inline constexpr std::string_view kRevokedMagic = "STCREVOK";
inline constexpr std::string_view kOrderMagic = "STCORDER";  // tools/stvm/agent_order.h
inline constexpr size_t kSignedKindAt = kSignedMagic.size() + 8;  // in the file
bool has_signed_magic(base::ByteSpan bytes);
bool has_order_magic(base::ByteSpan bytes);

base::Digest key_id(const PublicKey& key);
// One to 64 bytes of letters, digits and . _ - : / only; they are printed and compared.
bool is_signed_name(std::string_view name);

// What is to be signed. Equal statements give equal bytes.
base::Bytes message_of(const Statement& statement);
base::Bytes encode(const Statement& statement, const Signature& signature, base::ByteSpan content);
// Takes the statement off `bytes`, which become the content. kBadFormat; kBadHash: the content is
// not what was signed. After an error `bytes` are as they were.
base::Result<SignedFile> open_signed(base::Bytes& bytes);
// The content, whoever signed it, or not signed at all.
base::Status strip_signature(base::Bytes& bytes);

inline constexpr size_t kMostRevoked = 256;  // keys
// The content of SignedKind::kRevoked: all keys that nobody shall trust any more.
base::Bytes encode_revoked(const std::vector<base::Digest>& keys);
base::Result<std::vector<base::Digest>> decode_revoked(base::ByteSpan bytes);

}  // namespace online_change
