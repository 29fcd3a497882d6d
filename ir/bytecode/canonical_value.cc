#include "ir/bytecode/canonical_value.h"

#include "base/name_case.h"

namespace ir {
namespace {

constexpr uint32_t kMaxValueDepth = 1000;

void write_name(base::ByteWriter& out, const std::string& text) {
  out.u32(static_cast<uint32_t>(text.size()));
  base::fold_name(text, reinterpret_cast<char*>(out.extend(text.size())));
}

void write_value(base::ByteWriter& out, const TypeTable& types, const ConstTable& constants,
                 TypeId type, ConstId value, uint32_t depth) {
  out.boolean(value.valid());
  // Nothing is left of an element that its type does not have.
  if (!value.valid() || depth > kMaxValueDepth || !types.contains(type)) return;
  const ConstValue& content = constants[value];
  const Type& at = types[type];
  out.u64(content.bits);
  out.text(content.text);
  out.u32(static_cast<uint32_t>(content.elements.size()));
  for (const ConstElement& element : content.elements) {
    const bool member = element.first < at.members.size();
    if (member) {
      write_name(out, at.members[element.first].name);
    } else {
      out.u32(element.first);
    }
    out.u32(element.count);
    write_value(out, types, constants, member ? at.members[element.first].type : at.base,
                element.value, depth + 1);
  }
}

}  // namespace

void write_canonical(base::ByteWriter& out, const TypeTable& types, const ConstTable& constants,
                     TypeId type, ConstId value) {
  write_value(out, types, constants, type, value, 0);
}

}  // namespace ir
