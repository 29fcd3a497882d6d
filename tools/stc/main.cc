// stc: the compiler's command line.
#include "tools/stc/commands.h"

int main(int argc, char** argv) {
  const tools::Entry* const entries[] = {&stc::kCheck,   &stc::kBuild, &stc::kDiff,
                                         &stc::kPackage, &stc::kDump,  &stc::kExplain};
  return tools::dispatch("stc", "Compiles IEC 61131-3 programs to images for stvm.", entries, argc,
                         argv);
}
