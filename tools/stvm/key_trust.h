// The keys of a controller: the trust file, which is read again for each file that comes, so that
// keys come and go while the program runs; and what is stored of earlier files (trust_record.h).
// What cannot be read lets nothing in. Verifying is the adapter's.
#pragma once

#include <memory>
#include <string>

#include "online_change/store/store.h"
#include "tools/common/trust_file.h"
#include "tools/stvm/admission.h"

namespace stvm {

class KeyTrust : public Trust {
 public:
  // Of a trust file that can be read; open() makes sure of it. `store` must outlive it.
  KeyTrust(std::string path, online_change::Store& store, online_change::VerifySignature verify)
      : path_(std::move(path)), store_(store), verify_(verify) {}
  // Errors: those of read_trust_file().
  static base::Result<std::unique_ptr<Trust>> open(const std::string& path,
                                                   online_change::Store& store,
                                                   online_change::VerifySignature verify);

  base::Result<Signed> check(const online_change::SignedFile& file,
                             online_change::SignedKind wanted, int64_t now_s) override;
  base::Status take(const Signed& what, int64_t now_s) override;
  base::Status check_again(const Signed& what, int64_t now_s) override;
  base::Result<std::string> revoke(const online_change::SignedFile& file, base::ByteSpan content,
                                   int64_t now_s) override;
  base::Status take_unsigned(bool local) override;

 private:
  struct Known {
    tools::TrustFile file;
    online_change::TrustRecord record;
    int64_t now_s = 0;  // not before what was seen at last
  };
  base::Result<Known> known(int64_t now_s) const;

  std::string path_;
  online_change::Store& store_;
  online_change::VerifySignature verify_;
};

// With this build's adapter. kNoKeys: it has none.
base::Result<std::unique_ptr<Trust>> make_trust(const std::string& path,
                                                online_change::Store& store);

}  // namespace stvm
