// Random programs of tries, loops, branches and calls of methods, whose operations trap now and
// then: interpreter and evaluator must agree about state and traps after every scan.
#include <random>

#include "tests/unit/references/rig.h"

namespace references {
namespace {

struct Callee {
  std::string name;
  std::string call;  // "call F", "call_method 'Base.go', self.leaf", ...
  bool by_handle = false;
};

// The body of one POU. Blocks are numbered as they are made; what a block sees of the values
// before it follows from the nesting.
class Body {
 public:
  Body(std::mt19937& random, std::vector<std::string> places, std::vector<Callee> callees,
       std::vector<std::string> handles, bool has_input)
      : random_(random),
        places_(std::move(places)),
        callees_(std::move(callees)),
        handles_(std::move(handles)),
        has_input_(has_input) {
    block_ = add_block();
    if (has_input_) places_.push_back("local.x");
    for (const char* local : {"local.a", "local.b"}) places_.push_back(local);
    if (!has_input) {
      const std::string handle = define("handle u64 self.leaf");
      line("store u64 global.ref, " + handle);
    }
    statements(has_input ? 3 : 5, 0);
    line("return");
  }

  std::string text() const {
    std::string out = "  local temp a : DINT\n  local temp b : DINT\n";
    for (int i = 0; i < loops_; ++i) out += "  local temp i" + std::to_string(i) + " : DINT\n";
    for (size_t i = 0; i < blocks_.size(); ++i) {
      out += "  b" + std::to_string(i);
      if (!blocks_[i].param.empty()) out += "(" + blocks_[i].param + ":i32)";
      if (blocks_[i].handler >= 0) out += " handler b" + std::to_string(blocks_[i].handler);
      out += ":\n";
      if (i == 0) {
        for (int l = 0; l < loops_; ++l) out += "    init local.i" + std::to_string(l) + "\n";
        out += "    init local.a\n    init local.b\n";
        if (has_input_) out += "    init local.r\n";
      }
      out += blocks_[i].lines;
    }
    return out;
  }

 private:
  struct Block {
    int handler = -1;
    std::string param;
    std::string lines;
  };

  uint32_t pick(uint32_t limit) { return static_cast<uint32_t>(random_() % limit); }
  int add_block() {
    blocks_.push_back({handler_, "", ""});
    return static_cast<int>(blocks_.size()) - 1;
  }
  static std::string b(int block) { return "b" + std::to_string(block); }
  void line(const std::string& text) {
    blocks_[static_cast<size_t>(block_)].lines +=
        "    " + text + " @" + std::to_string(++line_) + "\n";
  }
  std::string fresh() { return "v" + std::to_string(values_++); }
  std::string define(const std::string& right) {
    const std::string value = fresh();
    line(value + " = " + right);
    return value;
  }
  const std::string& place() { return places_[pick(static_cast<uint32_t>(places_.size()))]; }

  std::string number(uint32_t depth) {
    switch (pick(depth > 2 ? 3 : 8)) {
      case 0:
        return define("const i32 " + std::to_string(static_cast<int>(pick(7)) - 2));
      case 1:
        return known_.empty() ? define("load i32 " + place())
                              : known_[pick(static_cast<uint32_t>(known_.size()))];
      case 2:
      case 3:
        return define("load i32 " + place());
      default: {
        static constexpr const char* kOps[] = {"add", "add", "sub", "sub", "mul", "min", "max"};
        const std::string left = number(depth + 1);
        if (pick(30) == 0) return define("check_range i32 " + left + ", -400..400");
        if (pick(4) == 0) {  // by 0 now and then
          const std::string divisor = define("const i32 " + std::to_string(pick(6)));
          return define((pick(2) == 0 ? "div i32 " : "mod i32 ") + left + ", " + divisor);
        }
        const std::string right = number(depth + 1);
        return define(std::string(kOps[pick(7)]) + " i32 " + left + ", " + right);
      }
    }
  }
  std::string condition() {
    const std::string left = number(1);
    return define("lt i32 " + left + ", " + number(1));
  }

  void assign() {
    const std::string value = number(0);
    line("store i32 " + place() + ", " + value);
    if (pick(2) == 0) known_.push_back(value);
  }

  void call() {
    if (callees_.empty()) return assign();
    const Callee& callee = callees_[pick(static_cast<uint32_t>(callees_.size()))];
    const std::string argument = number(1);
    const std::string handle =
        callee.by_handle ? define(handles_[pick(static_cast<uint32_t>(handles_.size()))]) : "";
    line("store i32 arg('" + callee.name + "').x, " + argument);
    line(callee.call + (handle.empty() ? "" : ", " + handle));
    const std::string result = define("load i32 arg('" + callee.name + "').r");
    line("store i32 " + place() + ", " + result);
  }

  // Both ways meet in a block that gets a value from each.
  void branch(uint32_t depth) {
    const std::string test = condition();
    const int one = add_block();
    const int other = add_block();
    const int behind = add_block();
    const size_t known = known_.size();
    line("branch " + test + ", " + b(one) + ", " + b(other));
    for (const int way : {one, other}) {
      block_ = way;
      if (way == other && pick(10) == 0) {
        line("trap assert");
        continue;
      }
      statements(2, depth + 1);
      const std::string value = number(1);
      line("jump " + b(behind) + "(" + value + ")");
      known_.resize(known);
    }
    block_ = behind;
    blocks_[static_cast<size_t>(behind)].param = fresh();
    known_.push_back(blocks_[static_cast<size_t>(behind)].param);
  }

  // Few, because those of callers and callees multiply.
  void loop(uint32_t depth) {
    if (loops_ == (has_input_ ? 1 : 3)) return guarded(depth);
    const std::string counter = "local.i" + std::to_string(loops_++);
    const int head = add_block();
    const int behind = add_block();
    const size_t known = known_.size();
    const std::string zero = define("const i32 0");
    line("store i32 " + counter + ", " + zero);
    line("jump " + b(head));
    block_ = head;
    statements(2, depth + 1);
    const std::string one = define("const i32 1");
    const std::string at = define("load i32 " + counter);
    const std::string next = define("add i32 " + at + ", " + one);
    line("store i32 " + counter + ", " + next);
    const std::string turns = define("const i32 3");
    const std::string again = define("lt i32 " + next + ", " + turns);
    line("branch " + again + ", " + b(head) + ", " + b(behind));
    known_.resize(known);
    block_ = behind;
  }

  void guarded(uint32_t depth) {
    const int handler = add_block();
    const int behind = add_block();
    const int outer = handler_;
    const size_t known = known_.size();
    handler_ = handler;
    const int body = add_block();
    line("try " + b(body) + ", " + b(handler));
    block_ = body;
    statements(3, depth + 1);
    line("end_try " + b(behind));
    handler_ = outer;
    known_.resize(known);
    block_ = handler;
    const std::string kind = define("trap_kind u32");
    const std::string wide = define("wrap i32 " + kind);
    const std::string now = define("load i32 global.kinds");
    const std::string seven = define("const i32 7");
    const std::string scaled = define("mul i32 " + now + ", " + seven);
    const std::string sum = define("add i32 " + scaled + ", " + wide);
    line("store i32 global.kinds, " + sum);
    statements(2, depth + 1);
    line("jump " + b(behind));
    known_.resize(known);
    block_ = behind;
  }

  void statements(uint32_t count, uint32_t depth) {
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t what = depth == 0 ? 5 + pick(5) : pick(depth > 2 ? 5 : 9);
      if (what < 3)
        assign();
      else if (what < 5)
        call();
      else if (what < 6)
        branch(depth);
      else if (what < 7)
        loop(depth);
      else
        guarded(depth);
    }
  }

  std::mt19937& random_;
  std::vector<std::string> places_;
  std::vector<Callee> callees_;
  std::vector<std::string> handles_;  // instructions that make one
  bool has_input_;
  std::vector<Block> blocks_;
  std::vector<std::string> known_;  // values that may be used here
  int block_ = 0;
  int handler_ = -1;
  int values_ = 0;
  int loops_ = 0;
  int line_ = 0;
};

std::string pou(const std::string& head, const Body& body) {
  return "pou " + head + "\n  local input x : DINT\n  local return r : DINT\n" + body.text();
}

// F and the two `go` call nothing but F; calc and Main call everything before them.
std::string program(uint32_t seed) {
  std::mt19937 random(seed);
  const std::vector<std::string> globals = {"global.g", "global.h", "global.z"};
  const auto with = [](std::vector<std::string> list, std::initializer_list<const char*> more) {
    list.insert(list.end(), more.begin(), more.end());
    return list;
  };
  const std::vector<std::string> own = {"load u64 global.ref", "this u64"};
  const Callee f = {"F", "call F"};
  const Callee go = {"Base.go", "call_virtual 'Base.go'", true};
  const std::vector<std::string> result = with(globals, {"local.r"});
  std::string pous = pou("function F", Body(random, result, {}, {}, true));
  pous += pou("method 'Base.go' self Base", Body(random, with(result, {"self.n"}), {f}, own, true));
  pous += pou("method 'Mid.go' self Mid",
              Body(random, with(result, {"self.n", "self.m"}), {f}, own, true));
  pous += pou("method 'Base.calc' self Base",
              Body(random, with(result, {"self.n"}), {f, go, {"Base.go", "call_method 'Base.go'"}},
                   own, true));
  const std::vector<std::string> handles = {"load u64 global.ref", "handle u64 self.base",
                                            "handle u64 self.leaf", "handle u64 self.mid"};
  const Body main(random,
                  with(globals, {"self.base!.n", "self.mid!.m", "self.leaf!.n", "self.leaf!.k"}),
                  {f,
                   go,
                   {"Base.calc", "call_method 'Base.calc', self.leaf"},
                   {"Base.calc", "call_method 'Base.calc'", true},
                   {"Mid.go", "call_method 'Mid.go', self.mid"}},
                  handles, false);
  return "program P\ntype G = globals\n  member global g : DINT\n  member global h : DINT\n"
         "  member global z : DINT\n  member global kinds : DINT\n  member global ref : ULINT\n"
         "type Base = function_block\n  member local n : DINT\n"
         "type Mid = function_block extends Base\n  member local n : DINT\n"
         "  member local m : DINT\n"
         "type Leaf = function_block extends Mid\n  member local n : DINT\n"
         "  member local m : DINT\n  member local k : DINT\n"
         "type Main = program\n  member local base : Base\n  member local mid : Mid\n"
         "  member local leaf : Leaf\nglobals G\ntask T period 1000000 priority 0\n"
         "instance Main : Main task 0\noverride Base : 'Base.go' = 'Base.go'\n"
         "override Mid : 'Base.go' = 'Mid.go'\noverride Leaf : 'Base.go' = 'Mid.go'\n" +
         pous + linker::empty_pou("function_block", "Base") +
         linker::empty_pou("function_block", "Mid") + linker::empty_pou("function_block", "Leaf") +
         "pou program Main self Main\n" + main.text();
}

TEST(RandomTries, InterpreterAndEvaluatorAgree) {
  uint32_t trapped = 0;
  uint32_t caught = 0;
  for (uint32_t seed = 1; seed <= 120 && !HasFailure(); ++seed) {
    const std::string text = program(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Rig rig(text);
    for (int scan = 0; scan < 3 && !HasFailure(); ++scan) trapped += rig.scan().empty() ? 0 : 1;
    caught += rig.value("kinds") == "0" ? 0 : 1;
    if (HasFailure()) std::printf("%s\n", text.c_str());
  }
  // Neither does every scan end with a trap, nor is nothing caught.
  EXPECT_GT(trapped, 30u);
  EXPECT_LT(trapped, 330u);
  EXPECT_GT(caught, 60u);
}

}  // namespace
}  // namespace references
