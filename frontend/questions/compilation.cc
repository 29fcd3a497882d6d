#include "frontend/questions/compilation.h"

#include "frontend/analysis.h"

namespace frontend::questions {

Compilation::Compilation(const base::SourceMap& sources, const CompileOptions& options)
    : options_(options),
      parsed_(parse_project(sources, options_, LibraryExtent::kWhole, diagnostics_)) {
  if (parsed_ == nullptr) return;
  sema_ = std::make_unique<Sema>(parsed_->sources, parsed_->tree, parsed_->library_file, options_,
                                 options_.tests ? Purpose::kTest : Purpose::kRun, diagnostics_);
  declare_all(*sema_);
  for (uint32_t pou = 0; pou < sema_->declared.pous.size(); ++pou) lower_body(*sema_, pou);
  check_whole(*sema_);
}

Compilation::~Compilation() = default;

}  // namespace frontend::questions
