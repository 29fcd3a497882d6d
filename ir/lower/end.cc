// Ends of blocks: jumps, branches and the moves into block parameters.
#include <algorithm>

#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {

void Selector::select_edge(const FlowBlock& flow_block) {
  pass_arguments(*flow_block.edge);
  block().end = {EndKind::kJump, {}, flow_block.successors[0], 0, 0, line_};
}

void Selector::select_end(const Inst& inst, const FlowBlock& flow_block) {
  flush_all(inst);
  BlockEnd& end = block().end;
  end.line = inst.line;
  switch (inst.op) {
    case Op::kJump:
      pass_arguments(inst.targets[0]);
      block().end.kind = EndKind::kJump;
      block().end.taken = flow_block.successors[0];
      return;
    case Op::kBranch:
      return select_branch(inst, flow_block);
    case Op::kSwitch:
      return select_switch(inst, flow_block);
    case Op::kTry:
      end.kind = EndKind::kTry;
      end.taken = flow_block.successors[0];
      end.other = flow_block.successors[1];
      return;
    case Op::kEndTry:
      pass_arguments(inst.targets[0]);
      block().end.kind = EndKind::kEndTry;
      block().end.taken = flow_block.successors[0];
      return;
    case Op::kTrapAgain:
      emit(Opcode::TRAP_AGAIN, {}, use(inst.operands[0]));
      block().end.kind = EndKind::kInst;
      return;
    case Op::kTrap:
      end.kind = EndKind::kTrap;
      end.trap = static_cast<uint32_t>(inst.trap);
      return;
    default:
      end.kind = EndKind::kReturn;
  }
}

void Selector::select_branch(const Inst& inst, const FlowBlock& flow_block) {
  uint32_t taken = flow_block.successors[0];
  uint32_t other = flow_block.successors[1];
  ValueId condition = inst.operands[0];
  BlockEnd& end = block().end;
  if (taken == other) {
    consume(condition);
    end.kind = EndKind::kJump;
    end.taken = taken;
    return;
  }
  while (take_not(condition)) std::swap(taken, other);
  Operand operand = use(condition);
  if (operand.kind == OperandKind::kConstant) {
    const Operand copy = new_register(Class::kB, {}, true);
    emit(move_opcode(Class::kB), copy, operand);
    operand = copy;
  }
  block().end = {EndKind::kBranch, operand, taken, other, 0, line_};
}

void Selector::select_switch(const Inst& inst, const FlowBlock& flow_block) {
  const auto entries = static_cast<uint32_t>(inst.targets.size() - 1);
  emit(switch_opcode(inst.scalar), {}, use(inst.operands[0]), {}, static_cast<uint32_t>(inst.low),
       entries);
  BlockEnd& end = block().end;
  end.kind = EndKind::kSwitch;
  end.taken = flow_block.successors[0];
  end.table.assign(flow_block.successors.begin() + 1, flow_block.successors.end());
}

void Selector::pass_arguments(const Target& target) {
  const Block& to = pou_.blocks[target.block.index];
  std::vector<std::pair<Operand, Operand>> moves;
  for (size_t i = 0; i < target.args.size(); ++i) {
    const Operand dest = register_for(to.params[i]);
    // A single tree may write the parameter itself: nothing reads it afterwards.
    if (target.args.size() == 1) return assign(dest, target.args[i]);
    const Operand source = use(target.args[i]);
    if (source != dest) moves.emplace_back(dest, source);
  }
  parallel_move(std::move(moves));
}

// All at once: a move whose destination is still to be read waits; a circle is
// broken with a temporary.
void Selector::parallel_move(std::vector<std::pair<Operand, Operand>> moves) {
  const auto is_read = [&](Operand dest) {
    return std::any_of(moves.begin(), moves.end(),
                       [&](const auto& move) { return move.second == dest; });
  };
  while (!moves.empty()) {
    const auto ready = std::find_if(moves.begin(), moves.end(),
                                    [&](const auto& move) { return !is_read(move.first); });
    if (ready != moves.end()) {
      const Register& dest = machine_.registers[ready->first.index];
      move(dest.cls, ready->first, ready->second);
      moves.erase(ready);
      continue;
    }
    const Operand blocked = moves.front().first;
    const Register held = machine_.registers[blocked.index];
    const Operand copy = new_register(held.cls, held.region, false);
    move(held.cls, copy, blocked);
    for (auto& [dest, source] : moves) {
      if (source == blocked) source = copy;
    }
  }
}

}  // namespace ir::codegen
