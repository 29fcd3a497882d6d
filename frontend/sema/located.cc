// Variables at addresses (AT %QW4) and addresses in code (%QW4).
#include <algorithm>
#include <tuple>

#include "frontend/sema/sema.h"

namespace frontend {

// Each output or marker variable has storage of its own, so overlapping ones cannot mean the same
// bits. Inputs may overlap: nobody writes them. The same address and type in VAR_GLOBAL and in
// code is one variable.
void Sema::check_direct_addresses() {
  std::vector<Located> all = direct_uses_;
  for (const Variable& variable : variables_) {
    if (variable.decl == nullptr || !variable.decl->has_address || variable.decl->incomplete)
      continue;
    all.push_back({variable.decl->address, variable.name.span, std::string(variable.name.text)});
  }
  std::erase_if(all, [](const Located& one) {
    return one.address.area == ir::DirectArea::kInput || one.address.area == ir::DirectArea::kNone;
  });
  std::stable_sort(all.begin(), all.end(), [](const Located& a, const Located& b) {
    return std::tuple(a.address.area, a.address.bit_offset) <
           std::tuple(b.address.area, b.address.bit_offset);
  });
  const Located* last = nullptr;  // the one that reaches furthest
  for (const Located& one : all) {
    bool same_area = last != nullptr && last->address.area == one.address.area;
    if (same_area && one.address.bit_offset < last->end()) {
      bool marker = one.address.area == ir::DirectArea::kMarker;
      error(DiagnosticCode::kBadAddress, one.span,
            "`" + one.name + "` lies on the same " + (marker ? "marker" : "output") + " bits as `" +
                last->name + "`",
            "use one of them everywhere (declare it in VAR_GLOBAL), and its parts: " + last->name +
                ".%X0, .%B1");
    }
    if (!same_area || one.end() > last->end()) last = &one;
  }
}

ir::TypeId Sema::type_of_direct(const ir::DirectAddress& address) const {
  switch (address.bit_size) {
    case 1:
      return program.types.elementary(ir::Kind::kBool);
    case 8:
      return program.types.elementary(ir::Kind::kByte);
    case 16:
      return program.types.elementary(ir::Kind::kWord);
    case 32:
      return program.types.elementary(ir::Kind::kDword);
    default:
      return program.types.elementary(ir::Kind::kLword);
  }
}

// A bare %QX0.0 in code is a global variable of that name, one per address. A
// declared global at exactly this address is the same variable.
uint32_t Sema::direct_member(const Expr& expr) {
  std::string name = ir::fold_name(expr.name.text);
  if (auto known = direct_members_.find(name); known != direct_members_.end()) {
    return known->second;
  }
  ir::Type& globals = program.types.edit(program.globals);
  ir::TypeId type = type_of_direct(expr.address);
  uint32_t index = 0;
  while (index < globals.members.size() &&
         !(globals.members[index].address == expr.address && globals.members[index].type == type)) {
    ++index;
  }
  if (index == globals.members.size()) {
    ir::Member member;
    member.name = expr.name.text;
    member.type = type;
    member.section = ir::Section::kGlobal;
    member.address = expr.address;
    globals.members.push_back(std::move(member));
    direct_uses_.push_back({expr.address, expr.span, std::string(expr.name.text)});
  }
  direct_members_.emplace(std::move(name), index);
  return index;
}

}  // namespace frontend
