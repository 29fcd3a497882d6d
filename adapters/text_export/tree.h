// The lines of a drawn body -> trees, as they stand there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace text_export {

// What a value goes to.
struct End {
  std::string_view name;  // empty: to nothing
  bool negated = false;
  bool set = false;  // with `negated`: reset
  uint32_t at = 0;   // in the text of the body
};

enum class Shape : uint8_t { kEmpty, kContact, kAnd, kOr, kOperand, kBox, kAssign };

struct Tree {
  Shape shape = Shape::kEmpty;
  bool negated = false;
  bool instance = false;  // of a box: a function block
  bool enabled = false;   // of a box: power arrives at EN
  uint32_t at = 0;
  std::string_view text;    // variable, operand, or the type of a box
  std::string_view owner;   // of function blocks: the instance
  std::vector<Tree> parts;  // what is wired into it
  std::vector<End> ends;
};

struct DrawnNetwork {
  uint32_t at = 0;
  std::string_view label;
  std::vector<std::string> comments;  // lines
  // Ladder: one tree, and what stands beside the coils while power arrives. Else: trees.
  bool ladder = false;
  std::vector<Tree> trees;
  std::vector<Tree> enabled;
};

struct Drawn {
  bool ladder = false;
  std::vector<DrawnNetwork> networks;
  // What cannot be read, and where; empty: all could.
  std::string problem;
  uint32_t problem_at = 0;
  uint32_t problem_network = 0;
};

Drawn read_trees(std::string_view body);

// A name in a declaration that is a word of the form: a variable called so cannot be told from
// that. Empty: none.
std::string_view word_of_form(std::string_view declaration);

}  // namespace text_export
