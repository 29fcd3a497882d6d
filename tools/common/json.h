// A JSON writer for `--format json`: the caller opens and closes, the writer puts
// commas and escapes. Output only; nothing in the core reads JSON.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tools {

class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }
  JsonWriter& key(std::string_view name);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(bool v) { return raw(v ? "true" : "false"); }
  JsonWriter& value(int64_t v) { return raw(std::to_string(v)); }
  JsonWriter& value(uint64_t v) { return raw(std::to_string(v)); }
  JsonWriter& value(uint32_t v) { return raw(std::to_string(v)); }
  JsonWriter& value(int v) { return raw(std::to_string(v)); }
  JsonWriter& value(double v);
  JsonWriter& null() { return raw("null"); }
  JsonWriter& number(std::string_view digits) { return raw(digits); }  // as JSON has it
  template <class T>
  JsonWriter& field(std::string_view name, const T& v) {
    return key(name).value(v);
  }
  // The text so far; a newline is added.
  std::string finish() { return out_ + "\n"; }

 private:
  JsonWriter& open(char c);
  JsonWriter& close(char c);
  JsonWriter& raw(std::string_view text);
  void comma();
  std::string out_;
  bool need_comma_ = false;
};

}  // namespace tools
