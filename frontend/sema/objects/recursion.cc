// Circles of calls. Each needs a POU that declares how deep it goes, so that the stack can be
// sized for it: {attribute 'recursion_depth' := '20'}. A method that calls one of another instance
// (`next.Handle()`, by an interface, a pointer or a reference) may be in a circle and never run
// inside itself, as decorators, chains and trees are: it has kUsualDepth where it declares none.
#include <algorithm>
#include <charconv>
#include <unordered_set>
#include <utility>

#include "base/limits.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {
namespace {

constexpr std::string_view kRecursionDepth = "recursion_depth";

// Few circles may be that deep together: the number of calls inside each other is limited.
constexpr uint32_t kUsualDepth = 16;
constexpr uint32_t kLeastDepth = 4;
constexpr uint32_t kUsualActivations = 64;

struct Visit {
  uint32_t pou;
  size_t next = 0;
};

}  // namespace

std::vector<ir::PouId> called_for_others(const ir::Pou& code) {
  std::unordered_set<uint32_t> own;
  std::vector<ir::PouId> out;
  for (const ir::Block& block : code.blocks) {
    for (const ir::Inst& inst : block.insts) {
      if (inst.op == ir::Op::kThis) own.insert(inst.result.index);
      const bool call = inst.op == ir::Op::kCallVirtual || inst.op == ir::Op::kCallMethod;
      if (!call || inst.operands.empty() || own.contains(inst.operands[0].index)) continue;
      out.push_back(inst.pou);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

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

// A POU of the circle whose next call in it is one of another instance; kNoPou: none.
uint32_t Objects::other_instance_in(const std::vector<uint32_t>& circle) const {
  for (size_t i = 0; i < circle.size(); ++i) {
    const PouInfo& caller = sema_.declared.pous[circle[i]];
    const uint32_t next = circle[(i + 1) % circle.size()];
    if (!caller.id.valid()) continue;
    const std::vector<ir::PouId> for_others =
        called_for_others(sema_.program.pous[caller.id.index]);
    for (const uint32_t callee : caller.callees) {
      const PouInfo& method = sema_.declared.pous[callee];
      const std::vector<uint32_t>& others = method.overrides;
      const bool meant =
          callee == next || std::find(others.begin(), others.end(), next) != others.end();
      if (meant && std::binary_search(for_others.begin(), for_others.end(), method.id))
        return circle[i];
    }
  }
  return kNoPou;
}

// All of them share what is usual.
void Objects::give_usual_depth(const std::vector<uint32_t>& pous) {
  const auto count = static_cast<uint32_t>(pous.size());
  for (const uint32_t pou : pous) {
    PouInfo& info = sema_.declared.pous[pou];
    info.usual_depth = std::clamp(kUsualActivations / count, kLeastDepth, kUsualDepth);
    sema_.program.pous[info.id.index].recursion_depth = info.usual_depth;
  }
}

// Depth first through what declares no depth, with a stack of its own: chains may be long.
std::vector<uint32_t> Objects::find_circle(std::vector<uint8_t>& marks, uint32_t& start) const {
  enum Mark : uint8_t { kNew, kOpen, kDone };
  for (; start < sema_.declared.pous.size(); ++start) {
    if (marks[start] != kNew) continue;
    std::vector<Visit> stack{{start}};
    marks[start] = kOpen;
    while (!stack.empty()) {
      Visit& top = stack.back();
      const PouInfo& info = sema_.declared.pous[top.pou];
      const bool declared =
          info.id.valid() && sema_.program.pous[info.id.index].recursion_depth != 0;
      if (declared || top.next == info.callees.size()) {
        marks[top.pou] = kDone;
        stack.pop_back();
        continue;
      }
      const uint32_t callee = info.callees[top.next++];
      if (marks[callee] == kNew) {
        marks[callee] = kOpen;
        stack.push_back({callee});
      } else if (marks[callee] == kOpen) {
        std::vector<uint32_t> path;
        for (size_t i = stack.size(); i-- > 0;) {
          path.insert(path.begin(), stack[i].pou);
          if (stack[i].pou == callee) break;
        }
        for (const Visit& frame : stack) marks[frame.pou] = kNew;  // to be looked at again
        return path;
      }
    }
  }
  return {};
}

void Objects::check_recursion() {
  if (sema_.report.has_errors()) return;  // a circle may be one of the mistakes
  std::vector<uint32_t> usual;
  for (PouInfo& info : sema_.declared.pous) {
    if (std::exchange(info.usual_depth, 0) != 0)
      sema_.program.pous[info.id.index].recursion_depth = 0;
  }
  std::vector<uint8_t> marks(sema_.declared.pous.size(), 0);
  uint32_t start = 0;
  for (;;) {
    const std::vector<uint32_t> circle = find_circle(marks, start);
    if (circle.empty()) break;
    const uint32_t pou = other_instance_in(circle);
    if (pou == kNoPou) {
      report_circle(circle);
      marks[circle[0]] = 2;  // once
      continue;
    }
    usual.push_back(pou);
    sema_.program.pous[sema_.declared.pous[pou].id.index].recursion_depth = kUsualDepth;
  }
  give_usual_depth(usual);
}

}  // namespace frontend
