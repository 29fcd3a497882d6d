#include "ir/opt/optimise.h"

#include <array>

#include "ir/opt/passes.h"
#include "ir/program/verify.h"

namespace ir {
namespace {

struct Row {
  PassRow row;
  void (*run)(const Program& program, Pou& pou);
};
constexpr auto kPasses = std::to_array<Row>({
#define PASS(id, name, function, what) {{name, what}, opt::function},
#include "ir/opt/passes.def"
#undef PASS
});

constexpr auto kRows = [] {
  std::array<PassRow, kPasses.size()> rows{};
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = kPasses[i].row;
  return rows;
}();

// What one pass finds out, a later one uses: constants come to light behind calls that
// became bodies, branches behind constants, single values behind dead stores.
constexpr Pass kOrder[] = {
    Pass::kInline,   Pass::kNumbers, Pass::kFold, Pass::kBranches, Pass::kCopies,
    Pass::kStores,   Pass::kNumbers, Pass::kFold, Pass::kChecks,   Pass::kStrength,
    Pass::kBranches, Pass::kStores,  Pass::kDead,
};

// Functions before what calls them, so that bodies are small when they are looked at.
std::vector<uint32_t> callees_first(const Program& program) {
  struct Visit {
    uint32_t pou;
    std::vector<uint32_t> callees;
    size_t next = 0;
  };
  const auto callees_of = [&program](uint32_t number) {
    std::vector<uint32_t> callees;
    for (const Block& block : program.pous[number].blocks) {
      for (const Inst& inst : block.insts) {
        if (inst.op == Op::kCallFunction) callees.push_back(inst.pou.index);
      }
    }
    return callees;
  };
  std::vector<uint32_t> order;
  std::vector<bool> seen(program.pous.size());
  for (uint32_t first = 0; first < program.pous.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<Visit> open;
    open.push_back({first, callees_of(first), 0});
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
      open.push_back({next, callees_of(next), 0});
    }
  }
  return order;
}

base::Status sound_after(const Program& program, const Pou& pou, Pass pass) {
  const base::Status sound = verify(program, pou);
  if (sound.ok()) return base::Ok{};
  const std::string_view name = kRows[static_cast<size_t>(pass)].name;
  return base::Error{sound.error().refusal,
                     "after pass `" + std::string(name) + "`: " + sound.error().text};
}

}  // namespace

std::span<const PassRow> pass_rows() { return kRows; }

PassSet PassSet::from_bits(uint32_t bits) {
  PassSet set;
  set.bits_ = bits & ((uint32_t{1} << kPasses.size()) - 1);
  return set;
}

std::string PassSet::text() const {
  std::string text;
  for (size_t i = 0; i < kRows.size(); ++i) {
    if (!has(static_cast<Pass>(i))) continue;
    text += (text.empty() ? "" : ",") + std::string(kRows[i].name);
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
    while (number < kRows.size() && kRows[number].name != name) ++number;
    if (number == kRows.size()) {
      std::string known = "all, none";
      for (const PassRow& row : kRows) known += ", " + std::string(row.name);
      return base::Error{base::Refusal::kUsage,
                         "unknown pass `" + std::string(name) + "`; known are " + known};
    }
    set.bits_ |= uint32_t{1} << number;
    begin = end + 1;
  }
  return set;
}

base::Status optimise(Program& program, PassSet passes, bool verify_each) {
  if (passes.empty()) return base::Ok{};
  for (const uint32_t number : callees_first(program)) {
    Pou& pou = program.pous[number];
    for (const Pass pass : kOrder) {
      if (!passes.has(pass)) continue;
      kPasses[static_cast<size_t>(pass)].run(program, pou);
      if (!verify_each) continue;
      if (base::Status sound = sound_after(program, pou, pass); !sound.ok()) return sound;
    }
  }
  return base::Ok{};
}

}  // namespace ir
