#include "tools/stvm/admission.h"

namespace stvm {

using online_change::SignedFile;
using online_change::SignedKind;

static constexpr int64_t kSecond = 1'000'000'000;

base::Result<Signer> Admission::open(base::Bytes& file, bool local, int64_t now_ns) const {
  if (!online_change::has_signed_magic(file)) {
    base::Status may = trust_ == nullptr ? base::Status(base::Ok{}) : trust_->take_unsigned(local);
    if (!may.ok()) return may.error();
    return Signer();
  }
  base::Result<SignedFile> opened = online_change::open_signed(file);
  if (!opened.ok()) return opened.error();
  if (trust_ == nullptr && opened->statement.kind == SignedKind::kRevoked) {
    return base::Error{base::Refusal::kBadKeys, "this controller was started without --trust"};
  }
  if (trust_ == nullptr) return Signer();
  base::Result<Signed> signer = trust_->check(*opened, SignedKind::kPackage, now_ns / kSecond);
  if (!signer.ok()) return signer.error();
  return Signer(std::move(*signer));
}

base::Status Admission::take(Signer& signer, int64_t now_ns) const {
  if (trust_ == nullptr || !signer) return base::Ok{};
  if (signer->taken) return trust_->check_again(*signer, now_ns / kSecond);
  base::Status taken = trust_->take(*signer, now_ns / kSecond);
  signer->taken = taken.ok();
  return taken;
}

base::Result<Signer> Admission::bring_again(Signer signer, bool local, int64_t now_ns) const {
  if (trust_ == nullptr) return signer;
  base::Status may =
      signer ? trust_->check_again(*signer, now_ns / kSecond) : trust_->take_unsigned(local);
  if (!may.ok()) return may.error();
  if (signer) signer->taken = true;
  return signer;
}

std::optional<base::Result<std::string>> Admission::revoke(base::ByteSpan file,
                                                           int64_t now_ns) const {
  if (trust_ == nullptr || !online_change::has_signed_magic(file)) return std::nullopt;
  base::Bytes content(file.begin(), file.end());
  base::Result<SignedFile> opened = online_change::open_signed(content);
  if (!opened.ok() || opened->statement.kind != SignedKind::kRevoked) return std::nullopt;
  return trust_->revoke(*opened, content, now_ns / kSecond);
}

std::string signer_text(const Signer& signer) {
  if (!signer) return {};
  return "signed by " + signer->by + " (plan " + signer->statement.plan + ", sequence " +
         std::to_string(signer->statement.sequence) + ")";
}

}  // namespace stvm
