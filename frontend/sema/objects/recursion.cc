// Circles of calls. Each needs a POU that declares how deep it goes, so that the stack can be
// sized for it: {attribute 'recursion_depth' := '20'}.
#include <charconv>

#include "base/limits.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {
namespace {

constexpr std::string_view kRecursionDepth = "recursion_depth";

struct Frame {
  uint32_t pou;
  size_t next = 0;
};

}  // namespace

uint32_t Objects::recursion_depth(const PouDecl& decl) {
  const Attribute* attribute = sema_.tree.find_attribute(decl.attributes, kRecursionDepth);
  if (attribute == nullptr) return 0;
  uint32_t depth = 0;
  const char* end = attribute->value.data() + attribute->value.size();
  auto [at, problem] = std::from_chars(attribute->value.data(), end, depth);
  if (problem == std::errc() && at == end && depth >= 1 && depth <= base::kMaxCallDepth) {
    return depth;
  }
  error(DiagnosticCode::kRecursiveCall, attribute->name.span,
        "`" + std::string(attribute->value) + "` is no depth of calls",
        "write a number from 1 to " + std::to_string(base::kMaxCallDepth));
  return 1;
}

void Objects::report_circle(const std::vector<uint32_t>& path) {
  auto name = [this](uint32_t pou) {
    return "`" + sema_.program.pous[sema_.declared.pous[pou].id.index].name + "`";
  };
  std::string through;
  for (size_t i = 1; i < path.size(); ++i) through += (i == 1 ? "" : ", ") + name(path[i]);
  error(DiagnosticCode::kRecursiveCall, sema_.declared.pous[path[0]].decl->name.span,
        name(path[0]) + " calls itself" + (through.empty() ? "" : " through " + through),
        "use a loop, or declare how deep it goes: {attribute 'recursion_depth' := '20'}");
}

// Depth first through what declares no depth, with a stack of its own: chains may be long.
void Objects::check_recursion() {
  if (sema_.report.has_errors()) return;  // a circle may be one of the mistakes
  enum class Mark : uint8_t { kNew, kOpen, kDone };
  std::vector<Mark> marks(sema_.declared.pous.size(), Mark::kNew);
  for (uint32_t start = 0; start < sema_.declared.pous.size(); ++start) {
    if (marks[start] != Mark::kNew) continue;
    std::vector<Frame> stack{{start}};
    marks[start] = Mark::kOpen;
    while (!stack.empty()) {
      Frame& top = stack.back();
      const PouInfo& info = sema_.declared.pous[top.pou];
      const bool declared =
          info.id.valid() && sema_.program.pous[info.id.index].recursion_depth != 0;
      if (declared || top.next == info.callees.size()) {
        marks[top.pou] = Mark::kDone;
        stack.pop_back();
        continue;
      }
      const uint32_t callee = info.callees[top.next++];
      if (marks[callee] == Mark::kNew) {
        marks[callee] = Mark::kOpen;
        stack.push_back({callee});
      } else if (marks[callee] == Mark::kOpen) {
        std::vector<uint32_t> path;
        for (size_t i = stack.size(); i-- > 0;) {
          path.insert(path.begin(), stack[i].pou);
          if (stack[i].pou == callee) break;
        }
        report_circle(path);
        marks[callee] = Mark::kDone;  // once
      }
    }
  }
}

}  // namespace frontend
