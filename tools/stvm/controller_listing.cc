// The variables of the running program, page by page.
#include "base/check.h"
#include "ir/bytecode/leaf_walk.h"
#include "tools/common/pattern.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

// Leaves that one page looks at, of which few may match: others ask between two pages.
constexpr uint64_t kLeavesPerPage = 100'000;

}  // namespace

base::Result<base::Bytes> ControllerService::list(const vm::Request& request) {
  if (request.names.size() > 1) {
    return base::Error{base::Refusal::kProtocol, "a list takes one pattern"};
  }
  std::string pattern = request.names.empty() ? "*" : request.names.front();
  const ir::Image& image = controller_.image();
  vm::Values values;
  uint64_t at = request.offset;
  uint64_t bytes = 0;
  ir::for_each_leaf_from(image, at, [&](const std::string& path, const ir::Symbol& symbol) {
    if (bytes > vm::kChunkBytes || at - request.offset == kLeavesPerPage) {
      values.next = at;
      return false;
    }
    ++at;
    if (!tools::matches(pattern, path)) return true;
    values.rows.push_back({path, ir::type_text(image, symbol), {}});
    bytes += path.size() + values.rows.back().type.size() + 12;
    return true;
  });
  return vm::encode(values);
}

}  // namespace stvm
