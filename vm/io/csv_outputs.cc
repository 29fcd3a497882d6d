#include "vm/io/csv_outputs.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ir/types/address_text.h"
#include "ir/types/time_units.h"
#include "vm/io/bit_copy.h"

namespace vm {
namespace {


uint64_t value_at(base::ByteSpan bytes, uint32_t bit, uint32_t bits) {
  uint8_t value[8] = {};
  copy_bits(bytes, bit, value, 0, bits);
  uint64_t out = 0;
  for (int i = 7; i >= 0; --i) out = out << 8 | value[i];
  return out;
}

}  // namespace

base::Result<std::unique_ptr<CsvOutputs>> CsvOutputs::open(const std::string& file) {
  std::FILE* opened = std::fopen(file.c_str(), "we");
  if (opened == nullptr) {
    return base::Error{base::Refusal::kDeviceFailed, file + ": " + std::strerror(errno)};
  }
  return std::make_unique<CsvOutputs>(file, opened);
}

bool CsvOutputs::store(const ir::DirectAddress& at, uint64_t value) {
  for (Column& column : columns_) {
    if (!(column.at == at)) continue;
    const bool changed = column.value != value;
    column.value = value;
    return changed;
  }
  columns_.push_back({at, value});
  grown_ = true;
  return true;
}

void CsvOutputs::header() {
  std::string line = "time_ms";
  for (const Column& column : columns_) line += "," + ir::address_text(column.at);
  std::fprintf(file_.get(), "%s\n", line.c_str());
  grown_ = false;
}

void CsvOutputs::row(int64_t now_ns) {
  std::string line = std::to_string(now_ns / ir::kNsPerMillisecond);
  if (const int64_t part = now_ns % ir::kNsPerMillisecond; part != 0) {
    std::string digits = std::to_string(part);
    digits.insert(0, 6 - digits.size(), '0');
    while (digits.back() == '0') digits.pop_back();
    line += "." + digits;
  }
  for (const Column& column : columns_) {
    line += "," + (column.at.bit_size == 1 ? (column.value != 0 ? std::string("TRUE") : "FALSE")
                                           : std::to_string(column.value));
  }
  std::fprintf(file_.get(), "%s\n", line.c_str());
}

base::Status CsvOutputs::write(const DevicePoints& points, base::ByteSpan outputs, int64_t now_ns) {
  bool changed = false;
  for (const PointRange& range : points.outputs) {
    const uint32_t size = range.at.bit_size;
    for (uint32_t bit = 0; bit < range.bits(); bit += size) {
      const ir::DirectAddress at{range.at.area, range.at.bit_offset + bit, size};
      changed |= store(at, value_at(outputs, range.byte * 8 + bit, size));
    }
  }
  if (grown_) header();
  if (changed) row(now_ns);
  if (!changed || std::fflush(file_.get()) == 0) return base::Ok{};
  return exchange_failed(name_ + ": " + std::strerror(errno));
}

}  // namespace vm
