#include "frontend/parse/address_map.h"

#include <map>

#include "frontend/lex/literals.h"

namespace frontend {
namespace {

using base::DiagnosticCode;

constexpr std::string_view kAttribute = "address_map";
constexpr uint64_t kMaxImageBits = uint64_t{1} << 32;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

const char* letter(ir::DirectArea area) {
  if (area == ir::DirectArea::kInput) return "I";
  return area == ir::DirectArea::kOutput ? "Q" : "M";
}

class AddressMap {
 public:
  AddressMap(Tree& tree, base::Diagnostics& diagnostics) : tree_(tree), diagnostics_(diagnostics) {
    for (const Attribute& attribute : tree.attributes) {
      if (ir::same_name(attribute.name.text, kAttribute)) add(attribute);
    }
  }

  void map(ir::DirectAddress& address, Range32& levels, base::SourceSpan span) {
    if (levels.count == 0) return;
    auto first = tree_.levels.begin() + levels.first;
    for (uint32_t known = levels.count - 1; known > 0; --known) {
      Module module{address.area, {first, first + known}};
      auto found = begins_.find(module);
      if (found == begins_.end()) continue;
      Range32 channel{levels.first + known, levels.count - known};
      if (place(*found, channel, address, span)) levels = {};
      return;
    }
    report_unknown(address, levels, span);
  }

 private:
  struct Module {
    ir::DirectArea area;
    std::vector<uint32_t> levels;
    auto operator<=>(const Module&) const = default;
  };
  using Begins = std::map<Module, uint32_t>;  // bits of the process image

  void add(const Attribute& attribute) {
    std::string_view value = attribute.value;
    size_t equal = value.find('=');
    std::string_view right =
        equal == std::string_view::npos ? "" : trimmed(value.substr(equal + 1));
    DecodedModule module = decode_module(trimmed(value.substr(0, equal)));
    bool address = right.size() > 1 && right[0] == '%';
    DecodedAddress flat = address ? decode_address(right) : DecodedAddress{};
    bool good = !module.problem && address && !flat.problem && flat.levels.empty() &&
                !flat.incomplete && flat.address.area == module.area &&
                flat.address.bit_offset % 8 == 0;
    if (!good) {
      diagnostics_.add(DiagnosticCode::kUnmappedAddress, attribute.name.span,
                       "`" + std::string(value) + "` says of no module where its channels begin",
                       "write it like {attribute 'address_map' := '%I2.5.7 = %IB100'}");
      return;
    }
    auto [entry, added] =
        begins_.emplace(Module{module.area, std::move(module.levels)}, flat.address.bit_offset);
    if (added || entry->second == flat.address.bit_offset) return;
    diagnostics_.add(DiagnosticCode::kUnmappedAddress, attribute.name.span,
                     name(entry->first) + " begins at byte " + std::to_string(entry->second / 8) +
                         " already, by another attribute");
  }

  // `channel`: what stands after the module's own fields, at least one.
  bool place(const Begins::value_type& module, Range32 channel, ir::DirectAddress& address,
             base::SourceSpan span) {
    const uint32_t* at = &tree_.levels[channel.first];
    uint64_t bit = uint64_t{at[0]} * address.bit_size;
    bool with_byte = channel.count == 2 && address.bit_size == 1;
    if (with_byte) bit = uint64_t{at[0]} * 8 + at[1];
    bit += module.second;
    const char* problem = nullptr;
    if (channel.count > 2 || (channel.count == 2 && !with_byte)) {
      problem = "has more fields after its module than a channel";
    } else if (with_byte && at[1] > 7) {
      problem = "names a bit of a byte above 7";
    } else if (bit + address.bit_size > kMaxImageBits) {
      problem = "lies after the end of the process image";
    }
    if (problem != nullptr) {
      diagnostics_.add(
          DiagnosticCode::kUnmappedAddress, span,
          "this address " + std::string(problem) + "; " + name(module.first) + " is mapped");
      return false;
    }
    address.bit_offset = static_cast<uint32_t>(bit);
    return true;
  }

  static std::string name(const Module& module) {
    std::string out = std::string("%") + letter(module.area);
    for (size_t i = 0; i < module.levels.size(); ++i) {
      out += (i == 0 ? "" : ".") + std::to_string(module.levels[i]);
    }
    return out;
  }

  void report_unknown(const ir::DirectAddress& address, Range32 levels, base::SourceSpan span) {
    auto first = tree_.levels.begin() + levels.first;
    std::string module = name({address.area, {first, first + (levels.count - 1)}});
    diagnostics_.add(DiagnosticCode::kUnmappedAddress, span,
                     "nothing says where the channels of " + module + " are in the process image",
                     "put {attribute 'address_map' := '" + module + " = %" + letter(address.area) +
                         "B0'} in front of CONFIGURATION");
  }

  Tree& tree_;
  base::Diagnostics& diagnostics_;
  Begins begins_;
};

void map_variables(AddressMap& map, std::vector<VarBlock>& blocks) {
  for (VarBlock& block : blocks) {
    for (VarDecl& decl : block.vars) map.map(decl.address, decl.levels, decl.span);
  }
}

void map_variables(AddressMap& map, PouDecl& pou) {
  map_variables(map, pou.blocks);
  for (PouDecl& member : pou.members) map_variables(map, member);
}

}  // namespace

void map_addresses(Tree& tree, base::Diagnostics& diagnostics) {
  AddressMap map(tree, diagnostics);
  tree.exprs.each([&](const Expr& expr) {
    if (expr.kind != ExprKind::kDirect) return;
    Direct& direct = tree.directs[expr.number];
    map.map(direct.address, direct.levels, expr.span);
  });
  for (Spec& spec : tree.specs) {
    for (VarDecl& field : spec.fields) map.map(field.address, field.levels, field.span);
  }
  for (PouDecl& pou : tree.pous) map_variables(map, pou);
  for (PouDecl& test : tree.tests) map_variables(map, test);
  map_variables(map, tree.globals);
  for (ConfigDecl& config : tree.configs) {
    map_variables(map, config.globals);
    for (ResourceDecl& resource : config.resources) map_variables(map, resource.globals);
  }
}

}  // namespace frontend
