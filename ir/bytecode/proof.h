// What verify() has found out of an image, so that the next version of the same program is not
// proven anew where it is the same. The answer is that of a verification without it: before a part
// is left out, everything that this part reads is compared. docs/adr/0029-proofs.md has the list.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "ir/bytecode/constant_range.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/image_beside.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/verify.h"
#include "ir/bytecode/verify_parts.h"

namespace ir::verification {

struct Proof {
  std::shared_ptr<const base::Bytes> encoded;
  Image image;  // the same, decoded
  ImagePlaces places;
  std::shared_ptr<const std::vector<TypeFacts>> types;
  std::shared_ptr<const RegionMap> regions;  // borrows the image's types and layouts
  std::shared_ptr<const std::vector<uint32_t>> areas;
  CodeFactsOfAll code;
  CallFacts calls;
  NamesOnDemand names;
};

// All rules, without those whose answer `like` knows; null: it knows none.
base::Result<std::shared_ptr<const Proof>> prove(std::shared_ptr<const base::Bytes> encoded,
                                                 const Proof* like);

// What an image has in common with one that was proven. Borrows both.
class Likeness {
 public:
  Likeness(const Proof* like, base::ByteSpan encoded, const Image& image);

  // Types and their layouts.
  bool types() const { return types_; }
  // Types and initial values.
  bool constants() const { return constants_; }
  // Types and layouts are the same objects: whatever borrows them can be shared.
  bool regions() const;
  // Slots of a POU, in a frame of the same size.
  bool slots(uint32_t pou) const;
  // Whatever the verification of bounds and ranges reads.
  bool bounds() const;
  bool ranges() const;
  // Whatever verify_instances() reads.
  bool instances() const { return instances_; }
  // Whatever verify_calls() reads; `code` is of the image.
  bool calls(const CodeFactsOfAll& code) const;
  // The facts of a POU with the same code, which names nothing that is another; null: it must be
  // looked at.
  std::shared_ptr<const CodeFacts> code(uint32_t pou) const;

 private:
  bool same_roles() const;
  bool same_code(uint32_t pou) const;
  void find_changed_parameters();
  bool is_same_constant(const Extent& bytes) const;

  const Proof* like_;
  const Image& image_;
  bool types_ = false;
  bool constants_ = false;
  bool instances_ = false;
  bool code_ = false;                 // POUs can be the same
  std::vector<bool> new_parameters_;  // by POU: callers find other slots
  ConstantRange changed_;
  size_t same_bounds_ = 0;  // so many rows
};

}  // namespace ir::verification
