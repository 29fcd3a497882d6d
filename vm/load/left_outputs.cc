#include "vm/load/left_outputs.h"

#include <algorithm>
#include <map>

#include "ir/bytecode/located_layouts.h"
#include "ir/types/location.h"
#include "vm/load/same_code.h"
#include "vm/load/writers.h"

namespace vm {
namespace {

struct Output {        // a scalar with an address
  uint64_t begin = 0;  // bits
  uint64_t end = 0;
  Variable variable;
  ir::DirectAddress address;
  bool written = false;
};

// Located arrays element by element; other values of several parts as wholes, which nobody writes
// as a scalar, so nothing is said of them.
std::vector<Output> located_outputs(const ir::Image& image) {
  const ir::Layouts natural = ir::located_layouts(image);
  std::vector<Output> out;
  for (const ir::IoBinding& row : image.io) {
    if (row.address.area != ir::DirectArea::kOutput) continue;
    const ir::Type& type = image.types[row.type];
    const ir::TypeId part = type.kind == ir::Kind::kArray ? type.base : row.type;
    const uint32_t size = image.layouts[part].size;
    if (size == 0 || !image.types.is_scalar(part)) continue;
    const uint64_t count = image.layouts[row.type].size / size;
    if (count == 0) continue;
    const uint64_t bits = ir::located_bits(image.types, natural, row.type, row.address) / count;
    for (uint64_t i = 0; i < count; ++i) {
      Output output;
      output.begin = row.address.bit_offset + i * bits;
      output.end = output.begin + bits;
      output.variable = {row.data + static_cast<uint32_t>(i) * size, size, part};
      output.address = {row.address.area, static_cast<uint32_t>(output.begin),
                        static_cast<uint32_t>(bits)};
      out.push_back(output);
    }
  }
  return out;
}

std::vector<Variable> variables_of(const std::vector<Output>& outputs) {
  std::vector<Variable> variables;
  variables.reserve(outputs.size());
  for (const Output& output : outputs) variables.push_back(output.variable);
  return variables;
}

std::vector<Output> outputs_of(const RunningCode& code) {
  std::vector<Output> out = located_outputs(code.image);
  for (const Writer& writer : find_writers(code.image, variables_of(out), &code.pous)) {
    out[writer.variable].written = true;
  }
  return out;
}

// Who writes an output is decided by what code does, all of it together: the more, the more
// writers. So nobody is missed where the POUs that are others do what they did, and more.
bool all_stay_written(const RunningCode& before, const RunningCode& after) {
  const ir::Image& old_image = before.image;
  const ir::Image& new_image = after.image;
  if (before.pous != after.pous) return false;
  if (!have_same_places(old_image, new_image) || old_image.io != new_image.io) return false;
  std::vector<uint32_t> others;
  for (uint32_t pou = 0; pou < new_image.pous.size(); ++pou) {
    if (!have_same_code(old_image, new_image, pou)) others.push_back(pou);
  }
  if (others.size() > new_image.pous.size() / 4) return false;  // not much less than all of them
  if (others.empty()) return true;
  const std::vector<Variable> outputs = variables_of(located_outputs(new_image));
  return write_effects(new_image, outputs, others)
      .include(write_effects(old_image, outputs, others));
}

// Sorted ranges of bits that do not touch.
class Bits {
 public:
  void add(uint64_t begin, uint64_t end) {
    auto next = ranges_.upper_bound(begin);
    if (next != ranges_.begin() && std::prev(next)->second >= begin) --next;
    while (next != ranges_.end() && next->first <= end) {
      begin = std::min(begin, next->first);
      end = std::max(end, next->second);
      next = ranges_.erase(next);
    }
    ranges_[begin] = end;
  }
  bool touches(uint64_t begin, uint64_t end) const {
    const auto after = ranges_.lower_bound(end);
    return after != ranges_.begin() && std::prev(after)->second > begin;
  }

 private:
  std::map<uint64_t, uint64_t> ranges_;  // end by begin
};

}  // namespace

std::vector<LeftOutput> left_outputs(const RunningCode& before, const RunningCode& after) {
  const ir::Image& new_image = after.image;
  std::vector<LeftOutput> left;
  const bool any = std::any_of(new_image.io.begin(), new_image.io.end(), [](const auto& row) {
    return row.address.area == ir::DirectArea::kOutput;
  });
  if (!any || all_stay_written(before, after)) return left;
  Bits bound;
  Bits written;
  for (const Output& output : outputs_of(after)) {
    bound.add(output.begin, output.end);
    if (output.written) written.add(output.begin, output.end);
  }
  for (const Output& output : outputs_of(before)) {
    if (!output.written || !bound.touches(output.begin, output.end)) continue;
    if (written.touches(output.begin, output.end)) continue;
    LeftOutput row;
    row.address = output.address;
    row.symbol.data = output.variable.data;
    row.symbol.type = output.variable.type;
    row.path = ir::path_of(before.image, row.symbol);
    left.push_back(std::move(row));
  }
  return left;
}

}  // namespace vm
