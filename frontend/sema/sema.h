// What is known of one compilation: the stores that phases (phase.h) and lowering read and write,
// and the program under construction. It resolves nothing itself. Order of declarations never
// matters: phases resolve what is asked for on the spot, and report circles.
//
// One instance serves one compilation. Every problem is reported once to the
// sink; what cannot be resolved has an invalid id and silences follow-ups.
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/sema/constants/constant.h"
#include "frontend/sema/constants/start_values.h"
#include "frontend/sema/declarations.h"
#include "frontend/sema/declarations/namespaces.h"
#include "frontend/sema/facts.h"
#include "frontend/sema/reporter.h"
#include "ir/types/layout.h"

namespace frontend {

enum class Purpose : uint8_t { kRun, kTest };

// Store: a build for tests.
struct Tests {
  std::vector<TestCase> cases;
  // Members of the globals: kTestMessage, kTestTeardown (frontend/compile.h).
  uint32_t message = 0;
  uint32_t teardown = 0;
  std::vector<MockBody> mock_bodies;
};

class Sema {
 public:
  // Files from `library_file` on are the standard library, the others the project; and so are those
  // that come later.
  Sema(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
       const CompileOptions& options, Purpose purpose, base::Diagnostics& diagnostics);

  // Code reads or calls the variable; code writes it, or takes its address.
  void mark_used(VarId id);
  void mark_written(VarId id);
  bool for_tests() const { return purpose == Purpose::kTest; }

  const base::SourceMap& sources;
  const Tree& tree;
  const CompileOptions& options;
  const Purpose purpose;
  ir::Program program;
  // Stores, which report nothing.
  Declarations declared;
  Library library;
  Facts facts;
  Addresses addresses;
  Tests tests;
  Pooled pools;
  Started started;
  Reporter report;
  BodyLog* log = nullptr;  // of the body that is lowered, where somebody keeps one
  StartValues start_values{*this};
  Namespaces namespaces{*this};
};

}  // namespace frontend
