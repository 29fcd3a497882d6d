#include "vm/native/make_function.h"

#include <algorithm>

#include "ir/bytecode/bools.h"
#include "vm/native/build.h"
#include "vm/native/forward.h"
#include "vm/native/loops.h"
#include "vm/native/print.h"
#include "vm/native/unroll.h"

namespace vm::native {

bool is_interpreted_at_random(const TierOptions& options, uint32_t pou) {
  if (options.pou_seed == 0) return false;
  uint64_t h = (options.pou_seed + pou) * 0x9e3779b97f4a7c15u;
  h ^= h >> 29;
  return (h * 0xbf58476d1ce4e5b9u >> 40 & 1) != 0;
}

namespace {

// Handlers know the frame of a POU that was called, not that of a body in its caller: they would
// find the values of neither.
bool asks_a_handler(const Function& function) {
  return std::any_of(function.nodes.begin(), function.nodes.end(),
                     [](const Node& node) { return node.op == Op::kHelper; });
}

// What stands in the place of calls needs nothing else, and there are many of them.
void keep_for_calls(Function& function) {
  function.variables = {};
  function.overlaps = {};
  function.kills = {};
  function.nodes.shrink_to_fit();
  function.values.shrink_to_fit();
}

}  // namespace

const Body* Bodies::body(uint32_t pou, uint32_t caller) {
  if (pou == caller || is_interpreted_at_random(options_, pou)) return nullptr;
  const ir::PouVersion* const version = common_.version_of(pou);
  if (version != nullptr && version->interpreted) return nullptr;
  State& state = states_[pou];
  if (!state.asked) {
    state.asked = true;
    if (is_small(image_.pous[pou], common_.code_of(image_, image_.pous[pou]))) {
      base::Result<Facts> facts = Facts::of(image_, common_, image_.pous[pou]);
      if (facts.ok()) {
        Function function = Builder(*facts).run();
        if (asks_a_handler(function)) return nullptr;
        state.body = std::make_unique<Body>();
        state.body->function = std::move(function);
        state.body->effects = effects_of(state.body->function);
        keep_for_calls(state.body->function);
      }
    }
  }
  return state.body.get();
}

base::Result<Function> make_function(const ir::Image& image, Bodies& bodies, uint32_t pou,
                                     std::vector<uint32_t>& inlined) {
  const auto body_of = [&](uint32_t callee) { return bodies.body(callee, pou); };
  std::vector<uint32_t> unwalked;
  Function function;
  do {
    base::Result<Facts> facts =
        Facts::of(image, bodies.common(), image.pous[pou], body_of, &unwalked);
    if (!facts.ok()) return facts.error();
    function = Builder(*facts).run();
    inlined = inline_calls(function, [&](uint32_t callee) {
      return Callee{&body_of(callee)->function, bodies.units(callee)};
    });
    forward_memory(function);
    choose(function);
    insert_preheaders(function);
    if (walk_pointers(function, *facts, unwalked)) break;
  } while (true);
  number_again(function);
  drop_proven_checks(function);
  drop_unused(function);
  hoist(function);
  split_addresses(function);
  unroll(function);
  const bool sunk = sink_addresses(function);
  if (sunk || !function.loops.empty()) drop_unused(function);  // what a check once wanted
  return function;
}

std::string functions_text(const ir::Image& image) {
  const std::vector<PouEntry> pous(image.pous.size());
  const TierOptions options;
  const ImageFacts common(image, ir::Bools(image).stay_clean());
  Bodies bodies(image, common, pous, options);
  std::string out;
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    if (image.pous[pou].unit_count == 0) continue;
    out += image.pous[pou].name + "\n";
    std::vector<uint32_t> inlined;
    const base::Result<Function> function = make_function(image, bodies, pou, inlined);
    out += function.ok() ? print(*function) : "interpreted: " + function.error().text + "\n";
    out += "\n";
  }
  return out;
}

}  // namespace vm::native
