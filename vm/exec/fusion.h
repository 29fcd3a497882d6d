// Fused handlers: several instructions in a row, taken in one dispatch. fusions.def lists them
// (docs/adr/0023-fused-handlers.md). All units stay where they are: only the op field of the first
// names the fused handler, and each other unit has a handler of its own for whoever jumps to it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ir/bytecode/code.h"
#include "vm/exec/handler_numbers.h"

namespace vm {

// Where a step of a fused handler has its operands: in memory relative to a base, or at hand as
// the result of an earlier step, which was at that place.
namespace operand {
inline constexpr uint8_t f = 0, s = 1, g = 2, c = 3;
inline constexpr uint8_t v0 = 4, v1 = 5, v2 = 6, v3 = 7, v4 = 8, v5 = 9, v6 = 10;
}  // namespace operand

template <ir::Opcode op, uint8_t A = operand::f, uint8_t B = operand::f, uint8_t C = operand::f>
struct Step {
  static constexpr ir::Opcode kOp = op;
  static constexpr uint8_t kA = A;
  static constexpr uint8_t kB = B;
  static constexpr uint8_t kC = C;
};

// The words of fusions.def, for who reads its rows.
namespace fusion_rows {
using operand::c, operand::f, operand::g, operand::s;
using operand::v0, operand::v1, operand::v2, operand::v3, operand::v4, operand::v5, operand::v6;
using O = ir::Opcode;
template <O op, uint8_t A = f, uint8_t B = f, uint8_t C = f>
using S = Step<op, A, B, C>;
}  // namespace fusion_rows

inline constexpr size_t kMaxSteps = 8;

// The bases of what the steps S write, also of those that update the result of an earlier one.
template <class... S>
constexpr std::array<uint8_t, sizeof...(S)> written_bases() {
  std::array<uint8_t, sizeof...(S)> out = {S::kA...};
  for (uint8_t& base : out) {
    if (base >= operand::v0) base = out[base - operand::v0];
  }
  return out;
}

// A step as a number: its handler in bits 0 to 15, after that for a, b and c four bits each: 0,
// or 1 and more for the result of step 0 and so on.
using StepKey = uint32_t;

struct Fusion {
  std::array<StepKey, kMaxSteps> keys{};
  uint8_t length = 0;
  uint16_t handler = 0;
};
// The rows of fusions.def, by their keys.
std::span<const Fusion> fusions();

// What is known of an opcode as a step.
struct StepFacts {
  bool is_step = false;
  bool stores = false;  // elsewhere than in its operand a
};
extern const std::array<StepFacts, ir::kOpcodeCount> kStepFacts;

// The code of a POU as steps.
class StepLine {
 public:
  struct Place {
    uint8_t base = 0;
    uint8_t size = 0;  // 0: none
    uint16_t offset = 0;
  };
  struct Unit {
    uint16_t handler = 0;
    uint8_t units = 1;
    bool is_step = false;  // can be part of a fusion
    bool stores = false;
    bool ends = false;   // what comes next is known at run time only
    bool jumps = false;  // always, to `next`
    bool may_jump = false;
    uint32_t next = 0;  // unit of the next step; may be the end of the code
    uint32_t target = 0;
    Place a, b, c;  // as read
    Place written;
  };
  explicit StepLine(std::span<const ir::Unit> code);
  // Units that others take care of: no part of a fusion.
  void leave_out(uint32_t first, uint32_t units);
  uint32_t size() const { return static_cast<uint32_t>(units_.size()); }
  // Not of extensions.
  const Unit& operator[](uint32_t unit) const { return units_[unit]; }
  bool is_extension(uint32_t unit) const { return units_[unit].units == 0; }

 private:
  std::vector<Unit> units_;
};

// Steps that can be fused, from a unit on.
class StepWalk {
 public:
  StepWalk(const StepLine& line, uint32_t unit) : line_(line), next_(unit) {}
  // The next one's key; false: there is none.
  bool take(StepKey& key);
  // Takes the handler of the next step alone, which is found at once; false: as take().
  bool next_handler(uint32_t& handler) const {
    if (is_over_ || length_ == kMaxSteps || next_ >= line_.size()) return false;
    if (!line_[next_].is_step) return false;
    handler = line_[next_].handler;
    return true;
  }
  uint32_t length() const { return length_; }
  uint32_t unit(uint32_t step) const { return taken_[step]; }
  uint32_t next() const { return next_; }                // unit after
  bool goes_back() const { return goes_back_; }          // a step was a LOOP
  uint32_t behind_back() const { return behind_back_; }  // steps after it

 private:
  uint32_t source(const StepLine::Place& place) const;
  const StepLine& line_;
  std::array<uint32_t, kMaxSteps> taken_{};
  uint32_t length_ = 0;
  uint32_t next_;
  uint32_t behind_back_ = 0;
  bool goes_back_ = false;
  bool is_over_ = false;
};

inline constexpr uint32_t kNoFusion = 0xffffffffu;

// Rows of a table (sorted by keys) as a tree of their steps.
class FusionTree {
 public:
  explicit FusionTree(std::span<const Fusion> table);
  struct Node {
    uint32_t order = 0;              // of its step among those that can stand there: order_of()
    uint32_t row = kNoFusion;        // that ends with this step
    uint32_t first = 0, behind = 0;  // nodes of the next step, in their order
  };
  // By handler, then by where the operands come from.
  static uint32_t order_of(StepKey key) { return key << 16 | key >> 16; }
  const Node* first_step(uint32_t handler) const {
    return first_[handler] == 0 ? nullptr : &nodes_[first_[handler]];
  }
  // The node of the step that stands next in `walk`, which it takes; null: no row goes on so.
  const Node* next_step(const Node& node, StepWalk& walk) const;

 private:
  std::vector<Node> nodes_;      // [0] stands for no step
  std::vector<uint16_t> first_;  // by handler: its node, or 0
};

// For each unit the fusion of the tree's table that begins there, by its index; kNoFusion. Chosen
// so that there are few dispatches.
std::vector<uint32_t> choose_fusions(const StepLine& line, const FusionTree& tree);

// Puts fused handlers into the op fields of `prepared`, the units of `line` with their handlers.
// A pure function of its arguments. Seed not 0: at every other place, at random.
void fuse(const StepLine& line, std::span<ir::Unit> prepared, uint64_t seed);

}  // namespace vm
