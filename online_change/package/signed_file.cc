// The stored form: 8 bytes magic, u32 version, the statement as a blob, 64 bytes signature, and the
// content to the end of the file. The signature is of the magic, the version and the statement: so
// no other thing that such a key signs can pass for it.
#include "online_change/package/signed_file.h"

#include <algorithm>

#include "base/digest_reader.h"

namespace online_change {
namespace {

constexpr uint32_t kSignedVersion = 1;
constexpr const char* kSignedKindNames[kSignedKinds] = {
    "image", "package", "fleet file", "list of revoked keys", "order to an agent"};

base::Error bad_signed(const std::string& text) {
  return {base::Refusal::kBadFormat, "signed file: " + text};
}

bool begins_with(base::ByteSpan bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

base::Bytes statement_bytes(const Statement& statement) {
  base::ByteWriter out;
  out.u8(static_cast<uint8_t>(statement.kind));
  out.raw(statement.key);
  out.text(statement.plan);
  out.u64(statement.sequence);
  out.i64(statement.made_s);
  out.i64(statement.expires_s);
  out.text(statement.target);
  out.u64(statement.size);
  out.raw(statement.content);
  return out.take();
}

std::string read_name(base::ByteReader& in, bool may_be_empty) {
  const base::ByteSpan bytes = in.blob();
  std::string name(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(
                                                      std::min(bytes.size(), kMostSignedName + 1)));
  if (!is_signed_name(name) && !(may_be_empty && name.empty())) in.fail();
  return name;
}

base::Result<Statement> read_statement(base::ByteSpan bytes) {
  base::ByteReader in(bytes);
  Statement out;
  out.kind = in.enumerator<SignedKind>(kSignedKinds);
  out.key = base::read_digest(in);
  out.plan = read_name(in, false);
  out.sequence = in.u64();
  out.made_s = in.i64();
  out.expires_s = in.i64();
  out.target = read_name(in, true);
  out.size = in.u64();
  out.content = base::read_digest(in);
  if (!in.done()) return bad_signed("its statement is damaged");
  return out;
}

}  // namespace

const char* signed_kind_name(SignedKind kind) {
  return kSignedKindNames[static_cast<size_t>(kind)];
}

bool has_signed_magic(base::ByteSpan bytes) { return begins_with(bytes, kSignedMagic); }

bool has_order_magic(base::ByteSpan bytes) { return begins_with(bytes, kOrderMagic); }

base::Digest key_id(const PublicKey& key) { return base::sha256(key); }

bool is_signed_name(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || c == ':' || c == '/';
  };
  return !name.empty() && name.size() <= kMostSignedName && std::ranges::all_of(name, fits);
}

base::Bytes message_of(const Statement& statement) {
  base::ByteWriter out;
  out.raw(base::as_bytes(kSignedMagic));
  out.u32(kSignedVersion);
  out.blob(statement_bytes(statement));
  return out.take();
}

base::Bytes encode(const Statement& statement, const Signature& signature, base::ByteSpan content) {
  base::ByteWriter out;
  out.raw(message_of(statement));
  out.raw(signature);
  out.raw(content);
  return out.take();
}

base::Result<SignedFile> open_signed(base::Bytes& bytes) {
  if (!has_signed_magic(bytes)) return bad_signed("no magic number");
  base::ByteReader in(bytes);
  in.raw(kSignedMagic.size());
  const uint32_t version = in.u32();
  if (!in.failed() && version != kSignedVersion) {
    return bad_signed("version " + std::to_string(version) + ", this program reads " +
                      std::to_string(kSignedVersion));
  }
  base::Result<Statement> statement = read_statement(in.blob());
  const size_t message = in.at();
  const base::ByteSpan signature = in.raw(sizeof(Signature));
  if (in.failed()) return bad_signed("only " + std::to_string(bytes.size()) + " bytes");
  if (!statement.ok()) return statement.error();
  const base::ByteSpan content = in.raw(in.left());
  if (content.size() != statement->size || base::sha256(content) != statement->content) {
    return base::Error{base::Refusal::kBadHash, "signed file: its content is not what was signed"};
  }
  SignedFile out{std::move(*statement), {}, {}};
  const auto begin = bytes.begin();
  out.message.assign(begin, begin + static_cast<ptrdiff_t>(message));
  std::ranges::copy(signature, out.signature.begin());
  bytes.erase(begin, begin + static_cast<ptrdiff_t>(message + sizeof(Signature)));
  return out;
}

base::Status strip_signature(base::Bytes& bytes) {
  if (!has_signed_magic(bytes)) return base::Ok{};
  base::Result<SignedFile> opened = open_signed(bytes);
  if (!opened.ok()) return opened.error();
  return base::Ok{};
}

base::Bytes encode_revoked(const std::vector<base::Digest>& keys) {
  base::ByteWriter out;
  out.raw(base::as_bytes(kRevokedMagic));
  out.u32(static_cast<uint32_t>(keys.size()));
  for (const base::Digest& key : keys) out.raw(key);
  return out.take();
}

base::Result<std::vector<base::Digest>> decode_revoked(base::ByteSpan bytes) {
  if (!begins_with(bytes, kRevokedMagic)) return bad_signed("it holds no list of revoked keys");
  base::ByteReader in(bytes.subspan(kRevokedMagic.size()));
  const uint32_t count = in.count(sizeof(base::Digest));
  if (count > kMostRevoked) return bad_signed("more than 256 revoked keys");
  std::vector<base::Digest> out;
  for (uint32_t left = count; left != 0; --left) out.push_back(base::read_digest(in));
  if (!in.done()) return bad_signed("its list of revoked keys is damaged");
  return out;
}

}  // namespace online_change
