#include "tests/differential/generator.h"

#include <string_view>
#include <vector>

#include "tests/differential/random.h"

namespace differential {
namespace {

enum class Class : uint8_t { kBool, kSigned, kUnsigned, kBits, kReal, kTime, kString };

struct TypeRow {
  std::string_view name;
  Class cls;
  int bits;
};
constexpr TypeRow kTypes[] = {
    {"BOOL", Class::kBool, 1},         {"SINT", Class::kSigned, 8},
    {"INT", Class::kSigned, 16},       {"DINT", Class::kSigned, 32},
    {"LINT", Class::kSigned, 64},      {"USINT", Class::kUnsigned, 8},
    {"UINT", Class::kUnsigned, 16},    {"UDINT", Class::kUnsigned, 32},
    {"ULINT", Class::kUnsigned, 64},   {"BYTE", Class::kBits, 8},
    {"WORD", Class::kBits, 16},        {"DWORD", Class::kBits, 32},
    {"LWORD", Class::kBits, 64},       {"REAL", Class::kReal, 32},
    {"LREAL", Class::kReal, 64},       {"TIME", Class::kTime, 64},
    {"STRING[12]", Class::kString, 0},
};
constexpr int kTypeCount = std::size(kTypes);
constexpr int kBool = 0;
constexpr int kInt = 2;
constexpr int kDint = 3;
constexpr int kLword = 12;
constexpr int kTime = 15;
constexpr int kString = 16;

struct Variable {
  std::string name;
  int type;
  bool writable = true;
};

struct Callable {
  std::string name;
  int result;               // functions
  std::vector<int> inputs;  // named i0, i1, ...
};

std::string number(uint64_t v) { return std::to_string(v); }

class Generator {
 public:
  explicit Generator(uint64_t seed) : random_(seed) {}

  std::string run() {
    types();
    uint32_t functions = 1 + random_.below(3);
    for (uint32_t i = 0; i < functions; ++i) function(i);
    uint32_t blocks = 1 + random_.below(3);
    for (uint32_t i = 0; i < blocks; ++i) block(i);
    program();
    return out_;
  }

 private:
  void line(const std::string& text) { out_ += std::string(indent_ * 2, ' ') + text + "\n"; }

  void types() {
    line("TYPE");
    line("  Colour : (Red, Green := 5, Blue);");
    line("  Part : STRUCT");
    for (int t = 0; t < kTypeCount; t += 1 + random_.below(3)) {
      parts_.push_back(t);
      line("    m" + number(t) + " : " + std::string(kTypes[t].name) + ";");
    }
    line("  END_STRUCT;");
    line("END_TYPE");
  }

  // --- declarations ---
  void declare(int type, const std::string& name) {
    std::string text = name + " : " + std::string(kTypes[type].name);
    if (random_.one_in(2)) text += " := " + literal(type);
    line("  " + text + ";");
    scope_.push_back({name, type});
  }

  void locals(const std::string& prefix, uint32_t count) {
    line("VAR");
    for (uint32_t i = 0; i < count; ++i) {
      declare(static_cast<int>(random_.below(kTypeCount)), prefix + number(i));
    }
    // Loop counters of each nesting level are written by their FOR only.
    for (int i = 0; i < 3; ++i) line("  loop" + number(i) + " : INT;");
    line("  guard : DINT;");
  }

  void inputs(Callable& callable) {
    line("VAR_INPUT");
    uint32_t count = 1 + random_.below(3);
    for (uint32_t i = 0; i < count; ++i) {
      int type = static_cast<int>(random_.below(kTypeCount));
      callable.inputs.push_back(type);
      line("  i" + number(i) + " : " + std::string(kTypes[type].name) + ";");
      scope_.push_back({"i" + number(i), type, false});
    }
    line("END_VAR");
  }

  void function(uint32_t index) {
    scope_.clear();
    Callable self{"Fun" + number(index), static_cast<int>(random_.below(kTypeCount)), {}};
    line("FUNCTION " + self.name + " : " + std::string(kTypes[self.result].name));
    inputs(self);
    locals("l", 3);
    line("END_VAR");
    statements(2 + random_.below(3), 2);
    line("  " + self.name + " := " + expression(self.result, 3) + ";");
    line("END_FUNCTION");
    functions_.push_back(self);
  }

  void block(uint32_t index) {
    scope_.clear();
    Callable self{"Block" + number(index), 0, {}};
    line("FUNCTION_BLOCK " + self.name);
    inputs(self);
    line("VAR_OUTPUT");
    declare(kBool, "q");
    declare(kDint, "n");
    line("END_VAR");
    locals("v", 4);
    if (index > 0) line("  child : Block" + number(index - 1) + ";");
    line("END_VAR");
    statements(3 + random_.below(4), 2);
    if (index > 0) call_block(blocks_[index - 1], "child");
    line("END_FUNCTION_BLOCK");
    blocks_.push_back(self);
  }

  void program() {
    scope_.clear();
    line("PROGRAM Main");
    locals("g", 24);
    line("  part, other : Part;");
    line("  parts : ARRAY[1..3] OF Part;");
    line("  grid : ARRAY[0..2, -1..1] OF DINT;");
    line("  colour : Colour;");
    for (size_t i = 0; i < blocks_.size(); ++i) {
      line("  b" + number(i) + " : " + blocks_[i].name + ";");
      line("  row" + number(i) + " : ARRAY[0..2] OF " + blocks_[i].name + ";");
    }
    line("  t : TON; c : CTU; r : R_TRIG;");
    line("END_VAR");
    for (int type : parts_) {
      scope_.push_back({"part.m" + number(type), type});
      scope_.push_back({"parts[2].m" + number(type), type});
    }
    scope_.push_back({"grid[1, 0]", kDint});
    in_program_ = true;
    statements(12 + random_.below(12), 3);
    for (size_t i = 0; i < blocks_.size(); ++i) {
      call_block(blocks_[i], "b" + number(i));
      line("  FOR loop0 := 0 TO 2 DO");
      call_block(blocks_[i], "row" + number(i) + "[loop0]");
      line("  END_FOR");
    }
    line("  t(IN := " + expression(kBool, 2) + ", PT := T#35ms);");
    line("  c(CU := t.Q OR " + expression(kBool, 2) + ", PV := 3);");
    line("  r(CLK := c.Q);");
    line("END_PROGRAM");
  }

  void call_block(const Callable& callee, const std::string& instance) {
    std::string args;
    for (size_t i = 0; i < callee.inputs.size(); ++i) {
      if (random_.one_in(4)) continue;  // an omitted input keeps its value
      args +=
          (args.empty() ? "" : ", ") + ("i" + number(i)) + " := " + expression(callee.inputs[i], 2);
    }
    line("  " + instance + "(" + args + ");");
  }

  // --- statements ---
  void statements(uint32_t count, int depth) {
    ++indent_;
    for (uint32_t i = 0; i < count; ++i) statement(depth);
    --indent_;
  }

  void statement(int depth) {
    switch (depth == 0 ? random_.below(3) : random_.below(11)) {
      case 0:
      case 1:
      case 2:
        assignment();
        break;
      case 3:
      case 4:
        if_statement(depth);
        break;
      case 5:
        case_statement(depth);
        break;
      case 6:
      case 7:
        for_statement(depth);
        break;
      case 8:
        while_statement(depth);
        break;
      case 9:
        aggregate();
        break;
      default:
        assignment();
        break;
    }
  }

  void assignment() {
    const Variable* target = nullptr;
    for (int tries = 0; tries < 20 && target == nullptr; ++tries) {
      const Variable& candidate = scope_[random_.below(static_cast<uint32_t>(scope_.size()))];
      if (candidate.writable) target = &candidate;
    }
    if (target == nullptr) return line(";");
    line(target->name + " := " + expression(target->type, 3) + ";");
  }

  void if_statement(int depth) {
    line("IF " + expression(kBool, 3) + " THEN");
    statements(1 + random_.below(2), depth - 1);
    if (random_.one_in(3)) {
      line("ELSIF " + expression(kBool, 2) + " THEN");
      statements(1, depth - 1);
    }
    if (random_.one_in(2)) {
      line("ELSE");
      statements(1 + random_.below(2), depth - 1);
    }
    line("END_IF;");
  }

  void case_statement(int depth) {
    line("CASE " + expression(kInt, 2) + " OF");
    line("  -3..0:");
    statements(1, depth - 1);
    line("  1, 7, 100..200:");
    statements(1, depth - 1);
    line("  " + number(1000 + random_.below(20000)) + ":");
    statements(1, depth - 1);
    if (random_.one_in(2)) {
      line("ELSE");
      statements(1, depth - 1);
    }
    line("END_CASE;");
  }

  void for_statement(int depth) {
    std::string loop = "loop" + number(loop_level_);
    if (loop_level_ == 3) return assignment();
    ++loop_level_;
    line("FOR " + loop + " := " + number(random_.below(4)) + " TO " + number(random_.below(9)) +
         (random_.one_in(2) ? " BY " + number(1 + random_.below(3)) : "") + " DO");
    scope_.push_back({loop, kInt, false});
    if (random_.one_in(4)) line("  IF " + expression(kBool, 2) + " THEN CONTINUE; END_IF;");
    statements(1 + random_.below(2), depth - 1);
    if (random_.one_in(4)) line("  IF " + expression(kBool, 2) + " THEN EXIT; END_IF;");
    scope_.pop_back();
    line("END_FOR;");
    --loop_level_;
  }

  void while_statement(int depth) {
    if (in_while_) return assignment();
    in_while_ = true;
    line("guard := " + number(random_.below(6)) + ";");
    bool repeat = random_.one_in(2);
    line(repeat ? "REPEAT" : "WHILE guard > 0 AND " + expression(kBool, 1) + " DO");
    statements(1, depth - 1);
    line("  guard := guard - 1;");
    line(repeat ? "UNTIL guard <= 0 OR " + expression(kBool, 1) + " END_REPEAT;" : "END_WHILE;");
    in_while_ = false;
  }

  void aggregate() {
    if (!in_program_) return assignment();
    switch (random_.below(5)) {
      case 0:
        line("other := parts[" + index(1, 3) + "];");
        break;
      case 1:
        line("parts[" + index(1, 3) + "] := part;");
        break;
      case 2:
        line("grid[" + index(0, 2) + ", " + index(-1, 1) + "] := " + expression(kDint, 2) + ";");
        break;
      case 3:
        line("IF colour = Green THEN colour := Blue; ELSE colour := Green; END_IF;");
        break;
      default:
        line("parts[" + index(1, 3) + "].m" + number(parts_[0]) +
             " := " + expression(parts_[0], 2) + ";");
        break;
    }
  }

  // An index that is nearly always in range.
  std::string index(int low, int high) {
    if (random_.one_in(60)) return variable(kInt);
    if (random_.one_in(3))
      return std::to_string(low + static_cast<int>(random_.below(high - low + 1)));
    return "LIMIT(" + std::to_string(low) + ", " + expression(kInt, 1) + ", " +
           std::to_string(high) + ")";
  }

  // --- expressions ---
  std::string literal(int type) {
    const TypeRow& row = kTypes[type];
    switch (row.cls) {
      case Class::kBool:
        return random_.one_in(2) ? "TRUE" : "FALSE";
      case Class::kSigned: {
        uint64_t limit = row.bits == 64 ? 1000000 : 1ull << (row.bits - 1);
        std::string text = number(random_.next() % limit);
        // Parenthesised: a sign must not follow an operator.
        return random_.one_in(3) ? "(-" + text + ")" : text;
      }
      case Class::kUnsigned:
      case Class::kBits: {
        uint64_t mask = row.bits == 64 ? ~0ull : (1ull << row.bits) - 1;
        uint64_t value = random_.one_in(2) ? random_.next() & mask : random_.below(16);
        return std::string(row.name) + "#" + number(value);
      }
      case Class::kReal: {
        std::string text = number(random_.below(1000)) + "." + number(random_.below(100));
        return random_.one_in(4) ? "(-" + text + ")" : text;
      }
      case Class::kTime:
        return "T#" + number(random_.below(100000)) + "ms";
      case Class::kString: {
        std::string text = "'";
        for (uint32_t n = random_.below(8); n > 0; --n) {
          text += static_cast<char>('a' + random_.below(26));
        }
        return text + "'";
      }
    }
    return "0";
  }

  std::string variable(int type) {
    for (int tries = 0; tries < 30; ++tries) {
      const Variable& candidate = scope_[random_.below(static_cast<uint32_t>(scope_.size()))];
      if (candidate.type == type) return candidate.name;
    }
    if (type == kDint) return "guard";
    if (type > kBool && type <= kLword)
      return "DINT_TO_" + std::string(kTypes[type].name) + "(guard)";
    return literal(type);
  }

  std::string expression(int type, int depth) {
    if (depth == 0) return random_.one_in(4) ? literal(type) : variable(type);
    switch (random_.below(8)) {
      case 0:
        return literal(type);
      case 1:
      case 2:
        return variable(type);
      case 3:
        return "SEL(" + expression(kBool, depth - 1) + ", " + expression(type, depth - 1) + ", " +
               expression(type, depth - 1) + ")";
      case 4:
        if (std::string call = function_call(type, depth); !call.empty()) return call;
        [[fallthrough]];
      default:
        return operation(type, depth);
    }
  }

  std::string function_call(int type, int depth) {
    for (const Callable& callable : functions_) {
      if (callable.result != type || !random_.one_in(2)) continue;
      std::string args;
      for (int input : callable.inputs) {
        args += (args.empty() ? "" : ", ") + expression(input, depth - 1);
      }
      return callable.name + "(" + args + ")";
    }
    return {};
  }

  std::string binary(const char* op, int type, int depth) {
    return "(" + expression(type, depth - 1) + " " + op + " " + expression(type, depth - 1) + ")";
  }

  std::string operation(int type, int depth) {
    switch (kTypes[type].cls) {
      case Class::kBool:
        return bool_operation(depth);
      case Class::kSigned:
      case Class::kUnsigned:
        return integer_operation(type, depth);
      case Class::kBits:
        return bits_operation(type, depth);
      case Class::kReal:
        return real_operation(type, depth);
      case Class::kTime:
        return random_.one_in(2) ? binary(random_.one_in(2) ? "+" : "-", kTime, depth)
                                 : "MAX(" + expression(kTime, depth - 1) + ", T#1s)";
      case Class::kString:
        return string_operation(depth);
    }
    return literal(type);
  }

  std::string bool_operation(int depth) {
    static constexpr const char* kLogic[] = {"AND", "OR", "XOR", "AND_THEN", "OR_ELSE"};
    static constexpr const char* kCompare[] = {"=", "<>", "<", "<=", ">", ">="};
    switch (random_.below(5)) {
      case 0:
      case 1:
        return binary(kLogic[random_.below(5)], kBool, depth);
      case 2:
        return "(NOT " + expression(kBool, depth - 1) + ")";
      default:
        return binary(kCompare[random_.below(6)],
                      1 + static_cast<int>(random_.below(kTypeCount - 1)), depth);
    }
  }

  // The left operand is a variable: what is constant is computed by the compiler, which
  // refuses results outside the type.
  std::string integer_operation(int type, int depth) {
    static constexpr const char* kArithmetic[] = {"+", "-", "*"};
    static constexpr const char* kDivision[] = {"/", "MOD"};
    std::string name(kTypes[type].name);
    switch (random_.below(9)) {
      case 0:
      case 1:
      case 2:
        return "(" + variable(type) + " " + kArithmetic[random_.below(3)] + " " +
               expression(type, depth - 1) + ")";
      case 3:
        if (random_.one_in(12)) {
          return "(" + variable(type) + " " + kDivision[random_.below(2)] + " " + variable(type) +
                 ")";
        }
        return "(" + variable(type) + " " + kDivision[random_.below(2)] + " " +
               number(1 + random_.below(99)) + ")";
      case 4:
        return "MIN(" + expression(type, depth - 1) + ", " + expression(type, depth - 1) + ")";
      case 5:
        return "MAX(" + expression(type, depth - 1) + ", " + expression(type, depth - 1) + ")";
      case 6:
        return conversion(type, depth);
      case 7:
        return kTypes[type].cls == Class::kSigned ? "(-" + variable(type) + ")" : variable(type);
      default:
        return kTypes[type].cls == Class::kSigned ? "ABS(" + variable(type) + ")"
                                                  : conversion(type, depth);
    }
  }

  // From any other number or bit string; from REAL only within range.
  std::string conversion(int to, int depth) {
    int from = static_cast<int>(1 + random_.below(12));
    std::string target(kTypes[to].name);
    if (random_.one_in(5)) {
      std::string real = random_.one_in(20)
                             ? expression(13, depth - 1)
                             : "LIMIT(0.0, " + expression(13, depth - 1) + ", 100.0)";
      return (random_.one_in(2) ? "REAL_TO_" : "TRUNC_") + target + "(" + real + ")";
    }
    if (from == to) return variable(to);
    return std::string(kTypes[from].name) + "_TO_" + target + "(" + expression(from, depth - 1) +
           ")";
  }

  std::string bits_operation(int type, int depth) {
    static constexpr const char* kLogic[] = {"AND", "OR", "XOR"};
    static constexpr const char* kShift[] = {"SHL", "SHR", "ROL", "ROR"};
    switch (random_.below(4)) {
      case 0:
      case 1:
        return binary(kLogic[random_.below(3)], type, depth);
      case 2:
        return "(NOT " + expression(type, depth - 1) + ")";
      default:
        return std::string(kShift[random_.below(4)]) + "(" + expression(type, depth - 1) + ", " +
               number(random_.below(70)) + ")";
    }
  }

  std::string real_operation(int type, int depth) {
    static constexpr const char* kArithmetic[] = {"+", "-", "*", "/"};
    std::string name(kTypes[type].name);
    switch (random_.below(6)) {
      case 0:
      case 1:
      case 2:
        return binary(kArithmetic[random_.below(4)], type, depth);
      case 3:
        return "ABS(" + expression(type, depth - 1) + ")";
      case 4: {
        int from = static_cast<int>(1 + random_.below(8));
        return std::string(kTypes[from].name) + "_TO_" + name + "(" + expression(from, depth - 1) +
               ")";
      }
      default:
        return "SQRT(ABS(" + expression(type, depth - 1) + "))";
    }
  }

  std::string string_operation(int depth) {
    std::string first = expression(kString, depth - 1);
    switch (random_.below(5)) {
      case 0:
        return "CONCAT(" + first + ", " + expression(kString, depth - 1) + ")";
      case 1:
        return "LEFT(" + first + ", " + number(random_.below(6)) + ")";
      case 2:
        return "MID(" + first + ", " + number(random_.below(4)) + ", " +
               number(1 + random_.below(5)) + ")";
      case 3:
        return "DINT_TO_STRING(" + expression(kDint, depth - 1) + ")";
      default:
        return "REPLACE(" + first + ", " + literal(kString) + ", 1, 2)";
    }
  }

  Random random_;
  std::string out_;
  size_t indent_ = 0;
  std::vector<Variable> scope_;
  std::vector<Callable> functions_;
  std::vector<Callable> blocks_;
  std::vector<int> parts_;
  uint32_t loop_level_ = 0;
  bool in_while_ = false;
  bool in_program_ = false;
};

}  // namespace

std::string random_program(uint64_t seed) { return Generator(seed).run(); }

}  // namespace differential
