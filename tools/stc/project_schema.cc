#include "tools/stc/project_schema.h"

#include "base/warning_policy.h"
#include "ir/bytecode/devices.h"
#include "tools/common/json.h"
#include "tools/common/options.h"
#include "tools/common/project_file.h"

namespace stc {
namespace {

using tools::JsonWriter;
using tools::KeyKind;
using tools::ProjectKey;

void text_list(JsonWriter& json) {
  json.field("type", "array").key("items").begin_object().field("type", "string").end_object();
}

// As stc.toml would have it: `"iec"`, 25, true, `[]`.
void fallback_json(const ProjectKey& key, JsonWriter& json) {
  if (key.fallback.empty()) return;
  json.key("default");
  switch (key.kind) {
    case KeyKind::kText:
      json.value(key.fallback.substr(1, key.fallback.size() - 2));
      break;
    case KeyKind::kNumber:
      json.value(static_cast<int64_t>(std::stoll(std::string(key.fallback))));
      break;
    case KeyKind::kFlag:
      json.value(key.fallback == "true");
      break;
    case KeyKind::kTexts:
      json.begin_array().end_array();
      break;
  }
}

void key_json(const ProjectKey& key, std::string_view name, JsonWriter& json) {
  json.key(name).begin_object().field("description", key.help);
  switch (key.kind) {
    case KeyKind::kText:
      json.field("type", "string");
      if (key.choices.empty()) json.field("minLength", 1);
      break;
    case KeyKind::kNumber:
      json.field("type", "integer").field("minimum", key.low).field("maximum", key.high);
      break;
    case KeyKind::kFlag:
      json.field("type", "boolean");
      break;
    case KeyKind::kTexts:
      text_list(json);
      break;
  }
  if (!key.choices.empty()) {
    json.key("enum").begin_array();
    for (std::string_view word : tools::words_of(key.choices)) json.value(word);
    json.end_array();
  }
  fallback_json(key, json);
  json.end_object();
}

void begin_table(JsonWriter& json) {
  json.begin_object().field("type", "object").field("additionalProperties", false);
  json.key("properties").begin_object();
}

void end_table(JsonWriter& json) { json.end_object().end_object(); }

// The keys of `table` ("slack."), or those outside of tables ("").
void keys_json(std::string_view table, JsonWriter& json) {
  for (const ProjectKey& key : tools::project_keys()) {
    if (key.name.substr(0, key.name.find('.') + 1) != table) continue;
    key_json(key, key.name.substr(table.size()), json);
  }
}

// [warnings] has the codes of warnings and notes for keys.
void levels_json(JsonWriter& json) {
  for (uint32_t i = 0; i < base::diagnostic_count(); ++i) {
    const auto& row = base::diagnostic_row(static_cast<base::DiagnosticCode>(i));
    if (row.severity == base::Severity::kError) continue;
    key_json({row.code, KeyKind::kText, 0, 0, base::kWarningLevels, "", row.title}, row.code, json);
  }
}

// A setting of a device may be written as a text or as what it is; drivers say which they know.
void setting_json(const ir::SettingRow& row, JsonWriter& json) {
  json.key(row.key).begin_object().field("description", row.meaning);
  if (row.kind == ir::SettingKind::kFlag) {
    json.field("type", "boolean");
  } else if (row.kind == ir::SettingKind::kNumber) {
    json.key("type").begin_array().value("integer").value("string").end_array();
    json.field("minimum", row.low).field("maximum", row.high);
  } else {
    json.key("type").begin_array().value("string").value("integer").end_array();
  }
  json.end_object();
}

void driver_json(const ir::DriverRow& driver, JsonWriter& json) {
  json.begin_object().key("if").begin_object().key("properties").begin_object();
  json.key("driver").begin_object().field("const", driver.name).end_object();
  json.end_object().end_object().key("then");
  begin_table(json);
  json.key("driver").begin_object().end_object().key("map").begin_object().end_object();
  json.key("quality").begin_object().end_object().key("resource").begin_object().end_object();
  for (const ir::SettingRow& row : ir::setting_rows()) {
    if ((row.families & driver.family) != 0) setting_json(row, json);
  }
  end_table(json);
  json.end_object();
}

void devices_json(JsonWriter& json) {
  json.key("devices").begin_object().field("type", "object");
  json.field("description", "what stands behind %I and %Q, a table for each device");
  json.key("additionalProperties").begin_object().field("type", "object");
  json.key("required").begin_array().value("driver").end_array();
  json.key("properties").begin_object().key("driver").begin_object().key("enum").begin_array();
  for (const ir::DriverRow& driver : ir::driver_rows()) json.value(driver.name);
  json.end_array().end_object().key("map").begin_object();
  text_list(json);
  json.end_object().key("quality").begin_object().field("type", "string").end_object();
  json.key("resource").begin_object().field("type", "string").field("minLength", 1).end_object();
  json.end_object().key("allOf").begin_array();
  for (const ir::DriverRow& driver : ir::driver_rows()) driver_json(driver, json);
  json.end_array().end_object().end_object();
}

void units_json(JsonWriter& json) {
  json.key("units").begin_object().field("type", "object");
  json.field("description",
             "which POUs are one unit of an edit: a list of names, or PROGRAM.ACTION");
  json.key("additionalProperties").begin_object();
  text_list(json);
  json.field("minItems", 1).end_object().end_object();
}

}  // namespace

std::string project_schema() {
  JsonWriter json;
  json.begin_object().field("$schema", "https://json-schema.org/draft/2020-12/schema");
  json.field("title", "stc.toml, the settings of a project").field("type", "object");
  json.field("additionalProperties", false).key("properties").begin_object();
  keys_json("", json);
  std::string_view last;
  for (const ProjectKey& key : tools::project_keys()) {
    const std::string_view table = key.name.substr(0, key.name.find('.') + 1);
    if (table.empty() || table == last) continue;
    last = table;
    json.key(table.substr(0, table.size() - 1));
    begin_table(json);
    keys_json(table, json);
    if (table == tools::kWarningTable) levels_json(json);
    end_table(json);
  }
  units_json(json);
  devices_json(json);
  json.end_object().end_object();
  return json.finish();
}

}  // namespace stc
