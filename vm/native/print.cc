// A Function as text, for people who look for a defect.
#include "vm/native/print.h"

#include <cstdio>

namespace vm::native {
namespace {

const char* const kNames[] = {
    "const",    "load",        "store",      "addr",       "place",    "add",     "addsh",
    "sub",      "mul",         "and",        "or",         "xor",      "andn",    "orn",
    "shl",      "shr",         "sar",        "rol",        "ror",      "divs",    "divu",
    "mods",     "modu",        "mulhighs",   "mulhighu",   "neg",      "not",     "notb",
    "compare",  "select",      "selectcmp",  "sext",       "zext",     "fadd",    "fsub",
    "fmul",     "fdiv",        "fmin",       "fmax",       "fneg",     "fabs",    "fsqrt",
    "fcompare", "fselect",     "inttofloat", "floattoint", "fwidth",   "bitstof", "ftobits",
    "resolve",  "movehandle",  "reach",      "reachpart",  "handleat", "exitif",  "instance",
    "tasktime", "advancetime", "pool",       "context",    "native",   "helper",  "call",
    "enter"};
const char* const kConds[] = {"=",  "<>",  "<s", "<=s", ">s",     ">=s",
                              "<u", "<=u", ">u", ">=u", "no bit", "any bit"};
const char* const kEnds[] = {"jump",   "loop", "branch",     "take fuel",
                             "return", "exit", "unreachable"};

std::string name(const Function& f, Val v) {
  if (v == kNone) return "-";
  if (f.values[v].constant) return "#" + std::to_string(static_cast<int64_t>(f.values[v].bits));
  return "v" + std::to_string(v);
}

std::string list(const Function& f, const std::vector<Val>& values) {
  std::string out = "(";
  for (const Val v : values) out += (out.size() > 1 ? ", " : "") + name(f, v);
  return out + ")";
}

std::string memory(const Function& f, const Mem& mem) {
  const char* const bases[] = {"frame", "self", "data", ""};
  std::string out = std::string("[") + bases[static_cast<size_t>(mem.base)];
  if (mem.pointer != kNone) out += name(f, mem.pointer);
  if (mem.index != kNone) out += "+" + name(f, mem.index) + "*" + std::to_string(mem.scale);
  return out + "+" + std::to_string(mem.disp) + "]";
}

std::string line(const Function& f, const Node& n) {
  std::string out = "  " + std::to_string(n.unit) + ": ";
  if (n.result != kNone) out += name(f, n.result) + " := ";
  out += kNames[static_cast<size_t>(n.op)];
  out += "." + std::to_string(n.width);
  if (n.from != 0) out += "/" + std::to_string(n.from);
  if (n.op == Op::kCompare || n.op == Op::kFCompare || n.op == Op::kExitIf ||
      n.op == Op::kSelectCmp) {
    out += std::string(" ") + kConds[static_cast<size_t>(n.cond)];
  }
  for (const Val v : n.in) out += v == kNone ? "" : " " + name(f, v);
  if (n.folded != 0xff || n.op == Op::kLoad || n.op == Op::kStore || n.op == Op::kAddr ||
      n.op == Op::kPlace) {
    out += " " + memory(f, n.mem);
  }
  if (n.variable != kNone) out += " var" + std::to_string(n.variable);
  return out;
}

}  // namespace

std::string print(const Function& f) {
  std::string out;
  for (Block b = 0; b < f.blocks.size(); ++b) {
    const BasicBlock& block = f.blocks[b];
    out +=
        "block " + std::to_string(b) + list(f, block.params) + (block.head ? " head" : "") + "\n";
    for (const uint32_t n : block.nodes) out += line(f, f.nodes[n]) + "\n";
    const End& e = block.end;
    out += std::string("  ") + kEnds[static_cast<size_t>(e.kind)];
    if (e.kind == EndKind::kBranch) {
      out += std::string(" ") + name(f, e.in[0]) + " " + kConds[static_cast<size_t>(e.cond)] + " " +
             name(f, e.in[1]);
    }
    for (uint32_t i = 0; i < 2; ++i) {
      if (e.target[i] != kNone) out += " -> " + std::to_string(e.target[i]) + list(f, e.args[i]);
    }
    out += "\n";
  }
  return out;
}

}  // namespace vm::native
