// One compilation, kept to be asked. It goes as far as the sources allow: mistakes are messages,
// and what could be understood can be asked for. The resident front end (frontend/resident.h) keeps
// one over edits; this is for who asks once.
#pragma once

#include <memory>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/compile.h"

namespace frontend {

class Sema;
struct Parsed;

namespace questions {

class Compilation {
 public:
  // Of several RESOURCEs it looks at that of `options`, else at the first.
  Compilation(const base::SourceMap& sources, const CompileOptions& options);
  ~Compilation();
  Compilation(const Compilation&) = delete;
  Compilation& operator=(const Compilation&) = delete;

  // Null: there is nothing to be understood (too much text, a comment without an end).
  Sema* sema() { return sema_.get(); }
  const base::Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  CompileOptions options_;
  base::Diagnostics diagnostics_;
  std::unique_ptr<Parsed> parsed_;
  std::unique_ptr<Sema> sema_;
};

}  // namespace questions
}  // namespace frontend
