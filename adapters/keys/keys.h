// Ed25519 by OpenSSL (libcrypto): keys are made, and sign and verify what others say. Private keys
// are PEM files as `openssl pkey` has them (PKCS #8). Nothing is kept between calls, and calls may
// come from any thread.
#pragma once

#include <string>
#include <string_view>

#include "online_change/package/signed_file.h"

namespace keys {

struct NewKey {
  std::string pem;  // the private key, not encrypted
  online_change::PublicKey public_key{};
};
// kBadKeys: OpenSSL cannot.
base::Result<NewKey> make_key();

// kBadKeys: no Ed25519 key in PEM.
base::Result<online_change::PublicKey> public_key_of(std::string_view pem);
base::Result<online_change::Signature> sign(std::string_view pem, base::ByteSpan message);

// Of any bytes; an online_change::VerifySignature.
bool verify(const online_change::PublicKey& key, base::ByteSpan message,
            const online_change::Signature& signature);

}  // namespace keys
