#include "tools/stvm/key_trust.h"

#include <algorithm>

#include "tools/common/utc_time.h"
#ifdef STC_HAS_KEYS
#include "adapters/keys/keys.h"
#endif

namespace stvm {

using online_change::PlanMark;
using online_change::SignedFile;
using online_change::SignedKind;
using online_change::Statement;
using online_change::TrustRecord;

namespace {

base::Status check_use(const Statement& statement, SignedKind wanted, const std::string& name) {
  if (statement.kind != wanted) {
    return base::Error{base::Refusal::kOtherTarget,
                       std::string("signed as ") + signed_kind_name(statement.kind) + ", and a " +
                           signed_kind_name(wanted) + " is needed here"};
  }
  if (statement.target.empty() || statement.target == name) return base::Ok{};
  return base::Error{base::Refusal::kOtherTarget,
                     "signed for " + statement.target + ", and this is " +
                         (name.empty() ? "a controller without a name" : name)};
}

base::Status check_revoked(const TrustRecord& record, const base::Digest& key,
                           const std::string& name) {
  if (std::ranges::find(record.revoked, key) == record.revoked.end()) return base::Ok{};
  return base::Error{base::Refusal::kKeyEnded, "key " + name + " is revoked"};
}

// An order takes the place of any order before it, whatever plan each of them is part of.
std::string line_of(const Statement& said) {
  return said.kind == SignedKind::kOrder ? ":orders" : said.plan;
}

PlanMark mark_of(const Statement& said) {
  return {line_of(said), said.sequence, said.made_s, said.content};
}

// A file that was taken last may come again where that does nothing: at a start.
base::Status check_sequence(TrustRecord& record, const Signed& what) {
  const Statement& said = what.statement;
  const PlanMark* const mark = record.find(line_of(said));
  if (mark == nullptr) {
    if (said.made_s > record.dropped_s) return base::Ok{};
    return base::Error{base::Refusal::kReplayed, "signed by " + what.by + " at " +
                                                     tools::utc_text(said.made_s) +
                                                     ": older than plans that are known no more"};
  }
  if (said.sequence > mark->sequence) return base::Ok{};
  const bool same = said.sequence == mark->sequence && said.content == mark->content;
  if (same && said.kind == SignedKind::kImage) return base::Ok{};
  if (said.kind == SignedKind::kOrder) {
    return base::Error{base::Refusal::kReplayed,
                       "signed by " + what.by + " at " + tools::utc_text(said.made_s) +
                           "; a later order was taken, of " + tools::utc_text(mark->made_s)};
  }
  return base::Error{base::Refusal::kReplayed, "signed by " + what.by + " as sequence " +
                                                   std::to_string(said.sequence) + " of plan " +
                                                   said.plan + ", which has come to " +
                                                   std::to_string(mark->sequence)};
}

}  // namespace

base::Result<std::unique_ptr<Trust>> KeyTrust::open(const std::string& path,
                                                    online_change::Store& store,
                                                    online_change::VerifySignature verify) {
  base::Result<tools::TrustFile> file = tools::read_trust_file(path);
  if (!file.ok()) return file.error();
  return std::unique_ptr<Trust>(std::make_unique<KeyTrust>(path, store, verify));
}

base::Result<KeyTrust::Known> KeyTrust::known(int64_t now_s) const {
  base::Result<tools::TrustFile> file = tools::read_trust_file(path_);
  if (!file.ok()) return file.error();
  base::Result<TrustRecord> record = store_.trust();
  if (!record.ok()) return record.error();
  const int64_t latest_s = std::max(now_s, record->latest_s);
  return Known{std::move(*file), std::move(*record), latest_s};
}

base::Result<Signed> KeyTrust::check(const SignedFile& file, SignedKind wanted, int64_t now_s) {
  base::Result<Known> all = known(now_s);
  if (!all.ok()) return all.error();
  base::Result<const tools::TrustedKey*> key =
      tools::check_signature(all->file, file, verify_, all->now_s);
  if (!key.ok()) return key.error();
  Signed out{(*key)->name, file.statement};
  base::Status good = check_revoked(all->record, (*key)->id, out.by);
  if (good.ok()) good = check_use(file.statement, wanted, all->file.name);
  if (good.ok()) good = check_sequence(all->record, out);
  if (!good.ok()) return good.error();
  return out;
}

base::Status KeyTrust::check_again(const Signed& what, int64_t now_s) {
  base::Result<Known> all = known(now_s);
  if (!all.ok()) return all.error();
  const tools::TrustedKey* const key = all->file.find(what.statement.key);
  if (key == nullptr) {
    return base::Error{base::Refusal::kUnknownKey,
                       "signed by key " + what.by + ", which the trust file has no more"};
  }
  base::Status good = tools::check_key(*key, all->now_s);
  return good.ok() ? check_revoked(all->record, key->id, key->name) : good;
}

base::Status KeyTrust::take(const Signed& what, int64_t now_s) {
  base::Status good = check_again(what, now_s);
  if (!good.ok()) return good;
  base::Result<Known> all = known(now_s);
  if (!all.ok()) return all.error();
  const Statement& said = what.statement;
  if (all->now_s >= said.expires_s) {
    return base::Error{base::Refusal::kSignatureExpired,
                       "signed by " + what.by + " until " + tools::utc_text(said.expires_s)};
  }
  good = check_sequence(all->record, what);
  if (!good.ok()) return good;
  all->record.latest_s = all->now_s;
  all->record.mark(mark_of(said));
  return store_.keep_trust(all->record);
}

base::Result<std::string> KeyTrust::revoke(const SignedFile& file, base::ByteSpan content,
                                           int64_t now_s) {
  base::Result<Signed> signer = check(file, SignedKind::kRevoked, now_s);
  if (!signer.ok()) return signer.error();
  base::Result<std::vector<base::Digest>> keys = online_change::decode_revoked(content);
  if (!keys.ok()) return keys.error();
  base::Result<Known> all = known(now_s);
  if (!all.ok()) return all.error();
  std::string names;
  for (const base::Digest& key : *keys) {
    std::vector<base::Digest>& revoked = all->record.revoked;
    if (std::ranges::find(revoked, key) == revoked.end()) revoked.push_back(key);
    const tools::TrustedKey* const trusted = all->file.find(key);
    names +=
        (names.empty() ? "" : ", ") + (trusted != nullptr ? trusted->name : base::short_hex(key));
  }
  if (all->record.revoked.size() > online_change::kMostRevokedKept) {
    return base::Error{base::Refusal::kTooMany, "more than 1,024 revoked keys"};
  }
  all->record.latest_s = all->now_s;
  all->record.mark(mark_of(file.statement));
  base::Status kept = store_.keep_trust(all->record);
  if (!kept.ok()) return kept.error();
  return names + " by " + signer->by;
}

base::Status KeyTrust::take_unsigned(bool local) {
  base::Result<tools::TrustFile> file = tools::read_trust_file(path_);
  if (!file.ok()) return file.error();
  if (local && file->local_unsigned) return base::Ok{};
  return base::Error{base::Refusal::kUnsigned,
                     std::string("nobody has signed it") +
                         (file->local_unsigned ? ", and it comes from another machine" : "")};
}

base::Result<std::unique_ptr<Trust>> make_trust(const std::string& path,
                                                online_change::Store& store) {
#ifdef STC_HAS_KEYS
  return KeyTrust::open(path, store, keys::verify);
#else
  (void)path;
  (void)store;
  return base::Error{base::Refusal::kNoKeys,
                     "--trust: this stvm was built without OpenSSL (package libssl-dev)"};
#endif
}

}  // namespace stvm
