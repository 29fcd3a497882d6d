// Graphical bodies as data: ladder (LD) and function block diagram (FBD), IEC 61131-3,
// 8.2 and 8.3. One model for both: networks of elements whose inputs are linked to outputs
// of other elements. It is filled by the text forms (ladder/read.h, fbd/read.h) and by XML
// (adapters/plcopen); statements are made of it (parse/diagram.h), text, pictures and XML.
//
// The model owns its text and refers to nothing: operands are expressions of Structured Text
// as written, with the place where they stand in a SourceMap (invalid when they stand in none).
// Whatever a reader finds is well-formed here: links name existing elements and outputs,
// `elements` are in the order of execution (network/order.h), so a link to an element at or
// after the own one is feedback: it carries the value of the last evaluation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/source.h"

namespace frontend::network {

struct Text {
  std::string text;
  base::SourceSpan span;
  bool empty() const { return text.empty(); }
};

enum class Kind : uint8_t {
  kLeftRail,   // no input; one output: power
  kRightRail,  // inputs only; does nothing
  kContact,    // operand: BOOL expression; input 0 -> output 0
  kCoil,       // operand: variable; input 0 -> output 0, which passes power on
  kSource,     // operand: expression (inVariable); output 0; inputs: wires in it (expressions.h)
  kSink,       // operand: variable (outVariable); input 0; S and R as coils have them
  kBlock,      // type; operand: instance, empty for functions; inputs and outputs by name
  kJump,       // operand: label; input 0
  kReturn,     // input 0
};

enum class Modifier : uint8_t {
  kNone,
  kNegated,  // [/ a]  (/ a)
  kRising,   // [P a]  (P a)
  kFalling,  // [N a]  (N a)
  kSet,      // (S a)  coils and sinks
  kReset,    // (R a)
};

struct Link {
  uint32_t element = 0;  // in Network::elements
  uint32_t output = 0;   // in its outputs
  friend bool operator==(Link, Link) = default;
};

struct Input {
  std::string name;                     // formal parameter; empty: by position, or the only input
  std::vector<Link> from;               // none: not connected; several: their OR
  Modifier modifier = Modifier::kNone;  // kNegated, kRising, kFalling
  bool by_itself = false;               // ladder as text does not name it: power gets there
  base::SourceSpan span;
};

// The outputs of a box. In a function the first output that is not ENO is its result, whatever its
// name.
struct Output {
  std::string name;  // formal parameter; empty: the result, or the only output
  bool negated = false;
};

struct Position {  // of the upper left corner, in units of the drawing
  int32_t x = 0;
  int32_t y = 0;
  int32_t width = 0;
  int32_t height = 0;
  bool known = false;
};

struct Element {
  Kind kind = Kind::kContact;
  Modifier modifier = Modifier::kNone;
  Text operand;
  Text type;  // of blocks; A.B.Name where it stands in a namespace
  Text wire;  // of functions' blocks: what FBD as text calls the result; may be empty
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<std::string> comments;
  Position position;
  uint64_t id = 0;     // localId of XML; 0: none
  uint32_t order = 0;  // executionOrderId of XML; 0: none
  base::SourceSpan span;
};

inline bool is_rail(const Element& element) {
  return element.kind == Kind::kLeftRail || element.kind == Kind::kRightRail;
}

// A rung, or what is drawn together.
struct Network {
  Text label;                         // a jump may name it; empty: none
  std::string title;                  // one line
  bool disabled = false;              // kept, but not executed: only its label counts
  bool headed = false;                // FBD: it begins at a row {network ...} (network/head.h)
  std::vector<std::string> comments;  // in front of it, without comment marks; a line may be long
  std::vector<Element> elements;
  base::SourceSpan span;
};

enum class Language : uint8_t { kLadder, kFbd };

struct Body {
  Language language = Language::kLadder;
  std::vector<Network> networks;  // in the order of execution
  base::SourceSpan span;
};

}  // namespace frontend::network
