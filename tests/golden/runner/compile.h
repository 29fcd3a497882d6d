// Compiling one version of a golden file, in process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/source.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "ir/bytecode/verify.h"
#include "ir/program/ir.h"
#include "tests/golden/runner/state_texts.h"
#include "tests/golden/runner/test_file.h"

namespace golden {

struct Program {
  ir::Program program;  // as the front end made it: what the evaluator runs
  ir::Program optimised;
  std::vector<ir::Object> objects;  // of `optimised`
  // Of a link without a base, which every tier begins with: made once.
  mutable std::optional<ir::VerifiedImage> cold;
  mutable StateTexts states;
};

// Diagnostics as "line:column: error[E3001]: text", sorted.
struct Outcome {
  std::vector<std::string> messages;
  bool errors = false;
};

std::vector<std::string> messages_of(const base::SourceMap& sources, base::Diagnostics& diagnostics,
                                     bool with_help = false);

base::Result<Program> compile(const TestFile& test, size_t version, Outcome& outcome);
base::Result<ir::VerifiedImage> link(const Program& program, const ir::Image* base, bool move_all);
// Tokens or tree of version 1, as text.
std::string tokens_of(const TestFile& test);
std::string tree_of(const TestFile& test, Outcome& outcome);

}  // namespace golden
