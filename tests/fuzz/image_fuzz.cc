// Images that somebody has tampered with and hashed anew: the verifier refuses them, or
// the machine runs 100 scans, and 10 with variables forced, without touching memory that the image
// does not declare.
//
// An input is either stored bytes (those that begin like an image), whose length and hash
// are put right, or a script of changes to a good image: 6 bytes {what, where, value} each.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

#include "base/check.h"
#include "base/limits.h"
#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_objects.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"
#include "vm/load/forced_code.h"

namespace {

constexpr uint64_t kFuelOfAScan = 200;
constexpr uint64_t kMaxPages = 64 * 1024;  // images that declare more memory are not run

// --- mutation ---------------------------------------------------------------------

struct Change {
  uint8_t what;
  uint16_t where;
  uint16_t value;
  uint8_t how;
};

// Sets, flips a bit of, or moves a number.
template <class T>
void alter(T& number, const Change& change) {
  auto wide = static_cast<uint64_t>(number);
  switch (change.how % 4) {
    case 0:
      wide = change.value;
      break;
    case 1:
      wide ^= uint64_t{1} << (change.value % 64);
      break;
    case 2:
      wide += change.value % 9;
      break;
    default:
      wide -= change.value % 9;
      break;
  }
  number = static_cast<T>(wide);
}

template <class T>
T* pick(std::vector<T>& list, uint32_t where) {
  return list.empty() ? nullptr : &list[where % list.size()];
}

void change_slot(ir::FrameSlot& slot, const Change& change) {
  switch (change.how / 4 % 6) {
    case 0:
      return alter(slot.offset, change);
    case 1:
      slot.cls = static_cast<ir::Class>(change.value % ir::kClassCount);
      return;
    case 2:
      slot.kind = static_cast<ir::SlotKind>(change.value % 3);
      return;
    case 3:
      slot.local = static_cast<ir::LocalKind>(change.value % 5);
      return;
    case 4:
      slot.aggregate = !slot.aggregate;
      return;
    default:
      slot.region.type.index = change.value % 40;
      return;
  }
}

void change_pou(ir::LinkedPou& pou, const Change& change) {
  switch (change.how / 4 % 7) {
    case 0:
      return alter(pou.frame_size, change);
    case 1:
      return alter(pou.self.index, change);
    case 2:
      return alter(pou.unit_count, change);
    case 3:
      if (ir::FrameSlot* slot = pick(pou.slots, change.where / 8)) change_slot(*slot, change);
      return;
    case 4:
      if (ir::Merge* merge = pick(pou.merges, change.where)) alter(merge->unit, change);
      return;
    case 5:
      if (ir::Merge* merge = pick(pou.merges, change.where)) {
        merge->slots.assign(1, static_cast<uint16_t>(change.value % (pou.slots.size() + 1)));
      }
      return;
    default:
      pou.kind = static_cast<ir::PouKind>(change.value % ir::kPouKindCount);
      return;
  }
}

void change_unit(ir::Unit& unit, const Change& change) {
  switch (change.how / 4 % 5) {
    case 0:
      return alter(unit.a, change);
    case 1:
      return alter(unit.b, change);
    case 2:
      return alter(unit.c, change);
    case 3:
      unit.op = static_cast<uint16_t>((unit.op & ~0x3ff) | change.value % ir::kOpcodeCount);
      return;
    default:
      unit.op ^= static_cast<uint16_t>(1u << (10 + change.value % 6));
      return;
  }
}

void change_type(ir::Image& image, const Change& change) {
  const uint32_t number =
      ir::kElementaryCount + change.where % (image.types.size() - ir::kElementaryCount);
  ir::Type& type = image.types.edit(ir::TypeId(number));
  ir::TypeLayout& layout = image.layouts.of[number];
  switch (change.how / 4 % 7) {
    case 0:
      return alter(type.base.index, change);
    case 1:
      return alter(type.capacity, change);
    case 6:
      type.interfaces.assign(1, ir::TypeId(change.value % (image.types.size() + 1)));
      return;
    case 2:
      if (ir::Member* member = pick(type.members, change.value)) {
        member->type.index = change.where / 16 % (image.types.size() + 1);
      }
      return;
    case 3:
      return alter(layout.size, change);
    case 4:
      return alter(layout.area_capacity, change);
    default:
      if (uint32_t* offset = pick(layout.member_offsets, change.where / 16)) alter(*offset, change);
      return;
  }
}

void change_instance(ir::Instance& row, const Change& change) {
  switch (change.how / 4 % 5) {
    case 0:
      return alter(row.data, change);
    case 1:
      return alter(row.type.index, change);
    case 2:
      return alter(row.pou, change);
    case 3:
      return alter(row.parent, change);
    default:
      row.live = !row.live;
      return;
  }
}

void change_override(ir::LinkedOverride& row, const Change& change) {
  switch (change.how / 4 % 3) {
    case 0:
      return alter(row.type.index, change);
    case 1:
      return alter(row.prototype, change);
    default:
      return alter(row.target, change);
  }
}

void change_numbers(ir::Image& image, const Change& change) {
  uint32_t* const numbers[] = {&image.data_capacity, &image.stack_bytes, &image.call_depth,
                               &image.globals.index, &image.input_bytes};
  alter(*numbers[change.where % 5], change);
}

void apply(ir::Image& image, const Change& change) {
  const auto on = [&](auto* item, auto&& act) {
    if (item != nullptr) act(*item);
  };
  switch (change.what % 16) {
    case 0:
      return on(pick(image.pous, change.where), [&](auto& p) { change_pou(p, change); });
    case 1:
      return change_type(image, change);
    case 2:
      return on(pick(image.instances, change.where), [&](auto& r) { change_instance(r, change); });
    case 3:
      return on(pick(image.bounds, change.where), [&](auto& b) { alter(b.count, change); });
    case 4:
      return on(pick(image.bounds, change.where),
                [&](auto& b) { alter(b.from.type.index, change); });
    case 5:
      return on(pick(image.data, change.where), [&](auto& d) { alter(d.offset, change); });
    case 6:
      return on(pick(image.data, change.where), [&](auto& d) {
        on(pick(d.bytes, change.where / 8), [&](auto& byte) { alter(byte, change); });
      });
    case 7:
      return on(pick(image.pool, change.where), [&](auto& byte) { alter(byte, change); });
    case 8:
      return change_numbers(image, change);
    case 9:  // an instruction in another place
      return on(pick(image.code, change.where),
                [&](auto& unit) { unit = image.code[change.value % image.code.size()]; });
    case 10:
      return on(pick(image.overrides, change.where),
                [&](auto& row) { change_override(row, change); });
    default:
      return on(pick(image.code, change.where), [&](auto& unit) { change_unit(unit, change); });
  }
}

// Of two images; the first byte's upper half says which.
base::Bytes scripted(const uint8_t* data, size_t size) {
  const bool objects = size != 0 && (data[0] & 0x10) != 0;
  ir::Image image = objects ? sample::busy_object_image() : sample::busy_image();
  for (size_t at = 0; at + 6 <= size && at < 6 * 8; at += 6) {
    Change change{data[at], 0, 0, data[at + 5]};
    std::memcpy(&change.where, data + at + 1, 2);
    std::memcpy(&change.value, data + at + 3, 2);
    apply(image, change);
  }
  return ir::encode(image);
}

// Stored bytes with the header as it must be.
base::Bytes repaired(const uint8_t* data, size_t size) {
  base::Bytes bytes(data, data + size);
  const base::Bytes good = ir::encode(ir::Image{});
  const auto length = static_cast<uint32_t>(size);
  std::memcpy(bytes.data(), good.data(), 12);
  std::memcpy(bytes.data() + 12, &length, 4);
  const base::Digest digest = base::sha256(base::ByteSpan(bytes).subspan(48));
  std::memcpy(bytes.data() + 16, digest.data(), digest.size());
  return bytes;
}

// --- running ----------------------------------------------------------------------

uint64_t pages(uint64_t bytes) { return (bytes + 4095) / 4096; }

// Only pages of what the image declares may ever have been touched.
void check_untouched(vm::Memory& memory, uint64_t begin, uint64_t end) {
  constexpr uint64_t kChunk = uint64_t{1} << 28;
  static std::vector<unsigned char> resident(kChunk / 4096);
  for (uint64_t at = pages(begin) * 4096; at < end; at += kChunk) {
    const uint64_t size = std::min(kChunk, end - at);
    base::check(mincore(memory.data() + at, size, resident.data()) == 0, "mincore");
    base::check(std::memchr(resident.data(), 1, pages(size)) == nullptr,
                "memory outside of what the image declares is untouched");
  }
}

void check_memory(vm::Memory& memory, const ir::Image& image) {
  for (uint32_t i = 0; i < ir::kDataBegin; ++i) {
    base::check(memory.data()[i] == 0, "the first bytes are untouched");
  }
  base::check(image.pool.empty() || std::memcmp(memory.data() + ir::kConstPoolA, image.pool.data(),
                                                image.pool.size()) == 0,
              "constants are as they were");
  check_untouched(memory, image.data_capacity, ir::kConstPoolA);
  check_untouched(memory, ir::kConstPoolA + image.pool.size(), ir::kStackBegin);
  check_untouched(memory, uint64_t{ir::kStackBegin} + image.stack_bytes, uint64_t{1} << 32);
}

void run(const vm::Generation& generation, const vm::CodeTable& code, vm::Memory& memory,
         int scans) {
  const ir::Image& image = generation.image();
  vm::Execution execution(image.call_depth, 0, generation.try_depth());
  for (int scan = 0; scan < scans; ++scan) {
    for (const ir::ImageTask& task : image.tasks) {
      for (uint32_t program : task.programs) {
        execution.start(generation, code, memory.data(), program, ir::kStackBegin, scan);
        if (execution.run(kFuelOfAScan) == vm::Exit::kTrap) {
          base::check(!vm::describe(image, execution.trap()).text.empty(), "a trap has a text");
        }
      }
    }
  }
}

// Some variables have the values of other moments.
std::vector<vm::ForcedVariable> forced_variables(const ir::Image& image, vm::Memory& memory) {
  std::vector<vm::ForcedVariable> out;
  uint32_t count = 0;
  ir::for_each_leaf(image, [&](const std::string&, const ir::Symbol& symbol) {
    if (symbol.constant || count++ % 3 != 0) return;
    const uint32_t size = image.layouts[symbol.type].size;
    const uint8_t* const at = memory.data() + symbol.data;
    out.push_back({{symbol.data, size, symbol.type}, base::Bytes(at, at + size)});
  });
  return out;
}

void run_scans(const ir::VerifiedImage& verified, bool look_at_pages) {
  const ir::Image& image = verified.image();
  if (pages(image.data_capacity) > kMaxPages) return;
  vm::Memory memory = std::move(vm::Memory::reserve()).value();
  for (const ir::DataRun& run : image.data) {
    if (!run.bytes.empty()) {
      std::memcpy(memory.data() + run.offset, run.bytes.data(), run.bytes.size());
    }
  }
  const auto generation = vm::Generation::build(verified, 0, memory.data());
  run(*generation, *generation->code(), memory, 1);
  const std::vector<vm::ForcedVariable> variables = forced_variables(image, memory);
  run(*generation, *generation->code(), memory, 99);
  const auto forced = vm::ForcedCode::make(verified, *generation->code(), variables, {});
  if (forced != nullptr) run(*generation, forced->table(), memory, 10);
  ir::state_hash(image, memory.view());
  if (look_at_pages) check_memory(memory, image);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const bool stored = size >= 48 && std::memcmp(data, "STCIMAGE", 8) == 0;
  const base::Bytes bytes = stored ? repaired(data, size) : scripted(data, size);
  const auto verified = ir::verify(bytes);
  static uint64_t accepted = 0;
  if (verified.ok()) run_scans(*verified, ++accepted % 16 == 1);
  return 0;
}
