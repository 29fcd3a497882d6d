// Who may bring a program to a controller (F-03). One that has no keys takes what is signed and
// what is not; with keys, everything that brings a program is asked about here, and nothing else
// lets one in (docs/adr/0043-keys.md has all ways). Nothing of OpenSSL is known here.
#pragma once

#include <optional>
#include <string>

#include "online_change/package/signed_file.h"

namespace stvm {

struct Signed {
  std::string by;  // name of the key
  online_change::Statement statement;
  bool taken = false;  // it is stored that it was
};
using Signer = std::optional<Signed>;  // nullopt: nobody has signed it

// The keys of a controller: KeyTrust, in a build that has keys. Times are UTC, since 1970. Errors
// say why nothing was taken: kUnknownKey, kBadSignature, kKeyEnded, kSignatureExpired, kReplayed,
// kOtherTarget, kBadKeys, kStorageFailed.
class Trust {
 public:
  virtual ~Trust() = default;
  // Of a file of that kind; changes nothing.
  virtual base::Result<Signed> check(const online_change::SignedFile& file,
                                     online_change::SignedKind wanted, int64_t now_s) = 0;
  // What was checked is about to run: checked again, and durable that it was taken, so that it is
  // not taken twice.
  virtual base::Status take(const Signed& what, int64_t now_s) = 0;
  // What was taken comes again by a decision here (redo): is its key trusted still?
  virtual base::Status check_again(const Signed& what, int64_t now_s) = 0;
  // The names of those whose keys are revoked now, durably.
  virtual base::Result<std::string> revoke(const online_change::SignedFile& file,
                                           base::ByteSpan content, int64_t now_s) = 0;
  // By the policy; kUnsigned. `local`: from this machine, not over a bridge.
  virtual base::Status take_unsigned(bool local) = 0;
};

class Admission {
 public:
  // Null: there are no keys. It must outlive this.
  explicit Admission(Trust* trust) : trust_(trust) {}

  // Takes the signature off `file`, which is a package, and checks it.
  base::Result<Signer> open(base::Bytes& file, bool local, int64_t now_ns) const;
  // What open() or bring_again() has let in is about to run. Once it is taken, it may be so again.
  base::Status take(Signer& signer, int64_t now_ns) const;
  // It was taken before, and is to be staged again.
  base::Result<Signer> bring_again(Signer signer, bool local, int64_t now_ns) const;
  // A list of revoked keys, which open() would not take. Nullopt: `file` is something else, or
  // there are no keys.
  std::optional<base::Result<std::string>> revoke(base::ByteSpan file, int64_t now_ns) const;

 private:
  Trust* trust_;
};

// "signed by office (plan p1, sequence 5)"; "" for what nobody has signed.
std::string signer_text(const Signer& signer);

}  // namespace stvm
