// stc: the compiler's command line.
#include "frontend/dialect.h"
#include "tools/common/heap.h"
#include "tools/stc/commands.h"
#include "tools/stc/memory_budget.h"
#include "tools/stc/run_report.h"
#include "vm/native/available.h"

namespace {

std::string dialects() {
  std::string text =
      "\nDialects, for --dialect NAME or `dialect = \"NAME\"` in stc.toml;\n"
      "`stc explain dialects` says what each changes:\n\n";
  for (const frontend::DialectRow& row : frontend::dialect_rows()) {
    std::string name(row.name);
    name.resize(11, ' ');
    text += "  " + name + std::string(row.what) + "\n";
  }
  return text;
}

std::vector<std::string> adapters() {
  std::vector<std::string> out;
#ifdef STC_HAS_XML
  out = {"xml", "plcopen", "twincat"};
#endif
#ifdef STC_HAS_KEYS
  out.push_back("keys");
#endif
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  tools::keep_freed_memory();
  stc::limit_memory();
  const tools::Entry* const entries[] = {&stc::kCheck,  &stc::kBuild,   &stc::kTest,  &stc::kFormat,
                                         &stc::kDiff,   &stc::kPackage, &stc::kFleet, &stc::kImport,
                                         &stc::kExport, &stc::kDraw,    &stc::kDump,  &stc::kSource,
                                         &stc::kXref,   &stc::kExplain, &stc::kKey};
  const tools::Tool tool{"stc",
                         "Compiles IEC 61131-3 programs to images for stvm.",
                         entries,
                         {tools::image_formats(),
                          {"adapters", tools::VersionFact::kTexts, adapters()},
                          tools::native_tier(vm::native::is_available())},
                         dialects(),
                         {{"json", stc::refusal_json},
                          {"sarif", stc::refusal_sarif},
                          {"github", stc::refusal_github}}};
  return tools::dispatch(tool, argc, argv);
}
