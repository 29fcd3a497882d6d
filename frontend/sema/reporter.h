// Says what is wrong, for every phase of sema and for lowering: each mistake once, nothing of the
// library, and by the rules of the dialect. It reads the stores and writes messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"
#include "frontend/sema/declarations.h"
#include "frontend/sema/follow_ups.h"
#include "frontend/sema/library.h"

namespace frontend {

using base::DiagnosticCode;

// Is it the type of an interface variable?
bool is_interface(const ir::TypeTable& types, ir::TypeId type);

class Reporter {
 public:
  Reporter(const base::SourceMap& sources, const Tree& tree, const CompileOptions& options,
           const ir::Program& program, const Declarations& declared, const Library& library,
           base::Diagnostics& diagnostics);

  // `scope`: whose names were visible there.
  void error(const PouScope& scope, DiagnosticCode code, base::SourceSpan span, std::string text,
             Fix fix = {});
  void warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix = {},
               std::vector<base::DiagnosticNote> notes = {});
  // Reports an implicit conversion that may lose; false when the dialect forbids it.
  bool allow_narrowing(const PouScope& scope, ir::TypeId from, ir::TypeId to,
                       base::SourceSpan span);
  // Reports what only real sources have where the dialect is the standard's own.
  void allow_extension(const PouScope& scope, std::string_view what, base::SourceSpan span,
                       std::string fix = {});
  std::string conversion_fix(ir::TypeId to) const;
  std::string type_text(ir::TypeId type) const;
  bool has_errors() const { return diagnostics_.has_errors(); }
  // Are there errors that are no warnings made errors?
  bool has_hard_errors() const { return diagnostics_.has_hard_errors(); }
  // While it lives nothing is said: who asks again what was answered has heard the messages.
  class Silence {
   public:
    explicit Silence(Reporter& reporter) : reporter_(reporter) { ++reporter_.silenced_; }
    ~Silence() { --reporter_.silenced_; }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

   private:
    Reporter& reporter_;
  };
  // What was said is to be said again.
  void forget() { follow_ups_.forget(); }

 private:
  base::SourceSpan declared_at(const PouScope& scope, DiagnosticCode code,
                               std::string_view name) const;

  const Tree& tree_;
  const CompileOptions& options_;
  const ir::Program& program_;
  const Declarations& declared_;
  const Library& library_;
  base::Diagnostics& diagnostics_;
  FollowUps follow_ups_;
  uint32_t silenced_ = 0;
};

}  // namespace frontend
