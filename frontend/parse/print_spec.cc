#include "frontend/parse/printer.h"

namespace frontend {

std::string Printer::spec(SpecId id) const {
  const Spec& spec = tree_[id];
  switch (spec.kind) {
    case SpecKind::kError:
      return "<error>";
    case SpecKind::kNamed:
      return named(spec);
    case SpecKind::kString:
      return (spec.wide ? "WSTRING" : "STRING") +
             (spec.length.valid() ? '[' + expression(spec.length) + ']' : std::string());
    case SpecKind::kArray:
      return array(spec);
    case SpecKind::kPointer:
      return "POINTER TO " + this->spec(spec.element);
    case SpecKind::kRefTo:
      return "REF_TO " + this->spec(spec.element);
    case SpecKind::kReferenceTo:
      return "REFERENCE TO " + this->spec(spec.element);
    case SpecKind::kUnion:
    case SpecKind::kStruct:
      return fields(spec);
    case SpecKind::kEnum:
      return enumerators(spec);
    case SpecKind::kSubrange:
      return this->spec(spec.element) + '(' + expression(spec.low) + ".." + expression(spec.high) +
             ')';
  }
  return "";
}

std::string Printer::named(const Spec& spec) const {
  std::string out(spec.name.text);
  if (spec.qualifiers.count != 0) out = path(spec.qualifiers) + '.' + out;
  return spec.has_args ? out + arguments(spec.args) : out;
}

std::string Printer::array(const Spec& spec) const {
  std::string dims;
  for (const DimSpec& dim : spec.dims) {
    if (!dims.empty()) dims += ", ";
    dims += dim.low.valid() ? expression(dim.low) + ".." + expression(dim.high) : "*";
  }
  std::string out = "ARRAY[" + dims + "] OF " + this->spec(spec.element);
  return spec.element_args.count == 0 ? out : out + '[' + list(spec.element_args) + ']';
}

std::string Printer::enumerators(const Spec& spec) const {
  std::string out = "(";
  for (const Enumerator& enumerator : spec.enumerators) {
    if (out.size() > 1) out += ", ";
    if (enumerator.attributes.count != 0) out += attribute_text(enumerator.attributes) + ' ';
    out += enumerator.name.text;
    if (enumerator.value.valid()) out += " := " + expression(enumerator.value);
  }
  return out + ')' + (spec.element.valid() ? ' ' + this->spec(spec.element) : "");
}

std::string Printer::fields(const Spec& spec) const {
  std::string out = spec.kind == SpecKind::kUnion ? "UNION" : "STRUCT";
  if (spec.overlap) out += " OVERLAP";
  if (spec.element.valid()) out += " EXTENDS " + this->spec(spec.element);
  out += '{';
  for (const VarDecl& field : spec.fields) {
    if (&field != spec.fields.begin()) out += "; ";
    out += variable(field);
  }
  return out + '}';
}

std::string Printer::address(const ir::DirectAddress& address, Range32 levels,
                             bool incomplete) const {
  const char* area = address.area == ir::DirectArea::kInput    ? "%I"
                     : address.area == ir::DirectArea::kOutput ? "%Q"
                     : address.area == ir::DirectArea::kMarker ? "%M"
                                                               : "%";
  if (address.bit_size == 0) return std::string(area) + (incomplete ? "*" : "");
  const char* size = address.bit_size == 1    ? "X"
                     : address.bit_size == 8  ? "B"
                     : address.bit_size == 16 ? "W"
                     : address.bit_size == 32 ? "D"
                                              : "L";
  std::string out = std::string(area) + size;
  if (incomplete) return out + '*';
  for (uint32_t i = 0; i < levels.count; ++i) {
    out += (i == 0 ? "" : ".") + std::to_string(tree_.levels[levels.first + i]);
  }
  if (levels.count != 0) return out;
  if (address.bit_size > 1) return out + std::to_string(address.bit_offset / address.bit_size);
  return out + std::to_string(address.bit_offset / 8) + '.' +
         std::to_string(address.bit_offset % 8);
}

}  // namespace frontend
