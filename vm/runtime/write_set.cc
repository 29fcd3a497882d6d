#include "vm/runtime/write_set.h"

#include "vm/exec/store_aside.h"
#include "vm/runtime/live_copy.h"
#include "vm/runtime/output_values.h"
#include "vm/runtime/task_tables.h"

namespace vm {
namespace {

base::Error read_only(std::string_view path, const char* what) {
  return {base::Refusal::kReadOnly, "`" + std::string(path) + "` is " + what};
}

}  // namespace

void WriteSet::Value::put(uint8_t* memory) const {
  put_value(memory + data, bytes.data(), bytes.size(), mask);
}

base::Result<ir::Symbol> writable(const ir::VerifiedImage& version, std::string_view path) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(version.names(), path);
  if (symbol.ok() && symbol->constant) return read_only(path, "a constant");
  return symbol;
}

base::Result<base::Bytes> parsed(const ir::Image& image, const ir::Symbol& symbol,
                                 const NamedValue& row) {
  base::Result<base::Bytes> bytes = ir::parse_value(image, symbol, row.value);
  base::Status fits = base::Ok{};
  if (bytes.ok()) fits = fits_output(image, symbol, *bytes);
  if (bytes.ok() && fits.ok()) return bytes;
  const base::Error& why = bytes.ok() ? fits.error() : bytes.error();
  return base::Error{why.refusal, row.path + ": " + why.text};
}

base::Result<WriteSet> WriteSet::make(const TaskTables& tables,
                                      std::span<const NamedValue> values) {
  WriteSet set;
  set.generation = tables.generation->number();
  const ir::Image& image = tables.version.image();
  base::Bytes outputs(tables.outputs.size());
  std::vector<ir::DataRange> ranges;
  for (const NamedValue& row : values) {
    base::Result<ir::Symbol> symbol = writable(tables.version, row.path);
    if (!symbol.ok()) return symbol.error();
    if (symbol->input) return read_only(row.path, "an input; force it instead");
    base::Result<base::Bytes> bytes = parsed(image, *symbol, row);
    if (!bytes.ok()) return bytes.error();
    const auto size = static_cast<uint32_t>(bytes->size());
    ranges.push_back({symbol->data, size});
    if (symbol->output) {
      tables.process_image.mark_outputs(symbol->data, symbol->data + size, outputs);
    }
    set.values.push_back({symbol->data, std::move(*bytes), symbol->bit_mask});
  }
  for (uint32_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i] != 0) set.outputs.push_back({i, outputs[i]});
  }
  set.work_bytes = line_bytes(ranges) + set.outputs.size() * tables.tasks.size();
  if (set.work_bytes <= kMaxBoundaryBytes) return set;
  return base::Error{base::Refusal::kTooMany,
                     "at one boundary " + std::to_string(kMaxBoundaryBytes) +
                         " bytes are written, and these values touch " +
                         std::to_string(set.work_bytes) + "; set fewer at once"};
}

}  // namespace vm
