// Retained values as bytes: the ranges of Image::retain, one behind the other. Another version's
// are carried over by path and type as a change does it (A14); what is not retained in both begins
// with its initial value.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "ir/bytecode/image.h"

namespace online_change {

// Refused (kTooLarge) above base::kMaxRetainBytes.
base::Result<uint64_t> retained_bytes(const ir::Image& image);

base::Bytes initial_retained(const ir::Image& image);

// From data memory. Allocates nothing when `out` has the capacity.
void copy_retained(const ir::Image& image, const uint8_t* memory, base::Bytes& out);

// `values` of `from` as values of `to`. Both images have been verified, and `values` has the size
// that the layout of `from` asks for. kTooMany when the types are too different to be compared.
base::Result<base::Bytes> carry_retained(const ir::Image& from, base::ByteSpan values,
                                         const ir::Image& to);

// Would a change run migrations? Here they do not run: what they make has its initial value.
bool has_migrations(const ir::Image& from, const ir::Image& to);

// From a trial that was lost, `from`, to the program before it, `to`, whose values were `before`
// when the trial began. As undo does: what the change dropped, and what it converted and nobody
// wrote since, is as it was before.
base::Result<base::Bytes> carry_retained_back(const ir::Image& from, base::ByteSpan values,
                                              const ir::Image& to, base::ByteSpan before);

}  // namespace online_change
