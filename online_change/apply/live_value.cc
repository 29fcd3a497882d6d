#include "online_change/apply/live_value.h"

#include <cstring>

#include "online_change/diff/stored_value.h"

namespace online_change {
void know(UpdateStep& step, uint32_t index, std::span<const uint8_t> made, const uint8_t* value) {
  const size_t row = 1 + made.size() + step.size;
  base::Bytes& known = step.as<ConvertedValues>()->known;
  known.resize(row * step.count);
  uint8_t* const out = known.data() + index * row;
  *out = 1;
  std::memcpy(out + 1, made.data(), made.size());
  std::memcpy(out + 1 + made.size(), value, step.size);
}

const char* Conversions::convert(const ConvertedValues& how, uint32_t index, const uint8_t* source,
                                 uint32_t to, std::span<uint8_t> out) const {
  if (!how.known.empty()) {
    const size_t made = source_size(how);
    const uint8_t* const known = how.known.data() + index * (1 + made + out.size());
    if (*known != 0 && std::memcmp(known + 1, source, made) == 0) {
      std::memcpy(out.data(), known + 1 + made, out.size());
      return nullptr;
    }
  }
  const Converted value = convert_stored(from_, how.old_type, source, to_, how.new_type, out);
  if (value.initialise) to_initial_.read(to, out);
  return value.loss;
}

bool Conversions::left_by_inverse(const ConvertedValues& how) {
  const auto [row, is_new] = left_.try_emplace({how.old_type, how.new_type});
  if (is_new) {
    row->second = classify(to_.types, how.new_type, from_.types, how.old_type) == Conversion::kSame;
  }
  return row->second;
}

std::string Conversions::old_text(const ConvertedValues& how, const uint8_t* value) const {
  return stored_text(from_, how.old_type, value);
}

std::string Conversions::new_text(const ConvertedValues& how, const uint8_t* value) const {
  return stored_text(to_, how.new_type, value);
}

}  // namespace online_change
