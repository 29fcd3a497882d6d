// The front end as one function: sources -> typed program in IR form. The passes
// are parse (parse/), declarations, types, constants and bodies (sema/), and
// lowering to IR (lower/).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/limits.h"
#include "base/source.h"
#include "frontend/dialect.h"
#include "ir/program/ir.h"

namespace frontend {

class Coverage;  // coverage.h

struct CompileOptions {
  Dialect dialect = Dialect::kCodesys;
  std::string name = "project";    // used when there is no CONFIGURATION
  std::string resource;            // of several; empty: the first
  base::SourceSpan resource_at{};  // where a file of settings says it
  std::string likely_resource;     // instead of the first, if there is one of that name
  // Conditional compilation: NAME or NAME=VALUE, as if {define NAME 'VALUE'} headed each file.
  std::vector<std::string> defines;
  bool strict_strings = false;  // LEFT, MID, INSERT, ... out of range trap, instead of being cut
  uint64_t max_source_bytes = base::kMaxSourceBytes;  // tests ask for less
  Coverage* coverage = nullptr;  // gets the places, and code counts; null: no such code
  bool tests = false;            // Resident: TEST blocks run, not what the project runs
};

struct Tree;
// Every file of `sources`; conditions see the declarations of all of them.
void parse_all(const base::SourceMap& sources, const CompileOptions& options, Tree& tree,
               base::Diagnostics& diagnostics);

// All files of `sources` are one project; the standard function blocks (ST, from
// stdlib) that it uses are compiled along. nullopt when any error was reported.
// Without a CONFIGURATION: one task of 10 ms; every PROGRAM type runs once in it,
// under its own name, in source order.
std::optional<ir::Program> compile(const base::SourceMap& sources, const CompileOptions& options,
                                   base::Diagnostics& diagnostics);

// Every RESOURCE of the CONFIGURATION as a program of its own, or only the one that the options
// name; they are checked against each other in any case.
struct ResourceProgram {
  std::string resource;  // "" where the project has one at most
  base::SourceSpan declared;
  ir::Program program;
  std::vector<bool> other_code = {};  // by PouId: only other resources can reach it; may be empty
};
struct Resources {
  std::vector<std::string> names;  // of all; none where the project has one at most
  std::vector<ResourceProgram> programs;
};
std::optional<Resources> compile_resources(const base::SourceMap& sources,
                                           const CompileOptions& options,
                                           base::Diagnostics& diagnostics);

// TEST blocks (docs/UNIT-TESTS.md), made into one program each; the
// project's own tasks and programs do not run.
struct TestCase {
  std::string name;  // as written, without quotes
  std::string file;
  uint32_t line = 0;
  std::string instance;  // the program instance that is this test
};
struct TestProgram {
  ir::Program program;
  std::vector<TestCase> cases;  // in source order
};
// The STRING global that a failed assertion leaves its message in.
inline constexpr const char* kTestMessage = "__TEST_MESSAGE";
// Around a value in it that stc test makes a literal of: begin, the sort, the text, end. Sorts: a
// quotation mark, or how many digits a bit string has, modulo 16.
inline constexpr char kTestValueBegin = '\x0e';
inline constexpr char kTestValueEnd = '\x0f';
// The BOOL global that a test sets behind its SETUP when it has a TEARDOWN: its instance is then
// run once more, whatever has ended it, and TEARDOWN is all that this run does.
inline constexpr const char* kTestTeardown = "__TEST_TEARDOWN";
std::optional<TestProgram> compile_tests(const base::SourceMap& sources,
                                         const CompileOptions& options,
                                         base::Diagnostics& diagnostics);

}  // namespace frontend
