// How the printer spells references: by name where the name tells them apart,
// by number where it does not. A NameTable is built once per print().
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "ir/program/ir.h"

namespace ir {

// Which of a list of names are unique (without case) and not empty.
class UniqueNames {
 public:
  void add(std::string_view name) { ++count_[fold_name(name)]; }
  bool unique(std::string_view name) const;

 private:
  std::unordered_map<std::string, uint32_t> count_;
};

class PrintNames {
 public:
  explicit PrintNames(const Program& program);

  std::string type(TypeId id) const;
  std::string pou(PouId id) const;
  // Spelled after a dot.
  std::string member(TypeId type, uint32_t index) const;
  std::string local(const Pou& pou, uint32_t index) const;
  bool is_unique_type(TypeId id) const;

 private:
  const Program& program_;
  UniqueNames types_;
  UniqueNames pous_;
};

std::string print_place(const Program& program, const PrintNames& names, const Pou& pou,
                        PlaceId place);

}  // namespace ir
