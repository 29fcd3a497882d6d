// Retained values as bytes: the ranges of Image::retain, one after the other. Another version's
// are carried over by path and type as a change does it (A14); what is not retained in both begins
// with its initial value.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "ir/bytecode/verify.h"

namespace online_change {

// Refused (kTooLarge) above base::kMaxRetainBytes.
base::Result<uint64_t> retained_bytes(const ir::Image& image);

base::Bytes initial_retained(const ir::Image& image);

// From data memory. Allocates nothing when `out` has the capacity.
void copy_retained(const ir::Image& image, const uint8_t* memory, base::Bytes& out);

struct CarriedValues {
  base::Bytes values;
  std::string alarm;  // what migrations could not make; "": all of it
};

// `values` of `from` as values of `to`, whose migrations run on them. `values` has the size that
// the layout of `from` asks for. What a migration cannot make, because it traps, does not end, or
// reads what is not retained, has its initial value. kTooMany when the types are too different to
// be compared.
base::Result<CarriedValues> carry_retained(const ir::VerifiedImage& from, base::ByteSpan values,
                                           const ir::VerifiedImage& to);

// From a trial that was lost, `from`, to the program before it, `to`, whose values were `before`
// when the trial began. As undo does: what the change dropped, and what it made and nobody wrote
// since, is as it was before; where the trial's program wrote what an inverse migration reads, that
// runs. What it cannot make is as it was before.
base::Result<CarriedValues> carry_retained_back(const ir::VerifiedImage& from,
                                                base::ByteSpan values, const ir::VerifiedImage& to,
                                                base::ByteSpan before);

}  // namespace online_change
