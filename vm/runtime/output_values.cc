#include "vm/runtime/output_values.h"

#include <cmath>
#include <cstring>

namespace vm {

// NaN is sent to no device: a drive would take it for some number.
base::Status fits_output(const ir::Image& image, const ir::Symbol& symbol,
                         const base::Bytes& bytes) {
  if (!symbol.output || !image.types.is_scalar(symbol.type)) return base::Ok{};
  const ir::Scalar scalar = image.types.scalar(symbol.type);
  if (!ir::is_float(scalar)) return base::Ok{};
  float single = 0;
  double number = 0;
  if (bytes.size() == sizeof single) {
    std::memcpy(&single, bytes.data(), sizeof single);
    number = single;
  } else {
    std::memcpy(&number, bytes.data(), sizeof number);
  }
  if (!std::isnan(number)) return base::Ok{};
  return base::Error{base::Refusal::kBadValue, "an output cannot be NaN"};
}

}  // namespace vm
