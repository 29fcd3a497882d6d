#include "tools/stvm/condition_parse.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>

#include "base/joined.h"

namespace stvm {
namespace {

using Op = ConditionOp;

constexpr size_t kMostNesting = 24;  // of parentheses, calls and signs

// Names may have letters of UTF-8.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

struct Operator {
  std::string_view text;
  Op op;
  int rank;  // higher binds closer
};
// Longer ones before those that they begin with.
constexpr Operator kOperators[] = {
    {"OR", Op::kOr, 1},           {"XOR", Op::kXor, 2},     {"AND", Op::kAnd, 3},
    {"&", Op::kAnd, 3},           {"<>", Op::kNotEqual, 4}, {"<=", Op::kLessEqual, 5},
    {">=", Op::kGreaterEqual, 5}, {"=", Op::kEqual, 4},     {"<", Op::kLess, 5},
    {">", Op::kGreater, 5},       {"+", Op::kAdd, 6},       {"-", Op::kSubtract, 6},
    {"*", Op::kMultiply, 7},      {"/", Op::kDivide, 7},    {"MOD", Op::kModulo, 7},
};

class ConditionParser {
 public:
  ConditionParser(const std::string& text, std::vector<std::string>& names)
      : text_(text), names_(names) {}

  bool run() {
    expression(1);
    blanks();
    if (error_.empty() && at_ < text_.size()) fail("an operator is wanted here");
    return error_.empty();
  }
  std::vector<ConditionStep> take() { return std::move(steps_); }
  size_t at() const { return failed_at_; }
  const std::string& error() const { return error_; }

 private:
  char peek(size_t more = 0) const { return at_ + more < text_.size() ? text_[at_ + more] : '\0'; }
  void fail(std::string what) {
    if (!error_.empty()) return;
    error_ = std::move(what);
    failed_at_ = at_;
  }
  void blanks() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }
  bool take_symbol(char symbol) {
    blanks();
    if (peek() != symbol) return false;
    ++at_;
    return true;
  }
  void want(char symbol) {
    if (!take_symbol(symbol)) fail(std::string("`") + symbol + "` is wanted here");
  }
  void step(Op op, uint64_t operand = 0) {
    if (steps_.size() == kMostConditionSteps) fail("the condition is too long");
    steps_.push_back({op, operand});
  }
  // A word as a whole, without case.
  bool is_next(std::string_view word) const {
    for (size_t i = 0; i < word.size(); ++i) {
      if (upper(peek(i)) != word[i]) return false;
    }
    const bool goes_on = is_letter(peek(word.size())) || is_digit(peek(word.size()));
    return !is_letter(word[0]) || !goes_on;
  }
  const Operator* operator_here(int least) {
    blanks();
    for (const Operator& one : kOperators) {
      if (is_next(one.text)) return one.rank >= least ? &one : nullptr;
    }
    return nullptr;
  }

  void expression(int least) {
    operand();
    while (error_.empty()) {
      const Operator* const found = operator_here(least);
      if (found == nullptr) return;
      at_ += found->text.size();
      expression(found->rank + 1);
      step(found->op);
    }
  }

  void operand() {
    if (++nesting_ > kMostNesting) fail("the condition is nested too deeply");
    blanks();
    if (!error_.empty()) return;
    if (take_symbol('(')) {
      expression(1);
      want(')');
    } else if (take_symbol('-')) {
      operand();
      step(Op::kNegate);
    } else if (take_symbol('+')) {
      operand();
    } else if (is_next("NOT")) {
      at_ += 3;
      operand();
      step(Op::kNot);
    } else if (is_digit(peek())) {
      number();
    } else if (is_letter(peek())) {
      name_or_call();
    } else {
      fail("a variable, a number or `(` is wanted here");
    }
    --nesting_;
  }

  void number() {
    const size_t begin = at_;
    std::string digits;
    bool real = false;
    while (is_digit(peek()) || peek() == '_' || (peek() == '.' && is_digit(peek(1)))) {
      real = real || peek() == '.';
      if (peek() != '_') digits += peek();
      ++at_;
    }
    const bool exponent = upper(peek()) == 'E';
    if (exponent) {
      digits += text_[at_++];
      if (peek() == '+' || peek() == '-') digits += text_[at_++];
      while (is_digit(peek())) digits += text_[at_++];
    }
    const char* const end = digits.data() + digits.size();
    double value = 0;
    int64_t whole = 0;
    const auto read = real || exponent ? std::from_chars(digits.data(), end, value)
                                       : std::from_chars(digits.data(), end, whole);
    if (read.ec != std::errc() || read.ptr != end || is_letter(peek()) || peek() == '#') {
      at_ = begin;
      return fail("a number is wanted here, such as 12 or 0.95");
    }
    if (real || exponent) return step(Op::kReal, std::bit_cast<uint64_t>(value));
    step(Op::kInteger, static_cast<uint64_t>(whole));
  }

  // "Line.Filler[2].Count"
  std::string path() {
    std::string out;
    blanks();
    while (is_letter(peek()) || is_digit(peek()) || peek() == '.' || peek() == '[' ||
           peek() == ']' || peek() == ',' || peek() == '%') {
      if (peek() == ',' &&
          std::count(out.begin(), out.end(), '[') == std::count(out.begin(), out.end(), ']')) {
        break;
      }
      out += text_[at_++];
    }
    return out;
  }

  void variable(Op op, const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    const auto number = static_cast<uint64_t>(found - names_.begin());
    if (found == names_.end()) names_.push_back(name);
    if (names_.size() > kMostConditionNames) fail("the conditions name too many variables");
    step(op, number);
  }

  void name_or_call() {
    const size_t begin = at_;
    const std::string name = path();
    std::string called = name;
    std::transform(called.begin(), called.end(), called.begin(), upper);
    if (called == "TRUE" || called == "FALSE") return step(Op::kBool, called == "TRUE");
    if (!take_symbol('(')) return variable(Op::kVariable, name);
    if (called == "BASELINE") {
      blanks();
      if (!is_letter(peek())) return fail("baseline() takes a variable");
      variable(Op::kBaseline, path());
      return want(')');
    }
    const bool two = called == "MIN" || called == "MAX";
    if (!two && called != "ABS") {
      at_ = begin;
      return fail("`" + name + "` cannot be called here: only ABS, MIN, MAX and baseline can");
    }
    expression(1);
    if (two) {
      want(',');
      expression(1);
    }
    want(')');
    step(called == "ABS" ? Op::kAbs : called == "MIN" ? Op::kMin : Op::kMax);
  }

  const std::string& text_;
  std::vector<std::string>& names_;
  std::vector<ConditionStep> steps_;
  size_t at_ = 0;
  size_t failed_at_ = 0;
  size_t nesting_ = 0;
  std::string error_;
};

}  // namespace

base::Status add_condition(const std::string& text, GuardOrder& order, size_t& at) {
  at = 0;
  if (order.conditions.size() == kMostConditions) {
    return base::Error{base::Refusal::kBadValue, "there are too many conditions"};
  }
  std::vector<std::string> names = order.names;
  ConditionParser parser(text, names);
  if (!parser.run()) {
    at = parser.at();
    return base::Error{base::Refusal::kBadValue, parser.error()};
  }
  order.names = std::move(names);
  order.conditions.push_back({text, parser.take()});
  return base::Ok{};
}

}  // namespace stvm
