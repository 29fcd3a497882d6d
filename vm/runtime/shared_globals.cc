#include "vm/runtime/shared_globals.h"

#include <cstring>

#include "ir/bytecode/bools.h"

namespace vm {

SharedGlobals::SharedGlobals(const ir::Image& image) {
  const std::vector<ir::Member>& members = image.types[image.globals].members;
  for (const ir::SharedGlobal& row : image.shared) {
    const ir::Member& member = members[row.member];
    const auto signature = ir::plain_signature(image.types, image.layouts, member.type);
    if (!signature) continue;
    SharedVariable variable{member.name, image.types.text(member.type),
                            *signature,  row.written,
                            0,           ir::plain_runs(image.types, image.layouts, member.type)};
    const uint32_t data =
        image.instances[0].data + image.layouts[image.globals].member_offsets[row.member];
    for (ir::PlainRun& run : variable.runs) {
      run.offset += data;
      variable.bytes += run.size;
    }
    if (!row.written) read_bytes_ += variable.bytes;
    variables_.push_back(std::move(variable));
  }
}

const SharedVariable* SharedGlobals::find(std::string_view name) const {
  for (const SharedVariable& variable : variables_) {
    if (ir::same_name(variable.name, name)) return &variable;
  }
  return nullptr;
}

void SharedGlobals::gather_read(const uint8_t* memory, std::span<uint8_t> to) const {
  uint8_t* at = to.data();
  for (const SharedVariable& variable : variables_) {
    if (!variable.written) at = gather(variable.runs, memory, at);
  }
}

void SharedGlobals::scatter_read(std::span<const uint8_t> from, uint8_t* memory) const {
  const uint8_t* at = from.data();
  for (const SharedVariable& variable : variables_) {
    if (!variable.written) at = scatter(variable.runs, at, memory);
  }
}

uint8_t* gather(std::span<const ir::PlainRun> runs, const uint8_t* memory, uint8_t* to) {
  for (const ir::PlainRun& run : runs) {
    std::memcpy(to, memory + run.offset, run.size);
    to += run.size;
  }
  return to;
}

const uint8_t* scatter(std::span<const ir::PlainRun> runs, const uint8_t* from, uint8_t* memory) {
  for (const ir::PlainRun& run : runs) {
    std::memcpy(memory + run.offset, from, run.size);
    if (run.bools) ir::normalise_bools(memory + run.offset, run.size);
    from += run.size;
  }
  return from;
}

}  // namespace vm
