#include "adapters/keys/keys.h"

#include <openssl/bio.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/pem.h>

#include <memory>

namespace keys {
namespace {

template <auto free>
struct Free {
  template <class T>
  void operator()(T* of) const {
    free(of);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Context = std::unique_ptr<EVP_MD_CTX, Free<EVP_MD_CTX_free>>;
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;

base::Error failed(const char* what) { return {base::Refusal::kBadKeys, what}; }

// Never asks at a terminal: whoever encrypts a key decrypts it for us.
int no_passphrase(char*, int, int, void*) { return -1; }

Key read_private(std::string_view pem) {
  const Bio in(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  Key key(in ? PEM_read_bio_PrivateKey(in.get(), nullptr, no_passphrase, nullptr) : nullptr);
  if (key && EVP_PKEY_get_id(key.get()) != EVP_PKEY_ED25519) key.reset();
  return key;
}

base::Result<online_change::PublicKey> raw_public(const Key& key) {
  online_change::PublicKey out{};
  size_t size = out.size();
  const bool good =
      key && EVP_PKEY_get_raw_public_key(key.get(), out.data(), &size) == 1 && size == out.size();
  if (!good) return failed("no Ed25519 private key in PEM, or an encrypted one");
  return out;
}

}  // namespace

base::Result<NewKey> make_key() {
  const Key key(EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519"));
  const Bio out(BIO_new(BIO_s_secmem()));
  const bool written = key && out &&
                       PEM_write_bio_PKCS8PrivateKey(out.get(), key.get(), nullptr, nullptr, 0,
                                                     nullptr, nullptr) == 1;
  char* text = nullptr;
  const long size = written ? BIO_get_mem_data(out.get(), &text) : 0;
  if (size <= 0) return failed("OpenSSL cannot make an Ed25519 key");
  base::Result<online_change::PublicKey> public_key = raw_public(key);
  if (!public_key.ok()) return public_key.error();
  return NewKey{std::string(text, static_cast<size_t>(size)), *public_key};
}

base::Result<online_change::PublicKey> public_key_of(std::string_view pem) {
  return raw_public(read_private(pem));
}

base::Result<online_change::Signature> sign(std::string_view pem, base::ByteSpan message) {
  const Key key = read_private(pem);
  if (!key) return failed("no Ed25519 private key in PEM, or an encrypted one");
  const Context context(EVP_MD_CTX_new());
  online_change::Signature out{};
  size_t size = out.size();
  const bool good =
      context && EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key.get()) == 1 &&
      EVP_DigestSign(context.get(), out.data(), &size, message.data(), message.size()) == 1 &&
      size == out.size();
  if (!good) return failed("OpenSSL cannot sign with this key");
  return out;
}

bool verify(const online_change::PublicKey& key, base::ByteSpan message,
            const online_change::Signature& signature) {
  const Key known(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size()));
  const Context context(EVP_MD_CTX_new());
  return known && context &&
         EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, known.get()) == 1 &&
         EVP_DigestVerify(context.get(), signature.data(), signature.size(), message.data(),
                          message.size()) == 1;
}

}  // namespace keys
