// The gate: only a VerifiedImage can be loaded, and only verify() makes one.
// Rules V1 to V20 of docs/REQUIREMENTS.md in one linear pass over code and tables.
// Invariant: interpreting a VerifiedImage cannot read or write outside the areas,
// frames and pools that it declares, whatever the data says. One thing is left to the
// compiler: that in-outs of a function block are bound anew before each call. An image
// which leaves one bound to a frame that is gone may damage its own data and frames,
// but nothing outside the reserved range (docs/adr/0003, vm/exec/memory.h).
#pragma once

#include <memory>

#include "base/hash.h"
#include "base/result.h"
#include "ir/bytecode/image.h"

namespace ir {

// A scalar %Q variable of the globals, and the task whose code writes it by name.
struct OutputWriter {
  uint32_t data = 0;
  uint32_t size = 0;
  uint32_t task = 0;
};

// What the call graph says (V11, V14).
struct CallFacts {
  std::vector<OutputWriter> writers;
  std::vector<bool> running;  // by POU: is it of a program of a task, or can one call it?
};

class NameIndex;  // name_index.h
class NamesOnDemand;

class VerifiedImage {
 public:
  const Image& image() const { return *image_; }
  const base::Digest& digest() const { return digest_; }
  const base::Bytes& encoded() const { return *encoded_; }
  const std::vector<OutputWriter>& output_writers() const { return calls_->writers; }
  const std::vector<bool>& running_pous() const { return calls_->running; }
  // Made when it is asked for first, in time linear in the names.
  const NameIndex& names() const;

 private:
  friend base::Result<VerifiedImage> verify(std::shared_ptr<const base::Bytes> encoded);
  VerifiedImage() = default;
  std::shared_ptr<const Image> image_;
  std::shared_ptr<const base::Bytes> encoded_;
  std::shared_ptr<const CallFacts> calls_;
  std::shared_ptr<const NamesOnDemand> names_;
  base::Digest digest_{};
};

// Keeps `encoded`. Cost: linear in its size.
base::Result<VerifiedImage> verify(base::Bytes encoded);
// The same for bytes that others hold, too.
base::Result<VerifiedImage> verify(std::shared_ptr<const base::Bytes> encoded);

}  // namespace ir
