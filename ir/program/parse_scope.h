// What the parser of the text format knows by name once it has seen the first
// words of every line: types and POUs may be used before they are declared.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "ir/program/line_reader.h"

namespace ir {

class ParseScope {
 public:
  ParseScope();

  // Reads "%N [NAME]" or "NAME" after `type`; false when %N is not the next number.
  bool add_type(LineReader& line);
  void add_pou(std::string_view name);

  TypeId type(LineReader& line) const;             // NAME or %N; fails the line when unknown
  PouId pou(LineReader& line) const;               // NAME or #N
  std::string type_label(LineReader& line) const;  // the name of a declaration

 private:
  std::unordered_map<std::string, uint32_t> types_;
  std::unordered_map<std::string, uint32_t> pous_;
  uint32_t type_count_ = 0;
  uint32_t pou_count_ = 0;
};

// Appends the blocks of `pou`, whose declarations are complete. `lines` are the
// body's lines; on failure `line` is the one that is wrong and `reason` says why.
struct BodyLine {
  uint32_t line = 0;
  std::string_view text;
};
struct BodyError {
  uint32_t line = 0;
  std::string reason;
};
// `value_budget` bounds the values of all bodies together and is counted down.
BodyError parse_body(const Program& program, const ParseScope& scope,
                     const std::vector<BodyLine>& lines, uint64_t& value_budget, Pou& pou);

// One place of the text format.
Place parse_place(const Program& program, const ParseScope& scope, const Pou& pou,
                  LineReader& line);

}  // namespace ir
