#include "ir/types/constants.h"

namespace ir {

std::vector<MemberInit> overlap_inits(const TypeTable& types, const ConstTable& constants,
                                      TypeId type, ConstId value) {
  const std::vector<Member>& members = types[type].members;
  std::vector<MemberInit> inits;
  for (size_t i = members.size(); i-- > 0;) {
    if (!members[i].init.valid()) {
      inits.push_back({i, ConstId()});
    }
  }
  for (size_t i = 0; i < members.size(); ++i) {
    if (members[i].init.valid()) {
      inits.push_back({i, members[i].init});
    }
  }
  for (const ConstId list : {types[type].init, value}) {
    if (!list.valid()) {
      continue;
    }
    for (const ConstElement& element : constants[list].elements) {
      if (element.first < members.size()) {
        inits.push_back({element.first, element.value});
      }
    }
  }
  return inits;
}

}  // namespace ir
