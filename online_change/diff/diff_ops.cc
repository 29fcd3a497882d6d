#include "online_change/diff/diff_ops.h"

#include <algorithm>

namespace online_change {
namespace {

// Bytes between two unchanged neighbours that are cheaper copied than stepped over: padding and
// small holes. Nothing else has a place there, since the neighbours are next to each other.
constexpr uint32_t kMaxGap = 16;

bool can_grow(const DiffOp& op, uint32_t from_stride, uint32_t to_stride) {
  return op.kind == DiffKind::kSame && op.count == 1 && op.size == from_stride &&
         op.size == to_stride;
}

// A repeated op whose repetitions follow each other without a break is one longer one.
bool is_continued(const DiffOp& op, uint32_t from_stride, uint32_t to_stride) {
  return uint64_t{op.from_stride} * op.count == from_stride &&
         uint64_t{op.to_stride} * op.count == to_stride;
}

bool joins(const DiffOp& a, const DiffOp& b) {
  if (a.kind != DiffKind::kSame || b.kind != DiffKind::kSame) return false;
  if (a.count != 1 || b.count != 1 || a.row != b.row || a.constant != b.constant) return false;
  if (a.to - a.from != b.to - b.from) return false;  // modulo 2^32: the same distance
  uint64_t end = uint64_t{a.to} + a.size;
  return end <= b.to && b.to - end <= kMaxGap;
}

// Pieces of one value share a row, and only their sum of leaves is known: what one of them lacks is
// counted with another.
void take_leaves(std::vector<DiffOp>& ops, uint32_t row, uint64_t missing) {
  for (DiffOp& op : ops) {
    if (missing == 0) return;
    if (op.kind != DiffKind::kInitialise || op.row != row || op.count != 1) continue;
    const uint64_t taken = std::min(op.leaves, missing);
    op.leaves -= taken;
    missing -= taken;
  }
}

}  // namespace

FateRow make_row(Fate fate, std::string path, std::string old_type, std::string new_type,
                 std::string reason, uint64_t count) {
  FateRow row;
  row.fate = fate;
  row.path = std::move(path);
  row.old_type = std::move(old_type);
  row.new_type = std::move(new_type);
  row.reason = std::move(reason);
  row.count = count;
  return row;
}

DiffOp make_op(DiffKind kind, uint32_t from, uint32_t to, uint32_t size, uint64_t leaves) {
  DiffOp op;
  op.kind = kind;
  op.from = from;
  op.to = to;
  op.size = size;
  op.leaves = leaves;
  return op;
}

bool repeat(std::vector<DiffOp>& ops, uint64_t count, uint32_t from_stride, uint32_t to_stride) {
  if (count == 1) return true;
  std::vector<DiffOp> out;
  for (DiffOp& op : ops) {
    uint64_t all_leaves = op.leaves * count;
    if (can_grow(op, from_stride, to_stride)) {
      op.size = static_cast<uint32_t>(op.size * count);
    } else if (op.count == 1) {
      op.count = static_cast<uint32_t>(count);
      op.from_stride = from_stride;
      op.to_stride = to_stride;
    } else if (is_continued(op, from_stride, to_stride)) {
      op.count = static_cast<uint32_t>(op.count * count);
    } else {
      if (out.size() + count > kMaxDiffOps) return false;
      for (uint64_t i = 0; i < count; ++i) {
        out.push_back(op);
        out.back().from += static_cast<uint32_t>(i * from_stride);
        out.back().to += static_cast<uint32_t>(i * to_stride);
      }
      continue;
    }
    op.leaves = all_leaves;
    out.push_back(op);
  }
  ops = std::move(out);
  return true;
}

void shift(std::vector<DiffOp>& ops, uint32_t from, uint32_t to) {
  for (DiffOp& op : ops) {
    op.from += from;
    op.to += to;
  }
}

void join(std::vector<DiffOp>& ops) {
  std::stable_sort(ops.begin(), ops.end(),
                   [](const DiffOp& a, const DiffOp& b) { return a.to < b.to; });
  std::vector<DiffOp> out;
  for (const DiffOp& op : ops) {
    if (!out.empty() && joins(out.back(), op)) {
      out.back().size = op.to + op.size - out.back().to;
      out.back().leaves += op.leaves;
    } else {
      out.push_back(op);
    }
  }
  ops = std::move(out);
}

bool carve(std::vector<DiffOp>& ops, uint32_t to, uint32_t size, uint64_t leaves) {
  for (size_t i = 0; i < ops.size(); ++i) {
    const DiffOp op = ops[i];
    if (op.kind != DiffKind::kInitialise || op.stamp || to < op.to) continue;
    const uint32_t number = op.count == 1 ? 0 : (to - op.to) / op.to_stride;
    const uint32_t begin = op.to + number * op.to_stride;
    if (number >= op.count || uint64_t{to} + size > uint64_t{begin} + op.size) continue;
    DiffOp piece = op;
    const uint64_t each = op.leaves / op.count;
    std::vector<DiffOp> pieces;
    const auto add = [&](uint32_t at, uint32_t bytes, uint32_t count, uint64_t all_leaves) {
      if (bytes == 0 || count == 0) return;
      piece.to = at;
      piece.size = bytes;
      piece.count = count;
      piece.leaves = all_leaves;
      pieces.push_back(piece);
    };
    const uint64_t rest = each - std::min(each, leaves);
    add(op.to, op.size, number, each * number);
    add(begin, to - begin, 1, rest);
    add(to + size, begin + op.size - (to + size), 1, to == begin ? rest : 0);
    const uint32_t behind = op.count - number - 1;
    add(begin + op.to_stride, op.size, behind, each * behind);
    ops.erase(ops.begin() + static_cast<std::ptrdiff_t>(i));
    ops.insert(ops.end(), pieces.begin(), pieces.end());
    take_leaves(ops, op.row, leaves - std::min(each, leaves));
    return true;
  }
  return false;
}

bool is_identity(const std::vector<DiffOp>& ops) {
  return std::all_of(ops.begin(), ops.end(), [](const DiffOp& op) {
    bool carried = op.kind == DiffKind::kSame ||
                   ((op.kind == DiffKind::kSlot || op.kind == DiffKind::kInOut) && op.has_source);
    return carried && op.from == op.to && op.from_stride == op.to_stride;
  });
}

std::string renamed_from(std::string_view name) { return std::string(kRenamed).append(name) + "`"; }

}  // namespace online_change
