// Compiles snippets, checks the IR, runs it in the evaluator.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/compile.h"
#include "ir/program/evaluate.h"

namespace frontend_test {

struct Compiled {
  std::optional<ir::Program> program;
  std::vector<base::Diagnostic> messages;
  std::string text;  // rendered, for failures

  bool has(std::string_view code) const;
  // The only error's code, or a list of all of them.
  std::string errors() const;
  std::string warnings() const;
};

Compiled compile(std::string source, frontend::Dialect dialect = frontend::Dialect::kCodesys);
Compiled compile_files(std::vector<std::string> files);

// "PROGRAM P VAR <vars> END_VAR <body> END_PROGRAM", one scan each 10 ms.
class Controlled {
 public:
  explicit Controlled(const std::string& source);
  Controlled(const std::string& vars, const std::string& body)
      : Controlled("PROGRAM P\nVAR " + vars + " END_VAR\n" + body + "\nEND_PROGRAM\n") {}
  // Runs scans; returns the name of the first trap, or "".
  std::string scan(int count = 1);
  // "P.x" as a signed number; strings by text().
  int64_t number(const std::string& path);
  double real(const std::string& path);  // REAL
  double lreal(const std::string& path);
  std::string text(const std::string& path);
  void set(const std::string& path, int64_t value);
  const std::string& problem() const { return problem_; }

 private:
  Compiled compiled_;
  std::unique_ptr<ir::Evaluator> evaluator_;
  int64_t now_ = 0;
  std::string problem_;
};

}  // namespace frontend_test
