#include "ir/lower/lower.h"

#include <optional>

#include "base/parallel.h"
#include "ir/lower/allocate.h"
#include "ir/lower/emit.h"
#include "ir/lower/select.h"

namespace ir {
namespace {

constexpr size_t kPousOfAThread = 8;  // POUs that a thread takes at a time

std::vector<uint32_t> written_by_caller(const codegen::Machine& machine, const Object& object) {
  std::vector<uint32_t> written;
  for (uint32_t r = 0; r < machine.registers.size(); ++r) {
    const uint32_t slot = machine.registers[r].slot;
    if (slot == codegen::kNoNumber) continue;
    const LocalKind kind = object.slots[slot].local;
    if (kind == LocalKind::kInput || kind == LocalKind::kInOut) written.push_back(r);
  }
  return written;
}

}  // namespace

base::Result<Object> lower(const Program& program, PouId id) {
  const Pou& pou = program.pous[id.index];
  Object object;
  object.name = pou.name;
  object.kind = pou.kind;
  object.self = pou.self;
  object.recursion_depth = pou.recursion_depth;
  object.file = pou.file;
  object.content = pou.content;
  for (const PouId taken : pou.taken_in) object.taken_in.push_back(program.pous[taken.index].name);
  base::Result<codegen::Machine> selected = codegen::Selector(program, pou, object).run();
  if (!selected.ok()) return selected.error();
  codegen::Machine& machine = selected.value();
  const codegen::Liveness liveness =
      codegen::analyse_liveness(machine, written_by_caller(machine, object));
  codegen::allocate(machine, liveness, object);
  if (base::Status emitted = emit_object(machine, liveness, object); !emitted.ok()) {
    return emitted.error();
  }
  return object;
}

namespace {

// `done` hears of each POU whose object is made, on the thread that made it.
template <class Done>
base::Result<std::vector<Object>> lower_each(const Program& program,
                                             const std::vector<bool>& left_out, uint32_t jobs,
                                             Done done) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < program.pous.size(); ++i) {
    if (i >= left_out.size() || !left_out[i]) numbers.push_back(i);
  }
  std::vector<Object> objects(numbers.size());
  std::vector<std::optional<base::Error>> errors(numbers.size());
  base::for_each_index(numbers.size(), jobs, kPousOfAThread, [&](size_t i) {
    base::Result<Object> object = lower(program, PouId(numbers[i]));
    if (object.ok()) {
      objects[i] = std::move(*object);
      done(numbers[i]);
    } else {
      errors[i] = object.error();
    }
  });
  for (std::optional<base::Error>& error : errors) {
    if (error) return std::move(*error);
  }
  return objects;
}

}  // namespace

base::Result<std::vector<Object>> lower_all(const Program& program,
                                            const std::vector<bool>& left_out, uint32_t jobs) {
  return lower_each(program, left_out, jobs, [](uint32_t) {});
}

base::Result<std::vector<Object>> lower_all_away(Program& program,
                                                 const std::vector<bool>& left_out, uint32_t jobs) {
  return lower_each(program, left_out, jobs, [&](uint32_t number) {
    Pou& pou = program.pous[number];
    std::vector<Value>().swap(pou.values);
    std::vector<Place>().swap(pou.places);
    std::vector<Block>().swap(pou.blocks);
  });
}

}  // namespace ir
