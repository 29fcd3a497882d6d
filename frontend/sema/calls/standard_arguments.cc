// Arguments of standard functions: positional, or by the names in the registry.
#include <algorithm>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// A parameter of "G IN0 IN1", "K IN0+" or "IN YEAR> MONTH>".
struct Parameter {
  int32_t position = -1;  // -1: none
  bool output = false;
};

// "IN1+" is IN1, IN2, ...: how far `name` is after the first; -1: another name.
int32_t number_behind(std::string_view word, std::string_view name) {
  std::string_view stem = word.substr(0, word.size() - 2);
  if (name.size() <= stem.size() || name.size() > stem.size() + 3 ||
      !ir::same_name(name.substr(0, stem.size()), stem)) {
    return -1;
  }
  int32_t number = 0;
  for (char c : name.substr(stem.size())) {
    if (c < '0' || c > '9') return -1;
    number = number * 10 + (c - '0');
  }
  return number - (word[word.size() - 2] - '0');
}

// The parameter of that name, or at that position when the name is empty.
Parameter find_parameter(std::string_view parameters, std::string_view name, int32_t position) {
  int32_t at = 0;
  for (; !parameters.empty(); ++at) {
    std::string_view word = parameters.substr(0, parameters.find(' '));
    parameters.remove_prefix(std::min(parameters.size(), word.size() + 1));
    if (word.back() == '+') {
      int32_t behind = name.empty() ? position - at : number_behind(word, name);
      return behind < 0 ? Parameter{} : Parameter{at + behind, false};
    }
    bool output = word.back() == '>';
    if (output) word.remove_suffix(1);
    if (name.empty() ? at == position : ir::same_name(word, name)) return {at, output};
  }
  return {};
}

std::string count_text(const stdlib::FunctionRow& row) {
  if (row.most == row.fewest) return std::to_string(row.fewest);
  if (row.most == 0) return "at least " + std::to_string(row.fewest);
  return std::to_string(row.fewest) + " to " + std::to_string(row.most);
}

}  // namespace

std::vector<ExprId> StandardCalls::standard_arguments(const Expr& call,
                                                      const stdlib::FunctionRow& row) {
  bool unlimited = row.most == 0 && row.fewest != 0;
  std::vector<const Arg*> args = ask<Calls>().plain_arguments(call, nullptr);
  if (args.size() < row.fewest || (!unlimited && args.size() > row.most)) {
    error(DiagnosticCode::kWrongArgumentCount, call.span,
          std::string(row.name) + " with " + std::to_string(args.size()) + " arguments",
          "it takes " + count_text(row) + ": " + std::string(row.signature));
    return {};
  }
  std::vector<ExprId> ordered(unlimited ? args.size() : row.most);
  for (uint32_t i = 0; i < args.size(); ++i) {
    if (!standard_argument(*args[i], row, i, ordered)) return {};
  }
  if (!ordered.empty() && !ordered[0].valid()) {
    error(DiagnosticCode::kWrongArgumentCount, call.span, "the input is missing",
          "its parameters are " + std::string(row.parameters));
    return {};
  }
  return ordered;
}

bool StandardCalls::standard_argument(const Arg& arg, const stdlib::FunctionRow& row,
                                      uint32_t number, std::vector<ExprId>& ordered) {
  std::string_view name = arg.name.text;
  if (sema_.options.dialect != Dialect::kIec) {
    const std::string_view meant = stdlib::other_name(row.name, name);
    if (!meant.empty()) name = meant;
  }
  Parameter parameter = find_parameter(row.parameters, name, static_cast<int32_t>(number));
  auto at = static_cast<uint32_t>(parameter.position);
  if (parameter.position < 0 || at >= ordered.size()) {
    error(DiagnosticCode::kUnknownParameter, arg.span,
          std::string(row.name) + " has no parameter `" + std::string(arg.name.text) + "` here",
          "its parameters are " + std::string(row.parameters));
    return false;
  }
  bool open_output = parameter.output && !arg.value.valid();
  if ((!arg.name.empty() && arg.output != parameter.output) ||
      (!arg.value.valid() && !open_output)) {
    error(DiagnosticCode::kWrongDirection, arg.span,
          parameter.output ? "this parameter is an output" : "this parameter is an input",
          parameter.output ? "write `=>`" : "write `:=` and a value");
    return false;
  }
  if (ordered[at].valid()) {
    error(DiagnosticCode::kDuplicateArgument, arg.span, "this parameter is given twice");
    return false;
  }
  ordered[at] = arg.value;
  return true;
}

}  // namespace frontend
