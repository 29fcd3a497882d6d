// Which names the sources declare, for conditions such as `defined(pou: Pump)`.
// Found from the tokens alone, because the answer is needed before anything can be
// parsed; text that conditions leave out counts too. Built when first asked, so it costs
// nothing where nobody asks. The sources must outlive it.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/source.h"

namespace frontend {

enum class DeclaredKind : uint8_t { kVariable, kType, kPou, kTask, kResource };
// "variable", "type", "pou", ...
std::optional<DeclaredKind> declared_kind(std::string_view word);

struct Declared {
  std::string_view name;
  // kVariable: the first word of its type; kPou: the name behind EXTENDS, without what is in
  // front of its last dot.
  std::string_view type;
  std::vector<std::string_view> attributes;
  // Where a POU's variable is visible; globals are everywhere.
  uint32_t begin = 0;
  uint32_t end = 0xffffffffu;
};

class DeclarationIndex {
 public:
  explicit DeclarationIndex(const base::SourceMap& sources);
  ~DeclarationIndex();
  // What `name` means at a position, or null; a POU's own variables come first.
  const Declared* find(DeclaredKind kind, std::string_view name, uint32_t position) const;
  // What the POU of that name extends; empty when there are several and they differ in that.
  std::string_view base_of(std::string_view pou) const;

 private:
  struct Table;
  const Table& table() const;

  const base::SourceMap& sources_;
  mutable std::unique_ptr<Table> table_;
};

}  // namespace frontend
