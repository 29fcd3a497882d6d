// Files of simulated inputs (vm/io/csv_inputs.h): refused with file and line, or every time of them
// is played, and each of its columns has a value.
#include <string>

#include "base/check.h"
#include "vm/io/csv_inputs.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  base::Result<vm::CsvInputs> csv = vm::CsvInputs::parse("fuzz.csv", text);
  if (!csv.ok()) {
    base::check(csv.error().text.find("fuzz.csv:") != std::string::npos,
                "the place of the mistake");
    return 0;
  }
  for (const int64_t now : {int64_t{0}, int64_t{1'000'000}, int64_t{1'000'000'000}, INT64_MAX}) {
    csv->advance(now);
    for (size_t i = 0; i < csv->columns().size(); ++i) {
      const uint32_t bits = csv->columns()[i].bit_size;
      base::check(bits >= 64 || csv->value(i) >> bits == 0, "a value fits its column");
    }
  }
  return 0;
}
