// A change package for a running program, made by the `stc` beside this program.
#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "tools/stvm/compiler.h"

namespace stvm {

struct PackageOptions {
  bool restricted = false;  // D7
  bool matching = false;    // E-13
  size_t step = 0;          // of a fleet file that comes in several, from 1; 0: all of it (E-25)
};

// From the program that runs to what the sources, the image or the fleet file say.
base::Result<base::Bytes> make_package(const Sources& sources, const PackageOptions& options,
                                       base::ByteSpan running);

// Signed by the private key in that file, for one day (F-03).
base::Result<base::Bytes> sign_package(base::ByteSpan package, const std::string& key_file);

}  // namespace stvm
