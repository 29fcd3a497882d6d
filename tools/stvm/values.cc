#include "tools/stvm/values.h"

#include "tools/common/json.h"

namespace stvm {

std::string values_text(const vm::Values& values) {
  std::string out;
  for (const vm::ValueRow& row : values.rows) out += row.path + "=" + row.value + "\n";
  return out;
}

std::string values_json(const vm::Values& values) {
  tools::JsonWriter json;
  json.begin_object().field("cycle", values.cycle).key("values").begin_object();
  for (const vm::ValueRow& row : values.rows) json.field(row.path, row.value);
  json.end_object().end_object();
  return json.finish();
}

}  // namespace stvm
