// The variables of the running program, page by page.
#include "base/check.h"
#include "tools/common/pattern.h"
#include "tools/stvm/controller_service.h"

namespace stvm {

base::Result<base::Bytes> ControllerService::list(const vm::Request& request) {
  if (request.names.size() > 1) {
    return base::Error{base::Refusal::kProtocol, "a list takes one pattern"};
  }
  std::string pattern = request.names.empty() ? "*" : request.names.front();
  const ir::Image& image = controller_.image();
  vm::Values values;
  uint64_t at = 0;
  uint64_t bytes = 0;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    uint64_t index = at++;
    if (index < request.offset || values.next != 0 || !tools::matches(pattern, path)) return;
    if (bytes > vm::kChunkBytes) {
      values.next = index;
      return;
    }
    values.rows.push_back({path, image.types.text(symbol.type), {}});
    bytes += path.size() + values.rows.back().type.size() + 12;
  });
  return vm::encode(values);
}

}  // namespace stvm
