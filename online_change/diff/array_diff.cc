// Arrays keep every element whose indices exist in both versions, for any number
// of dimensions (A14): the intersection of the two boxes is carried over, the
// rest of the new box is initialised, the rest of the old one dropped.
#include <algorithm>

#include "online_change/diff/diff_ops.h"
#include "online_change/diff/type_diff.h"

namespace online_change {
namespace {

using ir::TypeId;

struct Box {
  std::vector<uint64_t> old_first;  // of the intersection, counted from the bound
  std::vector<uint64_t> new_first;
  std::vector<uint64_t> count;      // of the intersection
  std::vector<uint64_t> new_count;  // of the new array
  std::vector<uint64_t> old_strides;
  std::vector<uint64_t> new_strides;
  uint64_t common() const {
    uint64_t n = 1;
    for (uint64_t c : count) n *= c;
    return n;
  }
};

std::vector<uint64_t> strides_of(const std::vector<ir::Dimension>& dims, uint64_t element) {
  std::vector<uint64_t> strides(dims.size());
  for (size_t d = dims.size(); d-- > 0;) {
    strides[d] = element;
    element *= dims[d].count();
  }
  return strides;
}

Box intersect(const std::vector<ir::Dimension>& from, uint32_t old_element,
              const std::vector<ir::Dimension>& to, uint32_t new_element) {
  Box box;
  for (size_t d = 0; d < from.size(); ++d) {
    int64_t low = std::max(from[d].low, to[d].low);
    int64_t high = std::min(from[d].high, to[d].high);
    bool empty = high < low;
    box.count.push_back(empty ? 0 : static_cast<uint64_t>(high - low) + 1);
    box.old_first.push_back(empty ? 0 : static_cast<uint64_t>(low - from[d].low));
    box.new_first.push_back(empty ? 0 : static_cast<uint64_t>(low - to[d].low));
    box.new_count.push_back(to[d].count());
  }
  box.old_strides = strides_of(from, old_element);
  box.new_strides = strides_of(to, new_element);
  return box;
}

// Repeats over the dimensions below `dims` of the intersection, and moves to its origin.
bool spread(std::vector<DiffOp>& ops, const Box& box, size_t dims) {
  uint64_t from = 0;
  uint64_t to = 0;
  for (size_t d = dims; d-- > 0;) {
    if (!repeat(ops, box.count[d], static_cast<uint32_t>(box.old_strides[d]),
                static_cast<uint32_t>(box.new_strides[d]))) {
      return false;
    }
    from += box.old_first[d] * box.old_strides[d];
    to += box.new_first[d] * box.new_strides[d];
  }
  shift(ops, static_cast<uint32_t>(from), static_cast<uint32_t>(to));
  return true;
}

// The new elements: per dimension one slab before and one after the intersection.
bool add_slab(std::vector<DiffOp>& ops, const Box& box, size_t dim, uint64_t first, uint64_t count,
              uint64_t leaves_per_byte_run, uint32_t row) {
  if (count == 0) return true;
  DiffOp op;
  op.kind = DiffKind::kInitialise;
  op.to = static_cast<uint32_t>(first * box.new_strides[dim]);
  op.size = static_cast<uint32_t>(count * box.new_strides[dim]);
  op.leaves = leaves_per_byte_run * count;
  op.row = row;
  std::vector<DiffOp> slab{op};
  if (!spread(slab, box, dim)) return false;
  ops.insert(ops.end(), slab.begin(), slab.end());
  return true;
}

bool add_new_elements(std::vector<DiffOp>& ops, const Box& box, uint64_t element_leaves,
                      uint32_t row) {
  for (size_t d = 0; d < box.count.size(); ++d) {
    uint64_t below = element_leaves;
    for (size_t inner = d + 1; inner < box.count.size(); ++inner) below *= box.new_count[inner];
    uint64_t behind = box.new_first[d] + box.count[d];
    if (box.count[d] == 0) {
      return add_slab(ops, box, d, 0, box.new_count[d], below, row);
    }
    if (!add_slab(ops, box, d, 0, box.new_first[d], below, row)) return false;
    if (!add_slab(ops, box, d, behind, box.new_count[d] - behind, below, row)) return false;
  }
  return true;
}

std::string bounds_text(const std::vector<ir::Dimension>& from,
                        const std::vector<ir::Dimension>& to) {
  std::string text;
  for (size_t d = 0; d < from.size(); ++d) {
    text += (d == 0 ? "" : ",") + std::to_string(std::max(from[d].low, to[d].low)) + ".." +
            std::to_string(std::min(from[d].high, to[d].high));
  }
  return "[" + text + "]";
}

// An element that is byte for byte the same, without slots: one run for all of it.
void use_whole_elements(TypeDiff& element, uint32_t size) {
  bool plain = element.same && !element.renamed &&
               std::all_of(element.ops.begin(), element.ops.end(),
                           [](const DiffOp& op) { return op.kind == DiffKind::kSame; });
  if (!plain || element.ops.empty()) return;
  DiffOp whole;
  whole.size = size;
  whole.leaves = element.leaves;
  element.ops = {whole};
}

}  // namespace

TypeDiff TypeDiffer::compare_arrays(TypeId old_type, TypeId new_type) {
  const ir::Type& from = old_.types[old_type];
  const ir::Type& to = new_.types[new_type];
  TypeDiff element = value(from.base, to.base);
  uint32_t old_size = old_.layouts[from.base].size;
  uint32_t new_size = new_.layouts[to.base].size;
  use_whole_elements(element, new_size);
  if (!element.has_rule) return compare_leaves(old_type, new_type);

  Box box = intersect(from.dims, old_size, to.dims, new_size);
  uint64_t common = box.common();
  bool slots = new_.types.is_instance(to.base);
  uint64_t old_element_leaves = slots ? 0 : leaves(old_, from.base);
  uint64_t new_element_leaves = slots ? 0 : leaves(new_, to.base);
  std::string old_text = old_.types.text(old_type);
  std::string new_text = new_.types.text(new_type);

  TypeDiff diff;
  diff.leaves = leaves(new_, new_type);
  diff.renamed = element.renamed;
  for (FateRow row : element.rows) {
    if (common == 0) break;
    row.count *= common;
    if (row.path.empty()) {
      row.old_type = old_text;
      row.new_type = new_text;
    } else {
      row.path = bounds_text(from.dims, to.dims) + row.path;
    }
    diff.rows.push_back(row);
  }
  if (common != 0) {
    diff.ops = element.ops;
    failed_ = failed_ || !spread(diff.ops, box, box.count.size());
  }
  uint64_t added = diff.leaves - new_element_leaves * common;
  auto row = static_cast<uint32_t>(diff.rows.size());
  std::vector<DiffOp> fresh;
  failed_ = failed_ || !add_new_elements(fresh, box, new_element_leaves, row);
  diff.ops.insert(diff.ops.end(), fresh.begin(), fresh.end());
  if (!fresh.empty()) {
    diff.rows.push_back({Fate::kInitialised, "", old_text, new_text, false, "new elements", added});
  }
  uint64_t dropped = (slots ? 0 : leaves(old_, old_type)) - old_element_leaves * common;
  if (dropped != 0) {
    diff.rows.push_back(
        {Fate::kDropped, "", old_text, new_text, true, std::string(kOutsideBounds), dropped});
  }
  join(diff.ops);
  diff.same = element.same && from.dims == to.dims && old_size == new_size && is_identity(diff.ops);
  return diff;
}

}  // namespace online_change
