// What differs between the units of two versions of a program, in words (X9): variable by variable,
// line by line, rung by rung, box by box, step by step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/stc/units.h"

namespace stc {

enum class Differs : uint8_t {
  kNew,
  kRemoved,
  kEdited,
  kOrder,     // the same ones, in another order
  kComments,  // in nothing but comments
  kLayout,    // in nothing but blanks, line ends and the case of names
};
const char* differs_name(Differs how);

struct DifferingLine {
  char sign = ' ';  // '-' of the first version, '+' of the second, ' ' of both
  std::string text;
};
struct PartDifference {
  std::string kind;  // as of UnitPart; "lines", "rung", "block", "output", "jump", "return", "body"
  std::string name;
  Differs how = Differs::kEdited;
  std::string before = {};
  std::string after = {};
  std::string what = {};  // of a box: its pins that differ
  std::vector<DifferingLine> lines = {};  // of lines and rungs
};
struct UnitDifference {
  std::string kind;
  std::string name;
  std::string file;
  uint32_t line = 0;
  Differs how = Differs::kEdited;
  std::vector<PartDifference> parts = {};
};

// In the order of the second version; those that it lacks are last.
std::vector<UnitDifference> differences(const std::vector<Unit>& before,
                                        const std::vector<Unit>& after);

// Compares parts that have a name; body_difference.cc compares bodies.
void compare_parts(const std::vector<UnitPart>& before, const std::vector<UnitPart>& after,
                   std::vector<PartDifference>& out);
void compare_bodies(const std::vector<UnitBody>& before, const std::vector<UnitBody>& after,
                    std::vector<PartDifference>& out);

}  // namespace stc
