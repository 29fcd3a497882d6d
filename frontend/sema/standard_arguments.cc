// Arguments of standard functions: positional, or by the names in the registry.
#include <algorithm>

#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// Position of parameter `name` in "G IN0 IN1" or "K IN0+"; -1 when there is none.
int32_t position_of(std::string_view parameters, std::string_view name) {
  int32_t position = 0;
  while (!parameters.empty()) {
    std::string_view word = parameters.substr(0, parameters.find(' '));
    parameters.remove_prefix(std::min(parameters.size(), word.size() + 1));
    if (ir::same_name(word, name)) return position;
    if (word.back() == '+') {  // "IN1+": the number says which
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
      int32_t offset = number - (word[word.size() - 2] - '0');
      return offset < 0 ? -1 : position + offset;
    }
    ++position;
  }
  return -1;
}

std::string count_text(const stdlib::FunctionRow& row) {
  if (row.most == 0 && row.fewest != 0) return "at least " + std::to_string(row.fewest);
  return std::to_string(row.fewest);
}

}  // namespace

std::vector<ExprId> Sema::standard_arguments(const Expr& call, const stdlib::FunctionRow& row) {
  bool unlimited = row.most == 0 && row.fewest != 0;
  if (call.args.count < row.fewest || (!unlimited && call.args.count > row.most)) {
    error(DiagnosticCode::kWrongArgumentCount, call.span,
          std::string(row.name) + " with " + std::to_string(call.args.count) + " arguments",
          "it takes " + count_text(row) + ": " + std::string(row.signature));
    return {};
  }
  std::vector<ExprId> ordered(call.args.count);
  for (uint32_t i = 0; i < call.args.count; ++i) {
    const Arg& arg = tree.args[call.args.first + i];
    if (!arg.value.valid() || arg.output) {
      error(DiagnosticCode::kWrongDirection, arg.span, "this function has inputs only");
      return {};
    }
    int32_t at =
        arg.name.empty() ? static_cast<int32_t>(i) : position_of(row.parameters, arg.name.text);
    if (at < 0 || at >= static_cast<int32_t>(ordered.size())) {
      error(DiagnosticCode::kUnknownParameter, arg.span,
            std::string(row.name) + " has no parameter `" + std::string(arg.name.text) + "` here",
            "its parameters are " + std::string(row.parameters));
      return {};
    }
    if (ordered[static_cast<uint32_t>(at)].valid()) {
      error(DiagnosticCode::kDuplicateArgument, arg.span, "this parameter is given twice");
      return {};
    }
    ordered[static_cast<uint32_t>(at)] = arg.value;
  }
  return ordered;
}

}  // namespace frontend
