// Variables of an image by path, and their values as text. Path grammar:
// name { "." member | "[" index { "," index } "]" }; names without case; the first
// name is a program instance or a global variable. Used by get/set/force/watch,
// `--print`, golden tests and the planner.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"

namespace ir {

struct Symbol {
  uint32_t data = 0;  // offset in data memory
  TypeId type;        // may be an aggregate; for an instance: data is its area
  bool constant = false;
  bool input = false;  // %I
  bool output = false;
  bool retain = false;
  // Not 0: a BOOL at that bit of the BYTE which is there (ir/types/shared_bytes.h).
  uint8_t bit_mask = 0;
};

inline bool same_place(const Symbol& a, const Symbol& b) {
  return a.data == b.data && a.bit_mask == b.bit_mask;
}

// "BOOL" of a bit.
std::string type_text(const Image& image, const Symbol& symbol);

base::Result<Symbol> find_symbol(const Image& image, std::string_view path);
class NameIndex;  // name_index.h
base::Result<Symbol> find_symbol(const NameIndex& names, std::string_view path);

// The path by which a variable is found, from its place and type; an access path names it as well.
std::string path_of(const Image& image, const Symbol& symbol);

// Every leaf (scalars and strings) in declaration order: globals, then programs;
// instances where their slot is declared. In-out slots are skipped.
void for_each_leaf(const Image& image,
                   const std::function<void(const std::string& path, const Symbol&)>& visit);

// Value of `symbol` as an IEC literal ("TRUE", "-5", "16#00FF", "2.5", "T#1s500ms",
// "'ab$'c'", "Color#Red" is printed "Red", a reference as the path of its target, "NULL" or "ref");
// aggregates as "(a := 1, b := 2)" and
// "[1, 2, 3]". `memory` is the whole data memory, indexed by offset.
std::string format_value(const Image& image, const Symbol& symbol, std::span<const uint8_t> memory);
// Bytes of a scalar or string from a literal as people type it.
base::Result<base::Bytes> parse_value(const Image& image, TypeId type, std::string_view text);
// The value of a bit is its byte, in which the other bits are 0.
base::Result<base::Bytes> parse_value(const Image& image, const Symbol& symbol,
                                      std::string_view text);

// "path=value\n" for every leaf.
std::string state_text(const Image& image, std::span<const uint8_t> memory);
// SHA-256 over paths and value bytes of all leaves: independent of where things lie.
base::Digest state_hash(const Image& image, std::span<const uint8_t> memory);

}  // namespace ir
