#include "tools/stvm/values.h"

#include "tools/common/json.h"
#include "tools/stvm/json_value.h"
#include "vm/runtime/forces.h"

namespace stvm {

std::string values_text(const vm::Values& values) {
  std::string out;
  for (const vm::ValueRow& row : values.rows) out += row.path + "=" + row.value + "\n";
  return out;
}

std::string values_json(const vm::Values& values) {
  tools::JsonWriter json;
  json.begin_object().field("cycle", values.cycle).field("last_cycle", values.last_cycle);
  json.key("values").begin_object();
  for (const vm::ValueRow& row : values.rows) {
    json.key(row.path);
    typed_value(json, row.type, row.value);
  }
  json.end_object().end_object();
  return json.finish();
}

std::string forces_text(const vm::ForceRows& forces) {
  std::string out;
  for (const vm::ForceRow& row : forces.rows) {
    out += row.path + "=" + row.value + "  " + vm::hold_text(row.reason) + "\n";
  }
  return out;
}

std::string forces_json(const vm::ForceRows& forces) {
  tools::JsonWriter json;
  json.begin_object().key("forces").begin_array();
  for (const vm::ForceRow& row : forces.rows) {
    json.begin_object().field("path", row.path);
    typed_fields(json, row.type, row.value);
    json.field("everywhere", row.reason.empty());
    if (!row.reason.empty()) json.field("reason", row.reason);
    json.end_object();
  }
  json.end_array().end_object();
  return json.finish();
}

}  // namespace stvm
