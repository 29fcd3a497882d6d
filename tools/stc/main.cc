// stc: the compiler's command line.
#include "frontend/dialect.h"
#include "tools/common/heap.h"
#include "tools/stc/commands.h"
#include "tools/stc/memory_budget.h"

namespace {

std::string dialects() {
  std::string text =
      "\nDialects, for --dialect NAME or `dialect = \"NAME\"` in stc.toml; `stc explain dialects` "
      "says\n"
      "what each changes:\n\n";
  for (const frontend::DialectRow& row : frontend::dialect_rows()) {
    std::string name(row.name);
    name.resize(11, ' ');
    text += "  " + name + std::string(row.what) + "\n";
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  tools::keep_freed_memory();
  stc::limit_memory();
  const tools::Entry* const entries[] = {&stc::kCheck, &stc::kBuild,   &stc::kTest,   &stc::kFormat,
                                         &stc::kDiff,  &stc::kPackage, &stc::kImport, &stc::kExport,
                                         &stc::kDraw,  &stc::kDump,    &stc::kSource,
                                         &stc::kExplain};
  return tools::dispatch("stc", "Compiles IEC 61131-3 programs to images for stvm.", entries, argc,
                         argv, dialects());
}
