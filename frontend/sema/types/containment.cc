// No type may contain itself by value, be it a structure or a function block. No type may be nested
// deeper than an image permits (verify_types.cc, linker/instances.cc).
#include <algorithm>
#include <utility>

#include "base/limits.h"
#include "frontend/sema/sema.h"
#include "frontend/sema/types/types.h"

namespace frontend {
namespace {

enum class Mark : uint8_t { kWhite, kGrey, kBlack };

// How deep what a type holds is nested, as the verifier counts.
struct Depth {
  uint32_t values = 0;     // structures and arrays inside each other
  uint32_t instances = 0;  // of function blocks: each counts as one more than its values
};

// Depth first, with a stack of its own: chains of types may be long.
class Containment : private Phase {
 public:
  explicit Containment(Sema& sema)
      : Phase(sema),
        types_(sema.program.types),
        marks_(types_.size(), Mark::kWhite),
        depths_(types_.size()) {}

  void check() {
    for (const PouInfo& pou : sema_.declared.pous) {
      if (pou.self.valid()) walk(pou.self);
    }
    for (uint32_t i = 0; i < types_.size(); ++i) {
      if (types_.has_members(ir::TypeId(i))) walk(ir::TypeId(i));
    }
  }

 private:
  struct Frame {
    ir::TypeId type;
    uint32_t next = 0;
  };

  void walk(ir::TypeId first) {
    if (marks_[first.index] != Mark::kWhite) return;
    std::vector<Frame> stack{{first}};
    marks_[first.index] = Mark::kGrey;
    while (!stack.empty()) {
      Frame& top = stack.back();
      const ir::Type& type = types_[top.type];
      if (top.next == type.members.size()) {
        marks_[top.type.index] = Mark::kBlack;
        limit_depth(top.type);
        stack.pop_back();
        continue;
      }
      const ir::Member& member = type.members[top.next++];
      if (!member.type.valid() || member.section == ir::Section::kInOut) continue;
      const ir::TypeId inner = element_of(member.type);
      if (!types_.has_members(inner) || marks_[inner.index] == Mark::kBlack) continue;
      if (marks_[inner.index] == Mark::kGrey) {
        report(DiagnosticCode::kRecursiveType, inner,
               "contains an instance of itself, in `" + sema_.report.type_text(top.type) + "." +
                   member.name + "`",
               "break the circle");
        continue;
      }
      marks_[inner.index] = Mark::kGrey;
      stack.push_back({inner});
    }
  }

  ir::TypeId element_of(ir::TypeId type) const {
    while (types_[type].kind == ir::Kind::kArray) type = types_[type].base;
    return type;
  }

  Depth depth_of(const ir::Member& member) const {
    if (!member.type.valid() || member.section == ir::Section::kInOut) return {};
    Depth depth;
    ir::TypeId type = member.type;
    for (; types_[type].kind == ir::Kind::kArray; type = types_[type].base) ++depth.values;
    if (!types_.has_members(type)) return depth;
    const bool instance = types_.is_instance(type);
    depth.values += instance ? 0 : depths_[type.index].values;
    depth.instances = depths_[type.index].instances;
    return depth;
  }

  // All parts are known. What is too deep loses its parts, so that nobody walks down there.
  void limit_depth(ir::TypeId type) {
    Depth deepest;
    for (const ir::Member& member : types_[type].members) {
      const Depth depth = depth_of(member);
      deepest.values = std::max(deepest.values, depth.values);
      deepest.instances = std::max(deepest.instances, depth.instances);
    }
    ++deepest.values;
    if (types_.is_instance(type)) deepest.instances += 1 + deepest.values;
    depths_[type.index] = deepest;
    if (std::max(deepest.values, deepest.instances) <= base::kMaxNesting) return;
    report(DiagnosticCode::kTooDeep, type,
           "nests structures, arrays and function blocks in more than " +
               std::to_string(base::kMaxNesting) + " levels",
           "declare what lies deep inside as variables of their own; a function block counts as "
           "two levels or more");
    depths_[type.index] = {};
    const ir::TypeId flat = sema_.program.types.elementary(ir::Kind::kInt);
    for (ir::Member& member : sema_.program.types.edit(type).members) {
      if (member.type.valid()) member.type = flat;
    }
  }

  // The first that is too deep: the others are of the same chain, or wait for the next time.
  void report(DiagnosticCode code, ir::TypeId type, const std::string& what, const char* help) {
    if (code == DiagnosticCode::kTooDeep && std::exchange(told_depth_, true)) return;
    const PouInfo* owner = sema_.declared.pou_of(type);
    base::SourceSpan span = owner != nullptr ? owner->decl->name.span : base::SourceSpan{};
    for (const TypeDecl& decl : sema_.tree.types) {
      if (ir::same_name(decl.name.text, types_[type].name)) span = decl.name.span;
    }
    error(code, span, "`" + sema_.report.type_text(type) + "` " + what, help);
  }

  const ir::TypeTable& types_;
  std::vector<Mark> marks_;
  std::vector<Depth> depths_;
  bool told_depth_ = false;
};

}  // namespace

void Types::check_containment() { Containment(sema_).check(); }

}  // namespace frontend
