#include "ir/program/print_body.h"

#include "ir/program/ops.h"
#include "ir/program/text_names.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

std::string value_name(ValueId value) { return "v" + std::to_string(value.index); }

std::string list(const ValueList& values) {
  std::string text;
  for (const ValueId value : values) {
    text += (text.empty() ? "" : ", ") + value_name(value);
  }
  return text;
}

class PouPrinter {
 public:
  PouPrinter(const Program& program, const PrintNames& names, const Pou& pou, std::string& text)
      : program_(program), names_(names), pou_(pou), text_(text) {}

  void print() {
    print_header();
    for (const Local& local : pou_.locals) {
      text_ += "  local " + std::string(kLocalWords[static_cast<size_t>(local.kind)]) + " " +
               name_text(local.name) + " : " + names_.type(local.type) + "\n";
    }
    for (size_t i = 0; i < pou_.blocks.size(); ++i) {
      print_block(i, pou_.blocks[i]);
    }
  }

 private:
  void print_header() {
    text_ += "pou " + std::string(kPouWords[static_cast<size_t>(pou_.kind)]) + " " +
             name_text(pou_.name);
    text_ += pou_.self.valid() ? " self " + names_.type(pou_.self) : "";
    if (pou_.recursion_depth != 0) {
      text_ += " recursion " + std::to_string(pou_.recursion_depth);
    }
    if (!pou_.file.empty() || pou_.line != 0) {
      text_ += " file " + string_text(pou_.file) + " line " + std::to_string(pou_.line);
    }
    if (pou_.content.identity != base::Digest{}) {
      text_ += " hash " + base::to_hex(pou_.content.identity);
    }
    text_ += "\n";
  }

  void print_block(size_t index, const Block& block) {
    text_ += "  b" + std::to_string(index);
    for (size_t i = 0; i < block.params.size(); ++i) {
      const ValueId param = block.params[i];
      text_ += (i == 0 ? "(" : ", ") + value_name(param) + ":" + scalar_of(param);
    }
    text_ += block.params.empty() ? "" : ")";
    text_ += block.handler.valid() ? " handler b" + std::to_string(block.handler.index) : "";
    text_ += ":\n";
    for (const Inst& inst : block.insts) {
      print_inst(inst);
    }
  }

  std::string scalar_of(ValueId value) const {
    return value.index < pou_.values.size()
               ? std::string(scalar_name(pou_.values[value.index].scalar))
               : "?";
  }

  void print_inst(const Inst& inst) {
    text_ += "    ";
    text_ += inst.result.valid() ? value_name(inst.result) + " = " : "";
    text_ += op_name(inst.op);
    text_ += shows_scalar(inst.op) ? " " + std::string(scalar_name(inst.scalar)) : "";
    const std::string operands = operand_text(inst);
    text_ += operands.empty() ? "" : " " + operands;
    text_ += inst.line != 0 ? " @" + std::to_string(inst.line) : "";
    text_ += "\n";
  }

  std::string operand_text(const Inst& inst) const {
    switch (inst.op) {
      case Op::kConst:
        return immediate_text(inst.scalar, inst.imm);
      case Op::kLoad:
      case Op::kAddress:
      case Op::kString:
      case Op::kHandle:
      case Op::kCallInstance:
        return place(inst.place);
      case Op::kStore:
        return place(inst.place) + ", " + list(inst.operands);
      case Op::kCopy:
        return place(inst.place) + ", " + place(inst.place2);
      case Op::kInit:
        return place(inst.place) +
               (inst.constant.valid() ? ", #" + std::to_string(inst.constant.index) : "");
      case Op::kCheckRange:
        return list(inst.operands) + ", " + std::to_string(inst.low) + ".." +
               std::to_string(inst.high);
      case Op::kSizeOf:
        return names_.type(inst.type);
      case Op::kCallFunction:
      case Op::kCallMethod:
      case Op::kCallBody:
      case Op::kCallVirtual:
        return names_.pou(inst.pou) + (inst.place.valid() ? ", " + place(inst.place) : "") +
               (inst.operands.empty() ? "" : ", " + list(inst.operands));
      case Op::kIsType:
      case Op::kCallReference:
        return list(inst.operands) + ", " + names_.type(inst.type);
      case Op::kCallNative:
        return native_text(inst.native) + (inst.operands.empty() ? "" : " " + list(inst.operands));
      case Op::kJump:
      case Op::kTry:
      case Op::kEndTry:
        return targets(inst);
      case Op::kBranch:
        return list(inst.operands) + ", " + targets(inst);
      case Op::kSwitch:
        return list(inst.operands) + ", " + std::to_string(inst.low) + ".." +
               std::to_string(inst.high) + ", " + targets(inst);
      case Op::kTrap:
        return trap_name(inst.trap);
      default:
        return list(inst.operands);
    }
  }

  std::string place(PlaceId id) const { return print_place(program_, names_, pou_, id); }

  static std::string targets(const Inst& inst) {
    std::string text;
    for (const Target& target : inst.targets) {
      text += (text.empty() ? "b" : ", b") + std::to_string(target.block.index);
      text += target.args.empty() ? "" : "(" + list(target.args) + ")";
    }
    return text;
  }

  const Program& program_;
  const PrintNames& names_;
  const Pou& pou_;
  std::string& text_;
};

}  // namespace

void print_pou(const Program& program, const PrintNames& names, const Pou& pou, std::string& text) {
  PouPrinter(program, names, pou, text).print();
}

}  // namespace ir
