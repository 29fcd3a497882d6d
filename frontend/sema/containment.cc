// No type may contain itself by value: neither structures nor instances of blocks.
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

enum class Mark : uint8_t { kWhite, kGrey, kBlack };

struct Frame {
  ir::TypeId type;
  uint32_t next = 0;
};

ir::TypeId element_of(const ir::TypeTable& types, ir::TypeId type) {
  while (types[type].kind == ir::Kind::kArray) type = types[type].base;
  return type;
}

}  // namespace

// Depth first, with a stack of its own: chains of types may be long.
void Sema::check_containment() {
  const ir::TypeTable& types = program.types;
  std::vector<Mark> marks(types.size(), Mark::kWhite);
  for (const PouInfo& pou : pous) {
    if (!pou.self.valid() || marks[pou.self.index] != Mark::kWhite) continue;
    std::vector<Frame> stack{{pou.self}};
    marks[pou.self.index] = Mark::kGrey;
    while (!stack.empty()) {
      Frame& top = stack.back();
      const ir::Type& type = types[top.type];
      if (top.next == type.members.size()) {
        marks[top.type.index] = Mark::kBlack;
        stack.pop_back();
        continue;
      }
      const ir::Member& member = type.members[top.next++];
      if (!member.type.valid() || member.section == ir::Section::kInOut) continue;
      ir::TypeId inner = element_of(types, member.type);
      if (!types.has_members(inner) || marks[inner.index] == Mark::kBlack) continue;
      if (marks[inner.index] == Mark::kGrey) {
        const PouInfo* owner = pou_of(inner);
        error(DiagnosticCode::kRecursiveType,
              owner != nullptr ? owner->decl->name.span : base::SourceSpan{},
              "`" + type_text(inner) + "` contains an instance of itself, in `" +
                  type_text(top.type) + "." + member.name + "`");
        continue;
      }
      marks[inner.index] = Mark::kGrey;
      stack.push_back({inner});
    }
  }
}

}  // namespace frontend
