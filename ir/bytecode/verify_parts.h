// The parts of verify(): each checks one thing and reports the first violation.
// Later parts rely on what earlier ones have proven, in the order of this header.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/regions.h"
#include "ir/bytecode/verify.h"

namespace ir::verification {

using base::Refusal;

inline constexpr uint32_t kNone = 0xffffffffu;

inline base::Error refuse(base::Refusal refusal, std::string text) {
  return {refusal, std::move(text)};
}

// --- verify_types.cc: types and layouts agree, nothing contains itself ---------
struct TypeFacts {
  bool has_slots = false;  // a value contains instance or in-out slots
  uint32_t depth = 0;      // levels of embedded values
};
base::Result<std::vector<TypeFacts>> verify_types(const Image& image);
base::Status verify_constants(const Image& image);

class Likeness;  // proof.h

// What the parts after it share.
struct Context {
  // Borrows all. `r`: of the image's types and layouts.
  Context(const Image& i, const std::vector<TypeFacts>& f, const RegionMap& r)
      : image(i), facts(f), regions(r) {}
  const Image& image;
  const std::vector<TypeFacts>& facts;
  const RegionMap& regions;
  std::vector<uint32_t> pou_of_type;  // bodies, by type number; kNone
  bool valid(Region region) const;    // names an existing type and dimension
};

// --- verify_tables.cc: POU table, slots, bounds, ranges, limits -----------------
base::Status verify_tables(Context& context, const Likeness& likeness);

// --- verify_overrides.cc: what virtual calls find -------------------------------
base::Status verify_overrides(const Image& image);

// --- verify_migrations.cc: functions that migrate values, after all tables ------
base::Status verify_migrations(const Image& image);

// --- verify_charts.cc: nets of charts, after all POUs and types -----------------
base::Status verify_charts(const Image& image);
// --- verify_tables.cc: identities of what sources say, for all POUs or for none --------
base::Status verify_contents(const Image& image);

// --- verify_instances.cc: areas and the instance tree (V13) ---------------------
base::Status verify_instances(const Context& context);
// --- verify_resources.cc: tasks, I/O, retain, initial data (V14 to V16) ---------
base::Status verify_initial_data(const Image& image);
// Instances that have an area, by its place. Only what lies in one of them can be exchanged or
// kept.
std::vector<uint32_t> areas_in_order(const Image& image);
base::Status verify_resources(const Context& context, const std::vector<uint32_t>& areas);

// --- verify_code.h: one POU in one pass (V3 to V10, V12, V19, V20) -------------
struct CodeFacts {
  std::vector<uint32_t> callees;        // nodes of the call graph, each once per call
  std::vector<Extent> written_outputs;  // %Q globals in data memory
  uint32_t native_bytes = 0;            // argument area of native calls
  // What the answer relies on beside the POU itself, types and roles of POUs (proof.h).
  std::vector<uint32_t> parameters_of;  // POUs, each once per call
  std::vector<Extent> constants;        // bytes of the pool that are named; sorted, disjoint
  uint32_t bounds_end = 0;              // numbers of bounds are below
  uint32_t ranges_end = 0;
};
struct CodeRoom;  // verify_code.h
base::Result<CodeFacts> verify_code(const Context& context, CodeRoom& room, uint32_t pou);
base::Result<CodeFacts> verify_code(const Context& context, uint32_t pou);
// The facts of other code in its place (pou_version.h).
base::Result<CodeFacts> verify_code(const Context& context, uint32_t pou,
                                    std::span<const Unit> code);

// --- verify_calls.cc: call graph, stack, output writers (V11, V14) --------------
// By POU, shared by versions; null: a number without one.
using CodeFactsOfAll = std::vector<std::shared_ptr<const CodeFacts>>;
base::Result<CallFacts> verify_calls(const Context& context, const CodeFactsOfAll& code);

}  // namespace ir::verification
