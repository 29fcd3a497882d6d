// stc: the compiler's command line.
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "frontend/dialect.h"
#include "tools/stc/commands.h"

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

// A compilation allocates more and more and then ends: giving memory back between, and gathering
// freed pieces for that, is a tenth of its time.
void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_MXFAST, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TOP_PAD, 16 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  const tools::Entry* const entries[] = {&stc::kCheck, &stc::kBuild,   &stc::kTest,   &stc::kFormat,
                                         &stc::kDiff,  &stc::kPackage, &stc::kImport, &stc::kExport,
                                         &stc::kDraw,  &stc::kDump,    &stc::kExplain};
  return tools::dispatch("stc", "Compiles IEC 61131-3 programs to images for stvm.", entries, argc,
                         argv, dialects());
}
