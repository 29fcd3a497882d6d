// Every use is after its definition, on every way.
#include <string>

#include "ir/program/dominators.h"
#include "ir/program/verify_parts.h"

namespace ir {
namespace {

constexpr uint32_t kUnreached = 0xffffffffu;

struct Definition {
  uint32_t block = kUnreached;
  uint32_t position = 0;  // 0 for parameters, instruction number + 1 otherwise
};

std::vector<Definition> find_definitions(const Pou& pou) {
  std::vector<Definition> definitions(pou.values.size());
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (const ValueId param : pou.blocks[b].params) {
      definitions[param.index] = {b, 0};
    }
    for (uint32_t i = 0; i < pou.blocks[b].insts.size(); ++i) {
      if (const ValueId result = pou.blocks[b].insts[i].result; result.valid()) {
        definitions[result.index] = {b, i + 1};
      }
    }
  }
  return definitions;
}

void add_place_values(const Pou& pou, PlaceId id, ValueList& values) {
  if (!id.valid()) {
    return;
  }
  const Place& place = pou.places[id.index];
  if (place.base == PlaceBase::kPointee || place.base == PlaceBase::kTarget) {
    values.push_back(place.value);
  }
  for (const Step& step : place.steps) {
    if (step.value.valid()) {
      values.push_back(step.value);
    }
  }
}

}  // namespace

ValueList used_values(const Pou& pou, const Inst& inst) {
  ValueList values = inst.operands;
  add_place_values(pou, inst.place, values);
  add_place_values(pou, inst.place2, values);
  for (const Target& target : inst.targets) {
    values.insert(values.end(), target.args);
  }
  return values;
}

base::Status verify_dominance(const Pou& pou) {
  const Dominators dominators(pou);
  const std::vector<Definition> definitions = find_definitions(pou);
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (uint32_t i = 0; i < pou.blocks[b].insts.size() && dominators.reachable(b); ++i) {
      for (const ValueId value : used_values(pou, pou.blocks[b].insts[i])) {
        const Definition& definition = definitions[value.index];
        const bool before = definition.block == b ? definition.position <= i
                                                  : definition.block != kUnreached &&
                                                        dominators.dominates(definition.block, b);
        if (!before) {
          return not_verified(inst_place(pou, b, i) + "v" + std::to_string(value.index) +
                              " is used where it may not be defined");
        }
      }
    }
  }
  return base::Ok{};
}

}  // namespace ir
