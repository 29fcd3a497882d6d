#include "ir/opt/optimise.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "ir/opt/passes.h"
#include "ir/program/verify.h"

namespace ir {
namespace {

struct PassEntry {
  PassRow row;
  bool (*run)(const Program& program, Pou& pou);
};
constexpr auto kPasses = std::to_array<PassEntry>({
#define PASS(id, name, function, what) {{name, what}, opt::function},
#include "ir/opt/passes.def"
#undef PASS
});

constexpr auto kPassRows = [] {
  std::array<PassRow, kPasses.size()> rows{};
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = kPasses[i].row;
  return rows;
}();

// What one pass finds out, a later one uses: constants come to light after calls that
// became bodies, branches after constants, single values after dead stores.
constexpr Pass kOrder[] = {
    Pass::kInline,   Pass::kTexts,    Pass::kNumbers, Pass::kFold,  Pass::kBranches,
    Pass::kCopies,   Pass::kStores,   Pass::kNumbers, Pass::kFold,  Pass::kChecks,
    Pass::kStrength, Pass::kBranches, Pass::kStores,  Pass::kLoops, Pass::kDead,
};

constexpr size_t kPousInABatch = 8;  // POUs that a thread takes at a time

using Callees = std::vector<std::vector<uint32_t>>;  // functions, by POU

Callees find_callees(const Program& program) {
  Callees callees(program.pous.size());
  for (uint32_t number = 0; number < callees.size(); ++number) {
    for (const Block& block : program.pous[number].blocks) {
      for (const Inst& inst : block.insts) {
        if (inst.op == Op::kCallFunction) callees[number].push_back(inst.pou.index);
      }
    }
  }
  return callees;
}

// Functions before what calls them, so that bodies are small when they are looked at.
std::vector<uint32_t> callees_first(const Callees& all) {
  struct Visit {
    uint32_t pou;
    const std::vector<uint32_t>& callees;
    size_t next = 0;
  };
  std::vector<uint32_t> order;
  std::vector<bool> seen(all.size());
  for (uint32_t first = 0; first < all.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<Visit> open;
    open.push_back({first, all[first], 0});
    while (!open.empty()) {
      Visit& visit = open.back();
      if (visit.next == visit.callees.size()) {
        order.push_back(visit.pou);
        open.pop_back();
        continue;
      }
      const uint32_t next = visit.callees[visit.next++];
      if (seen[next]) continue;
      seen[next] = true;
      open.push_back({next, all[next], 0});
    }
  }
  return order;
}

// The order of callees first, in steps: POUs of one step do not see each other. In a circle of
// calls somebody comes before its callee, and sees it as it was.
std::vector<std::vector<uint32_t>> steps_of(const Program& program) {
  const Callees callees = find_callees(program);
  const std::vector<uint32_t> order = callees_first(callees);
  std::vector<uint32_t> step(callees.size());
  std::vector<bool> placed(callees.size());
  std::vector<std::vector<uint32_t>> steps;
  for (const uint32_t pou : order) {
    for (const uint32_t callee : callees[pou]) {
      if (placed[callee]) step[pou] = std::max(step[pou], step[callee] + 1);
    }
    placed[pou] = true;
    for (const uint32_t callee : callees[pou]) {
      if (!placed[callee]) step[callee] = std::max(step[callee], step[pou] + 1);
    }
    if (steps.size() <= step[pou]) steps.resize(step[pou] + 1);
    steps[step[pou]].push_back(pou);
  }
  return steps;
}

base::Status sound_after(const Program& program, const Pou& pou, Pass pass) {
  const base::Status sound = verify(program, pou);
  if (sound.ok()) return base::Ok{};
  const std::string_view name = kPassRows[static_cast<size_t>(pass)].name;
  return base::Error{sound.error().refusal,
                     "after pass `" + std::string(name) + "`: " + sound.error().text};
}

// A pass runs again only when another one has changed the POU since.
base::Status optimise_pou(const Program& program, Pou& pou, PassSet passes, bool verify_each) {
  std::array<uint32_t, kPasses.size()> seen{};  // the state that a pass left behind
  uint32_t state = 1;
  for (const Pass pass : kOrder) {
    const size_t number = static_cast<size_t>(pass);
    if (!passes.has(pass) || seen[number] == state) continue;
    if (kPasses[number].run(program, pou)) ++state;
    seen[number] = state;
    if (!verify_each) continue;
    if (base::Status sound = sound_after(program, pou, pass); !sound.ok()) return sound;
  }
  return base::Ok{};
}

}  // namespace

std::span<const PassRow> pass_rows() { return kPassRows; }

PassSet PassSet::from_bits(uint32_t bits) {
  PassSet set;
  set.bits_ = bits & ((uint32_t{1} << kPasses.size()) - 1);
  return set;
}

std::string PassSet::text() const {
  std::string text;
  for (size_t i = 0; i < kPassRows.size(); ++i) {
    if (!has(static_cast<Pass>(i))) continue;
    text += (text.empty() ? "" : ",") + std::string(kPassRows[i].name);
  }
  return text.empty() ? "none" : text;
}

PassSet PassSet::all() { return from_bits(~uint32_t{0}); }

base::Result<PassSet> PassSet::parse(std::string_view text) {
  if (text == "all") return all();
  if (text == "none") return none();
  PassSet set;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view name = text.substr(begin, end - begin);
    size_t number = 0;
    while (number < kPassRows.size() && kPassRows[number].name != name) ++number;
    if (number == kPassRows.size()) {
      std::string known = "all, none";
      for (const PassRow& row : kPassRows) known += ", " + std::string(row.name);
      return base::Error{base::Refusal::kUsage,
                         "unknown pass `" + std::string(name) + "`; known are " + known};
    }
    set.bits_ |= uint32_t{1} << number;
    begin = end + 1;
  }
  return set;
}

base::Status optimise(Program& program, PassSet passes, bool verify_each, uint32_t jobs) {
  if (passes.empty()) return base::Ok{};
  for (const std::vector<uint32_t>& step : steps_of(program)) {
    std::vector<base::Status> done(verify_each ? step.size() : 0, base::Ok{});
    base::for_each_index(step.size(), jobs, kPousInABatch, [&](size_t i) {
      base::Status status = optimise_pou(program, program.pous[step[i]], passes, verify_each);
      if (verify_each) done[i] = std::move(status);
    });
    for (base::Status& status : done) {
      if (!status.ok()) return std::move(status);
    }
  }
  return base::Ok{};
}

base::Status optimise(Program& program, PouId pou, PassSet passes, bool verify_each) {
  return optimise_pou(program, program.pous[pou.index], passes, verify_each);
}

bool can_be_inlined(const Program& program, PouId pou) {
  return opt::inlined_size(program, program.pous[pou.index]) != 0;
}

}  // namespace ir
