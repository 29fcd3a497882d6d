// Phase: what a build for tests adds. TEST blocks become programs (test_cases.cc); functions and
// blocks get what mocks need (mocks.cc). Reads the tree; writes declarations, `Sema::tests` and the
// program's globals.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class TestBuild : public Phase {
 public:
  using Phase::Phase;

  // test_cases.cc
  void collect_tests();
  void configure_tests();
  void add_test_globals();
  void add_mock_members(PouInfo& info, std::vector<ir::Member>& members);
  std::vector<const PouInfo*> mocked_functions() const;
  bool mock_applies(uint32_t pou, const PouDecl& test) const;  // a MOCK_FUNCTION's body

 private:
  void collect_test(const PouDecl& test);
  void add_function_mock(std::string_view name, base::SourceSpan span);
  void add_mock_body(const PouDecl& decl, bool inside_test);
  void resolve_mock_bodies();
  void check_mock_body(const PouDecl& decl, const PouInfo& mock, const PouInfo& function);
};

}  // namespace frontend
