// Variables at addresses (AT %QW4) and addresses in code (%QW4).
#include <algorithm>

#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/sema.h"
#include "ir/types/location.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

// How many of the globals have their key.
constexpr const char* kKeyCount = "@";

}  // namespace

bool is_in_test(const Tree& tree, base::SourcePos at) {
  return std::any_of(tree.tests.begin(), tree.tests.end(), [at](const PouDecl& test) {
    return !(at < test.span.begin) && at < test.span.end;
  });
}

std::string address_key(const ir::DirectAddress& address, ir::TypeId type) {
  return "@" + std::to_string(static_cast<int>(address.area)) + "." +
         std::to_string(address.bit_offset) + "." + std::to_string(address.bit_size) + "." +
         std::to_string(type.index);
}

// 0: an address with another size than the type's, whatever that is, is none of its own.
uint32_t Variables::address_bits(ir::TypeId type) const {
  if (!type.valid() || !sema_.program.types.is_scalar(type)) return 0;
  ir::Scalar machine = sema_.program.types.scalar(type);
  return machine == ir::Scalar::kBool ? 1 : ir::scalar_size(machine) * 8;
}

// Why a variable of this type cannot be there; empty: it can. An open address (`%I*`) may leave
// out the size.
std::string Variables::address_problem(ir::TypeId type, const ir::DirectAddress& address,
                                       bool open) {
  std::string is = "is `" + sema_.report.type_text(type) + "`";
  bool marker = address.area == ir::DirectArea::kMarker;
  bool plain = ir::is_locatable(sema_.program.types, type) ||
               (marker && !ir::holds_instance(sema_.program.types, type));
  if (!plain) return is + ", which cannot have an address";
  if (uint32_t bits = address_bits(type); bits != 0) {
    if (bits == address.bit_size || (open && address.bit_size == 0)) return {};
    return is + ", the address has " + std::to_string(address.bit_size) + " bits";
  }
  bool bits = address.bit_size == 1 && ir::located_bools(sema_.program.types, type, address) != 0;
  if (open || bits || address.bit_offset % 8 == 0) return {};
  return is + ", which begins at a byte";
}

void Variables::check_address(const Variable& variable) {
  if (!variable.decl->has_address || variable.hidden || variable.decl->levels.count != 0) return;
  const VarDecl& decl = *variable.decl;
  std::string problem = address_problem(variable.type, decl.address, decl.incomplete);
  if (!problem.empty()) {
    error(DiagnosticCode::kBadAddress, variable.name.span,
          "`" + std::string(variable.name.text) + "` " + problem,
          "use X for BOOL, B W D L for 8 16 32 64 bits; arrays and structures of them begin at "
          "their first byte");
  }
  if (variable.storage == Storage::kLocal) {
    error(DiagnosticCode::kBadAddress, variable.name.span,
          "`" + std::string(variable.name.text) +
              "` lives only during a call and cannot have an address");
  }
}

// AT %I* of a member: each variable of the structure's type has such a place, which VAR_CONFIG
// gives it.
bool Variables::check_field_address(const VarDecl& field, ir::TypeId type) {
  std::string problem = field.incomplete
                            ? address_problem(type, field.address, true)
                            : "is a member: all variables of its type would share the address";
  if (problem.empty()) return true;
  error(DiagnosticCode::kBadAddress, field.span,
        (field.names.empty() ? "it" : "`" + std::string(field.names[0].text) + "`") + " " + problem,
        "write AT %I*, %Q* or %M* here and give each variable its address in VAR_CONFIG");
  return false;
}

bool Variables::holds_input(ir::TypeId type) const {
  return ir::any_member(sema_.program.types, type, [](const ir::Member& member) {
    return member.address.area == ir::DirectArea::kInput;
  });
}

ir::TypeId type_of_direct(const ir::TypeTable& types, const ir::DirectAddress& address) {
  switch (address.bit_size) {
    case 1:
      return types.elementary(ir::Kind::kBool);
    case 8:
      return types.elementary(ir::Kind::kByte);
    case 16:
      return types.elementary(ir::Kind::kWord);
    case 32:
      return types.elementary(ir::Kind::kDword);
    default:
      return types.elementary(ir::Kind::kLword);
  }
}

ir::TypeId Variables::type_of_direct(const ir::DirectAddress& address) const {
  return frontend::type_of_direct(sema_.program.types, address);
}

// A bare %QX0.0 in code is a global variable of that name, one per address. A
// declared global at exactly this address is the same variable.
uint32_t Variables::direct_member(const Expr& expr) {
  std::string name = ir::fold_name(expr.name.text);
  if (auto known = sema_.addresses.direct_members.find(name);
      known != sema_.addresses.direct_members.end()) {
    return known->second;
  }
  ir::Type& globals = sema_.program.types.edit(sema_.program.globals);
  uint32_t& keys = sema_.addresses.direct_members[kKeyCount];
  for (; keys < globals.members.size(); ++keys) {
    const ir::Member& member = globals.members[keys];
    const bool located = member.address.area != ir::DirectArea::kNone;
    if (located)
      sema_.addresses.direct_members.emplace(address_key(member.address, member.type), keys);
  }
  const ir::DirectAddress address = sema_.tree.directs[expr.number].address;
  const ir::TypeId type = type_of_direct(address);
  const auto size = static_cast<uint32_t>(globals.members.size());
  const uint32_t index =
      sema_.addresses.direct_members.emplace(address_key(address, type), size).first->second;
  if (index == size) {
    ir::Member member;
    member.name = expr.name.text;
    member.type = type;
    member.section = ir::Section::kGlobal;
    member.address = address;
    globals.members.push_back(std::move(member));
    sema_.addresses.direct_uses.push_back({address, type, expr.span, std::string(expr.name.text)});
  }
  sema_.addresses.direct_members.emplace(std::move(name), index);
  return index;
}

}  // namespace frontend
