#include "frontend/sema/declarations/shared_addresses.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/types/types.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "frontend/sema/phase.h"
#include "ir/types/address_text.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"
#include "ir/types/shared_bytes.h"

namespace frontend {
namespace {

bool can_share(const ir::DirectAddress& address) {
  return address.bit_size != 0 &&
         (address.area == ir::DirectArea::kMarker || address.area == ir::DirectArea::kOutput);
}

auto place_key(const Located& located) {
  return std::tuple(located.address.area, located.address.bit_offset, located.address.bit_size,
                    located.type.index);
}

bool same_place(const Located& a, const Located& b) { return place_key(a) == place_key(b); }

}  // namespace

const AddressView* direct_view(const Phase& phase, const Expr& expr) {
  const auto& views = phase.sema().addresses.views;
  if (views.empty()) return nullptr;
  const ir::DirectAddress address = phase.sema().tree.directs[expr.number].address;
  const auto found =
      views.find(address_key(address, phase.ask<Variables>().type_of_direct(address)));
  return found == views.end() ? nullptr : &found->second;
}

std::string SharedAddresses::path_of(const Variable& variable) const {
  std::string list(variable.list);
  if (list.empty() && variable.storage == Storage::kMember) {
    list = ask<Collection>().static_list_name(sema_.declared.pous[variable.pou]);
  }
  return (list.empty() ? "" : list + ".") + std::string(variable.name.text);
}

uint64_t SharedAddresses::bits_of(ir::TypeId type, const ir::DirectAddress& address) {
  if (const uint32_t bits = ask<Variables>().address_bits(type); bits != 0) return bits;
  if (!natural_) natural_ = ir::natural_layouts(sema_.program.types);
  return ir::located_bits(sema_.program.types, *natural_, type, address);
}

void SharedAddresses::collect_variables() {
  std::vector<std::pair<uint32_t, ir::TypeId>> found;
  for (uint32_t i = 0; i < sema_.declared.variables.size(); ++i) {
    const Variable& variable = sema_.declared.variables[i];
    const VarDecl* decl = variable.decl;
    const bool located = decl != nullptr && decl->has_address && !decl->incomplete &&
                         decl->levels.count == 0 && can_share(decl->address);
    if (!located || variable.hidden || variable.section == VarSection::kExternal) continue;
    if (variable.storage == Storage::kLocal) continue;  // reported with the variable
    const PouScope scope = sema_.declared.scope_of(variable.pou);
    const ir::TypeId type = Types(sema_, scope).resolve_type(decl->spec).type;
    if (type.valid() && ask<Variables>().address_problem(type, decl->address, false).empty()) {
      found.emplace_back(i, type);
    }
  }
  for (const auto& [number, type] : found) {
    const Variable& variable = sema_.declared.variables[number];
    const Located located{variable.decl->address, type, variable.name.span, path_of(variable)};
    places_.push_back({located, VarId(number), bits_of(type, located.address)});
  }
}

void SharedAddresses::collect_direct() {
  std::set<decltype(place_key(Located()))> seen;
  sema_.tree.exprs.each([&](const Expr& expr) {
    if (expr.kind != ExprKind::kDirect) return;
    const ir::DirectAddress address = sema_.tree.directs[expr.number].address;
    if (!can_share(address)) return;
    const ir::TypeId type = ask<Variables>().type_of_direct(address);
    const Located located{address, type, expr.span, ir::address_text(address)};
    if (seen.contains(place_key(located))) return;
    if (!sema_.for_tests() && is_in_test(sema_.tree, expr.span.begin)) return;
    seen.insert(place_key(located));
    places_.push_back({located, VarId(), address.bit_size});
  });
}

void SharedAddresses::find() {
  if (sema_.report.has_errors()) return;
  collect_variables();
  collect_direct();
  // Declared ones first, globals before those of programs: they give the name.
  const auto order = [&](const Place& place) {
    const ir::DirectAddress& address = place.located.address;
    return std::tuple(address.area, address.bit_offset, !place.variable.valid(),
                      is_of_program(place));
  };
  std::stable_sort(places_.begin(), places_.end(),
                   [&](const Place& a, const Place& b) { return order(a) < order(b); });
  Group group;
  uint64_t end = 0;
  for (Place& place : places_) {
    const bool meets = !group.empty() &&
                       group[0].located.address.area == place.located.address.area &&
                       place.located.address.bit_offset < end;
    if (!meets) {
      share(group);
      group.clear();
      end = 0;
    }
    end = std::max(end, place.end());
    group.push_back(std::move(place));
  }
  share(group);
  number_again();
}

bool SharedAddresses::is_of_program(const Place& place) const {
  return place.variable.valid() &&
         sema_.declared.variables[place.variable.index].storage != Storage::kGlobal;
}

bool SharedAddresses::has_several_instances(const Place& place) const {
  if (!is_of_program(place) || sema_.declared.resource == nullptr) return false;
  const PouInfo& pou = sema_.declared.pous[sema_.declared.variables[place.variable.index].pou];
  const std::vector<ProgramDecl>& all = sema_.declared.resource->programs;
  return 1 < std::count_if(all.begin(), all.end(), [&](const ProgramDecl& program) {
           return ir::same_name(program.type.text, pou.name);
         });
}

void SharedAddresses::share(const Group& group) {
  if (group.empty()) return;
  const bool one_place = std::all_of(group.begin(), group.end(), [&](const Place& place) {
    return same_place(place.located, group[0].located);
  });
  // A bare address is the global of its place and type (Sema::direct_member).
  const bool alone = group.size() == 1 ||
                     (group.size() == 2 && !group[1].variable.valid() && !is_of_program(group[0]));
  if (one_place && alone && !has_several_instances(group[0])) return;
  if (!check(group, one_place)) return;
  const auto is_direct = [](const Place& place) { return !place.variable.valid(); };
  sema_.addresses.direct_shares |= std::any_of(group.begin(), group.end(), is_direct);
  one_place ? make_one(group) : make_structure(group);
  leave(group);
}

// What one variable at a place cannot be when others have its bytes; empty: it can.
std::string SharedAddresses::why_not(const Place& place, bool one_place) const {
  if (place.variable.valid()) {
    const Variable& variable = sema_.declared.variables[place.variable.index];
    if (is_of_program(place)) {
      const PouInfo& pou = sema_.declared.pous[variable.pou];
      if (pou.decl->kind != PouKind::kProgram) return "each instance has one of its own";
      if (variable.section != VarSection::kLocal) return "callers of the program pass it";
    }
    if (variable.constant) return "it is a CONSTANT";
  }
  return one_place ? std::string() : why_not_type(place.located.type);
}

// Whatever bits others write have to be a value of it.
std::string SharedAddresses::why_not_type(ir::TypeId type) const {
  const ir::TypeTable& types = sema_.program.types;
  if (ask<Variables>().address_bits(type) == 1) {
    return types[type].kind == ir::Kind::kBool ? std::string() : "not each bit is a value of it";
  }
  std::vector<ir::TypeId> open{type};
  std::set<uint32_t> seen;
  while (!open.empty()) {
    const ir::TypeId at = open.back();
    open.pop_back();
    if (!seen.insert(at.index).second) continue;
    const ir::Type& part = types[at];
    if (part.kind == ir::Kind::kArray) {
      open.push_back(part.base);
    } else if (ir::is_structure(part.kind)) {
      for (const ir::Member& member : part.members) open.push_back(member.type);
    } else if (part.kind == ir::Kind::kEnum || part.kind == ir::Kind::kSubrange ||
               types.is_reference(at)) {
      return "not all bits are a value of `" + types.text(at) + "`";
    } else if (part.kind == ir::Kind::kBool) {
      return "a BOOL in it has a byte of its own, which is 0 or 1";
    }
  }
  return {};
}

void SharedAddresses::report(const Place& place, const Group& group, const std::string& why) {
  const auto named = [](const Located& located) {
    const std::string at = ir::address_text(located.address);
    return "`" + located.name + "`" + (located.name == at ? "" : " AT " + at);
  };
  const auto other = std::find_if(group.begin(), group.end(), [&](const Place& one) {
    return one.located.span.begin.offset != place.located.span.begin.offset &&
           one.located.address.bit_offset < place.end() &&
           place.located.address.bit_offset < one.end();
  });
  const Located& here = place.located;
  std::string text = named(here);
  if (other != group.end()) {
    const base::SourceLocation at = sema_.sources.locate(other->located.span.begin);
    text += " lies on bytes of " + named(other->located) + " (line " + std::to_string(at.line) +
            "), but cannot share them: ";
  } else {
    text += " is one place for several instances, but cannot be shared: ";
  }
  error(DiagnosticCode::kBadAddress, here.span, text + why,
        "give one of them another address, or declare here a type of numbers, bits or times "
        "in VAR_GLOBAL or in VAR of a program");
}

bool SharedAddresses::check(const Group& group, bool one_place) {
  for (const Place& place : group) {
    const std::string why = why_not(place, one_place);
    if (why.empty()) continue;
    report(place, group, why);
    return false;
  }
  for (const Place& place : group) {
    if (place.variable.valid()) resolve(place.variable);
  }
  return check_initial(group);
}

// Two initial values of the same bits contradict each other.
bool SharedAddresses::check_initial(const Group& group) {
  const Place* furthest = nullptr;
  for (const Place& place : group) {
    if (!place.variable.valid() || !resolve(place.variable).init.valid()) continue;
    if (furthest != nullptr && place.located.address.bit_offset < furthest->end()) {
      report(place, {*furthest}, "both have an initial value");
      return false;
    }
    furthest = &place;
  }
  return true;
}

// One variable with several names.
void SharedAddresses::make_one(const Group& group) {
  const VarId first = group[0].variable;
  Variable& one = sema_.declared.variables[first.index];
  if (one.storage != Storage::kGlobal) {
    one.list =
        sema_.declared.keep_name(ask<Collection>().static_list_name(sema_.declared.pous[one.pou]));
    programs_[one.pou] = true;
    one.storage = Storage::kGlobal;
    sema_.declared.global_order.push_back(first);
  }
  for (const Place& place : group) {
    if (!place.variable.valid() || place.variable == first) continue;
    Variable& other = sema_.declared.variables[place.variable.index];
    one.retain = one.retain || other.retain;
    if (other.init.valid()) one.init = other.init;
    other.same_as = first;
    sema_.program.access.push_back({place.located.name, group[0].located.name, true});
  }
}

// For a bit: the initial value of its byte, with the other bits in it.
ir::ConstId SharedAddresses::initial_of(const Group& group, const Place& place) const {
  if (!place.variable.valid()) return {};
  const ir::ConstId own = sema_.declared.variables[place.variable.index].init;
  if (place.bits != 1 || !own.valid()) return own;
  const uint32_t begin = place.located.address.bit_offset / 8 * 8;
  uint64_t byte = 0;
  auto other = std::partition_point(group.begin(), group.end(), [&](const Place& one) {
    return one.located.address.bit_offset < begin;
  });
  for (; other != group.end() && other->located.address.bit_offset < begin + 8; ++other) {
    const uint32_t bit = other->located.address.bit_offset;
    const bool here = other->bits == 1 && other->variable.valid();
    const ir::ConstId init =
        here ? sema_.declared.variables[other->variable.index].init : ir::ConstId();
    if (init.valid() && sema_.program.constants[init].bits != 0) byte |= 1u << bit % 8;
  }
  return byte == 0 ? ir::ConstId() : sema_.program.constants.scalar(byte);
}

void SharedAddresses::make_structure(const Group& group) {
  if (!natural_) natural_ = ir::natural_layouts(sema_.program.types);
  uint32_t align = 1;
  for (const Place& place : group) {
    if (place.bits != 1) align = std::max(align, (*natural_)[place.located.type].align);
  }
  const uint32_t begin = group[0].located.address.bit_offset / 8 / align * align;
  ir::Type type;
  type.kind = ir::Kind::kStruct;
  type.overlap = true;
  std::set<decltype(place_key(Located()))> known;
  std::vector<std::pair<VarId, AddressView>> views;
  std::vector<std::pair<std::string, AddressView>> direct;
  Group ordered = group;  // bits after what they are parts of
  std::stable_partition(ordered.begin(), ordered.end(),
                        [](const Place& place) { return place.bits != 1; });
  for (const Place& place : ordered) {
    const Located& here = place.located;
    const bool bit = place.bits == 1;
    AddressView view;
    view.member = static_cast<uint32_t>(type.members.size());
    if (bit) view.bit = static_cast<int32_t>(here.address.bit_offset % 8);
    const bool fresh = known.insert(place_key(here)).second;
    if (!place.variable.valid() && !fresh) continue;  // the variable that lies there
    ir::Member member;
    member.name = here.name;
    member.type = bit ? sema_.program.types.elementary(ir::Kind::kByte) : here.type;
    member.init = initial_of(group, place);
    member.address.bit_offset = here.address.bit_offset - 8 * begin;
    member.address.bit_size = here.address.bit_size;
    type.members.push_back(std::move(member));
    if (place.variable.valid()) views.emplace_back(place.variable, view);
    if (fresh) direct.emplace_back(address_key(here.address, here.type), view);
  }
  const uint32_t global = add_global(group, std::move(type), begin);
  for (auto& [key, view] : direct) {
    view.global = global;
    sema_.addresses.views.emplace(std::move(key), view);
  }
  for (auto& [id, view] : views) {
    view.global = global;
    sema_.declared.variables[id.index].view = view;
  }
}

// Returns its number among the variables; number_again() knows that among the globals.
uint32_t SharedAddresses::add_global(const Group& group, ir::Type type, uint32_t begin) {
  uint64_t end = 0;
  Variable shared;
  for (const Place& place : group) {
    end = std::max(end, place.end());
    if (!place.variable.valid()) continue;
    shared.retain = shared.retain || sema_.declared.variables[place.variable.index].retain;
  }
  const ir::DirectArea area = group[0].located.address.area;
  shared.name = {
      sema_.declared.keep_name(ir::shared_name(area, begin, static_cast<uint32_t>(end - 1) / 8)),
      group[0].located.span};
  shared.section = VarSection::kGlobal;
  shared.storage = Storage::kGlobal;
  shared.used = shared.written = shared.hidden = true;
  shared.progress = Progress::kDone;
  shared.type = sema_.program.types.declare(std::move(type));
  shared.address = {area, 8 * begin, 8};
  const auto number = static_cast<uint32_t>(sema_.declared.variables.size());
  sema_.declared.variables.push_back(std::move(shared));
  sema_.declared.global_order.push_back(VarId(number));
  return number;
}

// Views are no globals of their own, and no members of their program.
void SharedAddresses::leave(const Group& group) {
  for (const Place& place : group) {
    if (!place.variable.valid()) continue;
    Variable& variable = sema_.declared.variables[place.variable.index];
    if (variable.storage != Storage::kGlobal) programs_[variable.pou] = true;
    variable.storage = Storage::kGlobal;
  }
}

void SharedAddresses::number_again() {
  const auto is_view = [&](VarId id) {
    const Variable& variable = sema_.declared.variables[id.index];
    return variable.same_as.valid() || variable.view.global != AddressView::kNone;
  };
  const auto outer =
      sema_.declared.global_order.begin() + static_cast<ptrdiff_t>(sema_.declared.outer_globals);
  sema_.declared.outer_globals -=
      static_cast<size_t>(std::count_if(sema_.declared.global_order.begin(), outer, is_view));
  std::erase_if(sema_.declared.global_order, is_view);
  for (uint32_t i = 0; i < sema_.declared.global_order.size(); ++i) {
    sema_.declared.variables[sema_.declared.global_order[i].index].index = i;
  }
  const auto global_of = [&](AddressView& view) {
    if (view.global != AddressView::kNone)
      view.global = sema_.declared.variables[view.global].index;
  };
  for (auto& [key, view] : sema_.addresses.views) global_of(view);
  for (Variable& variable : sema_.declared.variables) {
    if (variable.same_as.valid())
      variable.index = sema_.declared.variables[variable.same_as.index].index;
    global_of(variable.view);
    if (variable.view.global != AddressView::kNone) variable.index = variable.view.global;
  }
  for (const auto& [pou, left] : programs_)
    ask<Collection>().number_variables(sema_.declared.pous[pou]);
}

}  // namespace frontend
