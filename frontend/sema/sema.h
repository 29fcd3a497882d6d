// Meaning of a syntax tree: names, types, constants, initial values, interfaces.
// Sema owns the program under construction and everything known about the tree;
// lowering asks it about expressions. Order of declarations never matters:
// whatever is asked for is resolved on the spot, and circles are reported.
//
// One instance serves one compilation. Every problem is reported once to the
// sink; what cannot be resolved has an invalid id and silences follow-ups.
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/sema/callee.h"
#include "frontend/sema/constant.h"
#include "frontend/sema/declarations.h"
#include "frontend/sema/facts.h"
#include "frontend/sema/namespaces.h"
#include "frontend/sema/objects.h"
#include "frontend/sema/pools.h"
#include "frontend/sema/reporter.h"
#include "frontend/sema/start_values.h"
#include "ir/types/layout.h"

namespace frontend {

enum class Purpose : uint8_t { kRun, kTest };

// Store: a build for tests.
struct Tests {
  std::vector<TestCase> cases;
  uint32_t message = 0;  // member of the globals that takes the message of a failed assertion
  std::vector<MockBody> mock_bodies;
};

class Sema {
 public:
  // Files from `library_file` on are the standard library, the others the project; and so are those
  // that come later.
  Sema(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
       const CompileOptions& options, Purpose purpose, base::Diagnostics& diagnostics);

  void mark_used(VarId id);
  void mark_written(VarId id);
  bool for_tests() const { return purpose == Purpose::kTest; }
  bool in_test() const { return scope_.pou != nullptr && scope_.pou->test; }

  // --- variables and members (variables.cc)
  const Variable& resolve(VarId id);

  // --- expressions (infer*.cc)
  const Note& infer(ExprId expr);

  // --- messages, from the scope that is looked at
  void error(DiagnosticCode code, base::SourceSpan span, std::string text, Fix fix = {}) {
    report.error(scope_, code, span, std::move(text), std::move(fix));
  }
  void warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix = {}) {
    report.warning(code, span, std::move(text), std::move(fix));
  }
  bool allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
    return report.allow_narrowing(scope_, from, to, span);
  }
  void allow_extension(std::string_view what, base::SourceSpan span, std::string fix = {}) {
    report.allow_extension(scope_, what, span, std::move(fix));
  }

  // A phase, for the scope that is looked at.
  template <class Wanted>
  Wanted ask() {
    return Wanted(*this, scope_);
  }

  // The POU whose names are visible; set while anything of it is resolved.
  class Within {
   public:
    Within(Sema& sema, uint32_t pou);
    ~Within();
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

   private:
    Sema& sema_;
    PouScope saved_;
  };

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
  Reporter report;
  BodyLog* log = nullptr;  // of the body that is lowered, where somebody keeps one
  Objects objects{*this};
  StartValues start_values{*this};
  Namespaces namespaces{*this};
  Pools pools{*this};

  PouScope scope_;  // whose names are visible
};

}  // namespace frontend
