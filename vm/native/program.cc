#include "vm/native/program.h"

#include <algorithm>
#include <cstring>
#include <unordered_set>

#include "base/check.h"
#include "vm/exec/context.h"
#include "vm/load/same_code.h"
#include "vm/native/code_facts.h"
#include "vm/native/code_memory.h"
#include "vm/native/emit.h"
#include "vm/native/host.h"
#include "vm/native/make_function.h"

namespace vm::native {

// What belongs to one POU. `facts`: of everything outside of its units that its code relies on.
struct PouNative {
  std::string reason;  // not empty: there is no code
  const ir::Unit* units = nullptr;
  base::Digest facts{};
  bool has_facts = true;
  std::shared_ptr<const CodeMemory> code;
  const uint8_t* machine = nullptr;
  SideUnits side;
  struct Entry {
    uint32_t unit = 0;
    uint32_t side = 0;
  };
  std::vector<Entry> entries;     // sorted by unit
  std::vector<uint32_t> inlined;  // POUs whose bodies are in it
};

namespace {

constexpr uint32_t kMostProgramUnits = 1u << 20;
constexpr uint32_t kMostSpills = 1024;
constexpr size_t kCodeBytesPerUnit = 32;  // of addresses; pages that no code fills take no memory

ir::Unit resume_unit(const uint8_t* at) {
  const uint64_t bits = reinterpret_cast<uint64_t>(at) << 16 | kResumeHandler;
  ir::Unit unit;
  std::memcpy(static_cast<void*>(&unit), &bits, sizeof unit);
  return unit;
}

ir::Unit stop_unit() {
  ir::Unit unit;
  unit.op = static_cast<uint16_t>(kStopHandler);
  return unit;
}

// A call's unit goes on with one that comes back, a helper's with a stop. Each is one instruction,
// also where the interpreter would take several at once.
SideUnits side_units(const Function& f, const ir::Unit* units, const ir::Unit* code) {
  SideUnits side;
  side.helper.assign(f.nodes.size(), kNone);
  side.call.assign(f.calls.size(), 0);
  side.resume.assign(f.calls.size(), 0);
  std::vector<ir::Unit> all;
  const auto copy = [&](uint32_t unit) {
    const auto at = static_cast<uint32_t>(all.size());
    const ir::Unit& u = code[unit];
    const bool extended = ir::opcode_row(u.opcode()).extended;
    for (uint32_t i = unit; i <= unit + (extended ? 1 : 0); ++i) {
      all.push_back(units[i]);
      side.real.push_back(unit);
    }
    all[at].op =
        static_cast<uint16_t>(handler_number(u.opcode(), u.base_a(), u.base_b(), u.base_c()));
    return at;
  };
  for (uint32_t n = 0; n < f.nodes.size(); ++n) {
    const Node& node = f.nodes[n];
    const bool calls = node.op == Op::kCall;
    if (node.dead || (node.op != Op::kHelper && !calls)) continue;
    const uint32_t at = copy(node.op == Op::kHelper ? node.unit : f.calls[node.call].unit);
    if (node.op == Op::kHelper) {
      side.helper[n] = at;
    } else {
      side.call[node.call] = at;
      side.resume[node.call] = static_cast<uint32_t>(all.size());
    }
    all.push_back(stop_unit());
    side.real.push_back(node.unit);
  }
  // The POU's entry and its loops' heads.
  const size_t more = 1 + f.loops.size();
  side.count = static_cast<uint32_t>(all.size() + more);
  side.units = std::make_unique<ir::Unit[]>(side.count);
  std::copy(all.begin(), all.end(), side.units.get());
  side.real.resize(side.count, 0);
  return side;
}

struct Work {
  uint32_t number = 0;
  std::shared_ptr<PouNative> pou;
  Function function;
  Allocated places;
};

// What is left to do for a POU when addresses are known.
struct Emitted {
  std::shared_ptr<PouNative> pou;
  std::vector<Call> calls;
  std::vector<uint32_t> head_units;  // of entries.heads
  uint32_t loops = 0;
  Entries entries;
};

// Everything up to registers; the machine code follows for all POUs together.
bool prepare(const ir::Image& image, const TierOptions& options, const Target& target,
             Bodies& bodies, Work& work) {
  const ir::LinkedPou& pou = image.pous[work.number];
  if (is_interpreted_at_random(options, work.number)) {
    work.pou->reason = "the options say so";
    return false;
  }
  const ir::PouVersion* const version = bodies.common().version_of(work.number);
  if (version != nullptr && version->interpreted) {
    work.pou->reason = "it writes where a variable is forced";
    return false;
  }
  if (pou.unit_count > kMostProgramUnits) {
    work.pou->reason = "it is too large";
    return false;
  }
  base::Result<Function> function = make_function(image, bodies, work.number, work.pou->inlined);
  if (!function.ok()) {
    work.pou->reason = function.error().text;
    return false;
  }
  work.function = std::move(*function);
  fold_loads(work.function, target);
  const AllocatorOptions registers{options.integer_registers, options.float_registers,
                                   options.spill_seed};
  base::Result<Allocated> places = allocate(work.function, target, registers);
  if (!places.ok()) {
    work.pou->reason = places.error().text;
    return false;
  }
  if (places->spill_slots > kMostSpills) {
    work.pou->reason = "it needs too many registers";
    return false;
  }
  work.places = std::move(*places);
  base::dcheck(work.places.blocks.size() == work.function.blocks.size(), "blocks stay parallel");
  work.pou->side =
      side_units(work.function, work.pou->units, bodies.common().code_of(image, pou).data());
  return true;
}

Emitted emit(Work& work, const TierOptions& options, const Shared& shared,
             host::Assembler& assembler) {
  const PouCode code{&work.function, &work.places,  &work.pou->side,   work.pou->units,
                     work.number,    options.plain, options.table_ways};
  Emitted out;
  out.entries = host::Emitter(code, shared, assembler).run();
  for (const auto& [block, offset] : out.entries.heads) {
    out.head_units.push_back(work.function.blocks[block].unit);
  }
  out.loops = static_cast<uint32_t>(work.function.loops.size());
  out.calls = std::move(work.function.calls);
  out.pou = std::move(work.pou);
  return out;
}

// Addresses are known: side units that go on in machine code get them.
void finish(const Emitted& emitted, const uint8_t* base) {
  PouNative& pou = *emitted.pou;
  SideUnits& side = pou.side;
  const Entries& entries = emitted.entries;
  pou.machine = base + entries.begin;
  base::dcheck(entries.behind_call.size() == emitted.calls.size(), "each call comes back");
  base::dcheck(entries.heads.size() == emitted.head_units.size(), "each head has its unit");
  for (size_t c = 0; c < entries.behind_call.size(); ++c) {
    const Call& call = emitted.calls[c];
    if (call.inlined) continue;
    side.units[side.resume[c]] = resume_unit(base + entries.behind_call[c]);
    side.real[side.resume[c]] = call.behind;
    pou.entries.push_back({call.behind, side.resume[c]});
  }
  uint32_t next = side.count - 1 - emitted.loops;
  side.units[next] = resume_unit(pou.machine);
  pou.entries.push_back({0, next++});
  for (size_t h = 0; h < entries.heads.size(); ++h) {
    const uint32_t unit = emitted.head_units[h];
    side.units[next] = resume_unit(base + entries.heads[h].second);
    side.real[next] = unit;
    // An entry that is a head is entered as the POU: its memory is right as well.
    if (unit != 0) pou.entries.push_back({unit, next});
    ++next;
  }
  // Nobody asks for these any more.
  side.helper = {};
  side.call = {};
  side.resume = {};
  base::dcheck(next <= side.count, "a POU has the side units of its entries");
  std::sort(pou.entries.begin(), pou.entries.end(),
            [](const auto& a, const auto& b) { return a.unit < b.unit; });
  base::dcheck(
      [&] {
        const auto known = [&](const auto& e) { return e.side < side.count; };
        return std::all_of(pou.entries.begin(), pou.entries.end(), known);
      },
      "an entry leads to a side unit");
}

using PouNatives = std::vector<std::shared_ptr<const PouNative>>;

struct Job {
  const ir::Image& image;
  bool clean_bools = false;
  const std::vector<PouEntry>& pous;
  const TierOptions& options;
  const PouNatives* running = nullptr;  // null: none
  std::span<const ir::PouVersion> versions;
  Progress* progress = nullptr;
  const ir::Image* running_image = nullptr;
};

// The digests of the facts of all POUs; what is the same as it was is taken from what runs.
std::vector<base::Digest> facts_of_all(const Job& job, const ImageFacts& common,
                                       std::vector<uint64_t>& scratch) {
  std::vector<base::Digest> facts;
  if (job.running == nullptr) return facts;
  facts.reserve(job.image.pous.size());
  const bool alike = job.running_image != nullptr && job.versions.empty() &&
                     stand_on_the_same(*job.running_image, job.image);
  ir::ConstantRange changed;
  if (alike) changed = ir::changed_constants(job.running_image->pool, job.image.pool);
  for (uint32_t number = 0; number < job.image.pous.size(); ++number) {
    const bool same = alike && number < job.running->size() && (*job.running)[number]->has_facts &&
                      have_same_code(*job.running_image, job.image, number) &&
                      (changed.begin == changed.end ||
                       !names_constants(job.image, common, job.image.pous[number], changed));
    facts.push_back(same ? (*job.running)[number]->facts
                         : facts_of(job.image, common, job.image.pous[number], scratch));
  }
  return facts;
}

// The others are interpreted; whose bodies stand in what was made, of those the facts are known.
void leave_out_rest(const Job& job, const ImageFacts& common, PouNatives& made) {
  std::vector<bool> inlined(job.pous.size());
  for (const auto& pou : made) {
    for (const uint32_t number : pou->inlined) inlined[number] = true;
  }
  std::vector<uint64_t> scratch;
  while (made.size() < job.pous.size()) {
    const size_t number = made.size();
    const auto pou = std::make_shared<PouNative>();
    pou->reason = "it was not made yet";
    pou->units = job.pous[number].code;
    pou->has_facts = inlined[number];
    if (inlined[number]) {
      pou->facts = facts_of(job.image, common, job.image.pous[number], scratch);
    }
    made.push_back(pou);
  }
}

// Machine code of all POUs but those whose running code is still right.
std::vector<Emitted> emit_all(const Job& job, const Shared& shared, host::Assembler& assembler,
                              PouNatives& made) {
  const size_t shared_labels = assembler.labels();
  const ImageFacts common(job.image, job.clean_bools, job.versions);
  const host::HostTarget target;
  Bodies bodies(job.image, common, job.pous, job.options);
  assembler.reserve(kCodeBytesPerUnit * job.image.code.size());
  made.reserve(job.pous.size());
  std::vector<Emitted> all;
  all.reserve(job.pous.size());
  std::vector<uint64_t> scratch;
  // Where some code may be right.
  const std::vector<base::Digest> facts_by_pou = facts_of_all(job, common, scratch);
  // Is what runs of a POU, or was inlined of it, still right?
  const auto is_same = [&](uint32_t number) {
    if (job.running == nullptr || number >= job.running->size() || number >= job.pous.size())
      return false;
    const PouNative& old = *(*job.running)[number];
    return old.units == job.pous[number].code && old.facts == facts_by_pou[number];
  };
  for (uint32_t number = 0; number < job.pous.size(); ++number) {
    if (job.progress != nullptr) {
      if (job.progress->stop) break;
      job.progress->pous = number;
    }
    if (is_same(number)) {
      const std::shared_ptr<const PouNative>& old = (*job.running)[number];
      if (old->machine != nullptr &&
          std::all_of(old->inlined.begin(), old->inlined.end(), is_same)) {
        made.push_back(old);
        continue;
      }
    }
    Work work;
    work.number = number;
    work.pou = std::make_shared<PouNative>();
    work.pou->units = job.pous[number].code;
    work.pou->facts = job.running != nullptr
                          ? facts_by_pou[number]
                          : facts_of(job.image, common, job.image.pous[number], scratch);
    made.push_back(work.pou);
    if (!prepare(job.image, job.options, target, bodies, work)) continue;
    all.push_back(emit(work, job.options, shared, assembler));
    assembler.patch();
    assembler.forget_labels(shared_labels);
  }
  if (job.progress != nullptr && job.progress->unwanted) return {};
  assembler.patch();
  leave_out_rest(job, common, made);
  return all;
}

}  // namespace

bool is_available() { return host::kIsAvailable; }

Program::~Program() = default;

std::shared_ptr<const Program> Program::make(const ir::Image& image, bool clean_bools,
                                             std::vector<PouEntry>& pous,
                                             const TierOptions& options, const Program* running,
                                             std::span<const ir::PouVersion> versions,
                                             Progress* progress, const ir::Image* running_image) {
  if (options.tier == Tier::kInterpreter || !is_available()) return nullptr;
  const auto made = std::make_shared<Program>(Key());
  host::Assembler assembler;
  base::check(pous.size() == image.pous.size(), "each POU of an image has an entry");
  const Shared shared = host::emit_shared(assembler);
  const std::vector<Emitted> all =
      emit_all({image, clean_bools, pous, options, running == nullptr ? nullptr : &running->pous_,
                versions, progress, running_image},
               shared, assembler, made->pous_);
  if (progress != nullptr && progress->unwanted) return nullptr;
  base::dcheck(made->pous_.size() == pous.size(), "each POU is made or says why not");
  made->shared_code_ = CodeMemory::make(assembler.code());
  if (made->shared_code_ == nullptr) return nullptr;
  const uint8_t* const base = made->shared_code_->data();
  made->enter_ = base + assembler.offset_of(shared.enter);
  for (const Emitted& emitted : all) {
    emitted.pou->code = made->shared_code_;
    finish(emitted, base);
  }
  for (uint32_t number = 0; number < pous.size(); ++number) {
    const PouNative& pou = *made->pous_[number];
    pous[number].machine = base + assembler.offset_of(shared.interpret);
    if (pou.machine == nullptr) continue;
    base::dcheck(pou.code != nullptr && pou.machine >= pou.code->data() &&
                     pou.machine < pou.code->data() + pou.code->size(),
                 "machine code lies in its memory");
    base::dcheck(pou.units == pous[number].code, "machine code is of the units beside it");
    pous[number].machine = pou.machine;
    pous[number].entry = made->entry(number, pous[number].code);
  }
  // POUs that stay the same keep the memory of earlier versions.
  std::unordered_set<const CodeMemory*> memories = {made->shared_code_.get()};
  for (const auto& pou : made->pous_) {
    if (pou->code != nullptr) memories.insert(pou->code.get());
  }
  for (const CodeMemory* memory : memories) made->code_bytes_ += memory->size();
  return made;
}

const ir::Unit* Program::entry(uint32_t pou, const ir::Unit* unit) const {
  base::dcheck(pou < pous_.size(), "an entry is asked for a POU of the program");
  const PouNative& native = *pous_[pou];
  if (native.machine == nullptr) return unit;
  const auto number = static_cast<uint64_t>(unit - native.units);
  const auto found = std::lower_bound(native.entries.begin(), native.entries.end(), number,
                                      [](const auto& e, uint64_t at) { return e.unit < at; });
  if (found == native.entries.end() || found->unit != number) return unit;
  return &native.side.units[found->side];
}

const ir::Unit* Program::real_unit(uint32_t pou, const ir::Unit* unit) const {
  base::dcheck(pou < pous_.size(), "a unit is of a POU of the program");
  const PouNative& native = *pous_[pou];
  const ir::Unit* const first = native.side.units.get();
  const std::less<const ir::Unit*> before;
  if (first == nullptr || before(unit, first) || !before(unit, first + native.side.count)) {
    return unit;
  }
  return native.units + native.side.real[static_cast<size_t>(unit - first)];
}

uint32_t Program::native_pous() const {
  return static_cast<uint32_t>(std::count_if(
      pous_.begin(), pous_.end(), [](const auto& pou) { return pou->machine != nullptr; }));
}

const std::string& Program::reason(uint32_t pou) const { return pous_[pou]->reason; }

}  // namespace vm::native
