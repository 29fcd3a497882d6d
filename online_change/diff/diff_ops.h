// Building blocks of a TypeDiff: moving, repeating and joining operations.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "online_change/diff/type_diff.h"

namespace online_change {

// More pieces than this in one pair of types is refused.
inline constexpr size_t kMaxDiffOps = 4'000'000;

FateRow make_row(Fate fate, std::string path, std::string old_type, std::string new_type,
                 std::string reason, uint64_t count);
DiffOp make_op(DiffKind kind, uint32_t from, uint32_t to, uint32_t size, uint64_t leaves);

// Repeats the operations for `count` neighbours. False: too many pieces.
bool repeat(std::vector<DiffOp>& ops, uint64_t count, uint32_t from_stride, uint32_t to_stride);
void shift(std::vector<DiffOp>& ops, uint32_t from, uint32_t to);
// Sorts by target and joins unchanged neighbours that move by the same distance.
void join(std::vector<DiffOp>& ops);
// Takes `size` bytes at `to`, with as many leaves, out of an operation that initialises them.
// False: there is none.
bool carve(std::vector<DiffOp>& ops, uint32_t to, uint32_t size, uint64_t leaves);
// Does nothing move, change, come or go?
bool is_identity(const std::vector<DiffOp>& ops);

std::string renamed_from(std::string_view name);

}  // namespace online_change
