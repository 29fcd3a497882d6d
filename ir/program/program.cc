#include "ir/program/ir.h"

namespace ir {
namespace {

template <class Matches>
PouId find_if(const std::vector<Pou>& pous, Matches matches) {
  for (uint32_t i = 0; i < pous.size(); ++i) {
    if (matches(pous[i])) {
      return PouId(i);
    }
  }
  return PouId();
}

}  // namespace

PouId Program::find_pou(std::string_view wanted) const {
  return find_if(pous, [wanted](const Pou& pou) { return same_name(pou.name, wanted); });
}

PouId Program::pou_of_instance_type(TypeId type) const {
  return find_if(pous, [type](const Pou& pou) { return is_body(pou.kind) && pou.self == type; });
}

}  // namespace ir
