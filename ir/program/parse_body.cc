// Blocks and instructions of the text format.
#include <algorithm>
#include <array>
#include <unordered_map>

#include "ir/program/ops.h"
#include "ir/program/parse_scope.h"
#include "ir/program/text_names.h"
#include "stdlib/native/natives.h"

namespace ir {
namespace {

constexpr auto kOpWords = std::to_array<std::string_view>({
#define OP(id, text, operands, result) text,
#include "ir/program/ops.def"
#undef OP
});
constexpr auto kTrapWords = std::to_array<std::string_view>({
#define TRAP(id, text, title, help) text,
#include "ir/program/traps.def"
#undef TRAP
});

class BodyParser {
 public:
  BodyParser(const Program& program, const ParseScope& scope, uint64_t& value_budget, Pou& pou)
      : program_(program), scope_(scope), value_budget_(value_budget), pou_(pou) {}

  void parse_line(LineReader& line) {
    if (is_block_label(line.peek())) {
      parse_block(line);
    } else {
      parse_inst(line);
    }
    if (!line.at_end()) {
      line.fail("unexpected " + std::string(line.peek()));
    }
  }

 private:
  static bool is_block_label(std::string_view word) {
    return word.size() > 1 && word[0] == 'b' && word[1] >= '0' && word[1] <= '9';
  }

  void parse_block(LineReader& line) {
    if (line.numbered('b') != pou_.blocks.size()) {
      line.fail("blocks are numbered in order; this is b" + std::to_string(pou_.blocks.size()));
    }
    Block block;
    if (line.take("(")) {
      do {
        const ValueId param(line.numbered('v'));
        line.expect(":");
        define(line, param, line.scalar());
        block.params.push_back(param);
      } while (line.take(","));
      line.expect(")");
    }
    if (line.take("handler")) {
      block.handler = BlockId(line.numbered('b'));
    }
    line.expect(":");
    pou_.blocks.push_back(std::move(block));
  }

  void define(LineReader& line, ValueId value, Scalar scalar) {
    if (line.failed()) {
      return;
    }
    if (value.index >= pou_.values.size()) {
      const uint64_t added = uint64_t{value.index} + 1 - pou_.values.size();
      if (added > value_budget_) {
        line.fail("value number " + std::to_string(value.index) + " is too large");
        return;
      }
      value_budget_ -= added;
      pou_.values.resize(value.index + 1);
    }
    pou_.values[value.index].scalar = scalar;
  }

  void parse_inst(LineReader& line) {
    if (pou_.blocks.empty()) {
      line.fail("instruction before the first block");
      return;
    }
    Inst inst;
    if (line.peek().size() > 1 && line.peek()[0] == 'v' && line.peek()[1] <= '9') {
      inst.result = ValueId(line.numbered('v'));
      line.expect("=");
    }
    inst.op = static_cast<Op>(line.choice(kOpWords));
    if (shows_scalar(inst.op)) {
      inst.scalar = line.scalar();
    }
    if (line.failed()) {
      return;
    }
    parse_operands(line, inst);
    inst.line = line.take("@") ? line.index() : 0;
    if (inst.result.valid()) {
      define(line, inst.result, result_scalar(inst));
    }
    pou_.blocks.back().insts.push_back(std::move(inst));
  }

  void parse_operands(LineReader& line, Inst& inst) {
    switch (inst.op) {
      case Op::kConst:
        parse_const(line, inst);
        break;
      case Op::kLoad:
      case Op::kAddress:
      case Op::kString:
      case Op::kHandle:
      case Op::kCallInstance:
        inst.place = place(line);
        break;
      case Op::kStore:
        inst.place = place(line);
        line.expect(",");
        parse_values(line, inst.operands);
        break;
      case Op::kCopy:
        inst.place = place(line);
        line.expect(",");
        inst.place2 = place(line);
        break;
      case Op::kInit:
        inst.place = place(line);
        inst.constant = line.take(",") ? line.constant() : ConstId();
        break;
      case Op::kCheckRange:
        parse_value_and_range(line, inst);
        break;
      case Op::kSwitch:
        parse_value_and_range(line, inst);
        line.expect(",");
        parse_values_and_targets(line, inst);
        break;
      case Op::kSizeOf:
        inst.type = scope_.type(line);
        break;
      case Op::kCallFunction:
      case Op::kCallMethod:
      case Op::kCallBody:
      case Op::kCallVirtual:
        parse_call(line, inst);
        break;
      case Op::kIsType:
      case Op::kCallReference:
        inst.operands.push_back(ValueId(line.numbered('v')));
        line.expect(",");
        inst.type = scope_.type(line);
        break;
      case Op::kCallNative:
        inst.native = parse_native(line);
        parse_values(line, inst.operands);
        break;
      case Op::kTrap:
        inst.trap = static_cast<TrapKind>(parse_trap(line));
        break;
      default:
        parse_values_and_targets(line, inst);
    }
  }

  static void parse_const(LineReader& line, Inst& inst) {
    const std::string_view text = line.token();
    if (!line.failed() && !parse_immediate(inst.scalar, text, inst.imm)) {
      line.fail(std::string(text) + " is no value of " + std::string(scalar_name(inst.scalar)));
    }
  }

  static bool at_value(const LineReader& line) { return line.peek().starts_with('v'); }

  static void parse_values(LineReader& line, ValueList& values) {
    if (!at_value(line)) {
      return;
    }
    do {
      values.push_back(ValueId(line.numbered('v')));
    } while (line.take(","));
  }

  // "POU", "POU, v1" or "POU, PLACE".
  void parse_call(LineReader& line, Inst& inst) {
    inst.pou = scope_.pou(line);
    if (!line.take(",")) {
      return;
    }
    if (at_value(line)) {
      parse_values(line, inst.operands);
    } else {
      inst.place = place(line);
    }
  }

  static void parse_value_and_range(LineReader& line, Inst& inst) {
    inst.operands.push_back(ValueId(line.numbered('v')));
    line.expect(",");
    inst.low = line.signed_number();
    line.expect(".");
    line.expect(".");
    inst.high = line.signed_number();
  }

  // Trap names have hyphens, which are no part of a word.
  static uint32_t parse_trap(LineReader& line) {
    std::string name;
    while (!line.failed() && !line.at_end() && line.peek() != "@") {
      name += line.token();
    }
    const auto found = std::find(kTrapWords.begin(), kTrapWords.end(), name);
    if (found == kTrapWords.end()) {
      line.fail("there is no trap " + name);
      return 0;
    }
    return static_cast<uint32_t>(found - kTrapWords.begin());
  }

  static uint32_t parse_native(LineReader& line) {
    if (line.take("#")) {
      return line.index();
    }
    std::string text(line.word());
    for (const std::string_view part : {"/", "", ":", ""}) {
      text += part.empty() ? line.word() : part;
      if (!part.empty()) {
        line.expect(part);
      }
    }
    for (uint32_t i = 0; i < stdlib::native_count(); ++i) {
      if (native_text(i) == text) {
        return i;
      }
    }
    line.fail("there is no native function " + text);
    return 0;
  }

  // "v1, v2", "v1, b2(v3), b4" or "b2(v3)".
  static void parse_values_and_targets(LineReader& line, Inst& inst) {
    if (!at_value(line) && !is_block_label(line.peek())) {
      return;
    }
    do {
      if (at_value(line) && inst.targets.empty()) {
        inst.operands.push_back(ValueId(line.numbered('v')));
      } else {
        inst.targets.push_back(parse_target(line));
      }
    } while (!line.failed() && line.take(","));
  }

  static Target parse_target(LineReader& line) {
    Target target;
    target.block = BlockId(line.numbered('b'));
    if (line.take("(")) {
      parse_values(line, target.args);
      line.expect(")");
    }
    return target;
  }

  PlaceId place(LineReader& line) {
    pou_.places.push_back(parse_place(program_, scope_, pou_, line));
    return PlaceId(static_cast<uint32_t>(pou_.places.size() - 1));
  }

  const Program& program_;
  const ParseScope& scope_;
  uint64_t& value_budget_;
  Pou& pou_;
};

}  // namespace

BodyError parse_body(const Program& program, const ParseScope& scope,
                     const std::vector<BodyLine>& lines, uint64_t& value_budget, Pou& pou) {
  BodyParser parser(program, scope, value_budget, pou);
  for (const BodyLine& body_line : lines) {
    LineReader line(body_line.text);
    parser.parse_line(line);
    if (line.failed()) {
      return {body_line.line, line.reason()};
    }
  }
  return {};
}

}  // namespace ir
