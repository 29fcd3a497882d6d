#include "frontend/parse/printer.h"

namespace frontend {

std::string Printer::spec(SpecId id) const {
  const Spec& spec = tree_[id];
  switch (spec.kind) {
    case SpecKind::kError:
      return "<error>";
    case SpecKind::kNamed:
      return std::string(spec.name.text);
    case SpecKind::kString:
      return (spec.wide ? "WSTRING" : "STRING") +
             (spec.length.valid() ? '[' + expression(spec.length) + ']' : std::string());
    case SpecKind::kArray: {
      std::string dims;
      for (const DimSpec& dim : spec.dims) {
        dims += (dims.empty() ? "" : ", ") + expression(dim.low) + ".." + expression(dim.high);
      }
      return "ARRAY[" + dims + "] OF " + this->spec(spec.element);
    }
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

std::string Printer::enumerators(const Spec& spec) const {
  std::string out = "(";
  for (const Enumerator& enumerator : spec.enumerators) {
    if (out.size() > 1) out += ", ";
    out += enumerator.name.text;
    if (enumerator.value.valid()) out += " := " + expression(enumerator.value);
  }
  return out + ')' + (spec.element.valid() ? ' ' + this->spec(spec.element) : "");
}

std::string Printer::fields(const Spec& spec) const {
  std::string out = "STRUCT{";
  for (const VarDecl& field : spec.fields) {
    if (out.back() != '{') out += "; ";
    for (size_t i = 0; i < field.names.size(); ++i) {
      out += (i == 0 ? "" : ", ") + std::string(field.names[i].text);
    }
    out += " : " + this->spec(field.spec);
    if (field.init.valid()) out += " := " + expression(field.init);
  }
  return out + '}';
}

std::string Printer::address(const ir::DirectAddress& address) const {
  const char* area = address.area == ir::DirectArea::kInput    ? "%I"
                     : address.area == ir::DirectArea::kOutput ? "%Q"
                     : address.area == ir::DirectArea::kMarker ? "%M"
                                                               : "%?";
  if (address.bit_size == 0) return std::string(area) + "?";
  const char* size = address.bit_size == 1    ? "X"
                     : address.bit_size == 8  ? "B"
                     : address.bit_size == 16 ? "W"
                     : address.bit_size == 32 ? "D"
                                              : "L";
  std::string out = std::string(area) + size;
  if (address.bit_size > 1) return out + std::to_string(address.bit_offset / address.bit_size);
  return out + std::to_string(address.bit_offset / 8) + '.' +
         std::to_string(address.bit_offset % 8);
}

}  // namespace frontend
