// Bytes as what they share with other bytes, and the rest: the parts of a change package in its
// short form. An edit of one POU in a large image takes some hundred KiB.
#pragma once

#include <optional>

#include "base/bytes.h"

namespace online_change {

// Time is linear whatever they are; the result is never much longer than `to`.
base::Bytes make_delta(base::ByteSpan from, base::ByteSpan to);
// `to` again, after what is in `out`; nullopt when the delta is damaged, made for other bytes, or
// of more than `limit`.
std::optional<base::Bytes> apply_delta(base::ByteSpan from, base::ByteSpan delta, size_t limit,
                                       base::Bytes out = {});

}  // namespace online_change
