#include "tests/differential/golden_text.h"

namespace differential {
namespace {

std::string heading(const std::string& mode, uint64_t seed, const Finding& finding) {
  return "// MODE: " + mode + "\n// Random program " + std::to_string(seed) +
         ", shrunk: " + finding.text.substr(0, finding.text.find('\n')) + "\n";
}

std::string options_of(const Build& build) {
  const std::string dialect = build.dialect == "codesys" ? "" : " --dialect " + build.dialect;
  return dialect + " --passes " + build.passes;
}

}  // namespace

std::string run_text(const std::string& source, uint64_t seed, const Finding& finding, int scans,
                     const Build& build) {
  std::string last = std::to_string(finding.scan != 0 ? static_cast<int>(finding.scan) : scans);
  std::string text = heading("run --scans " + last + options_of(build), seed, finding) + source;
  if (!finding.expected.empty()) text += "// CHECK:SCAN " + last + ": " + finding.expected + "\n";
  return text;
}

std::string change_text(const std::string& first, const std::string& second, uint64_t seed,
                        const Finding& finding, const ChangeScript& script,
                        const Build& build) {
  std::string text =
      heading("change" + options_of(build), seed, finding) + first + "// --- v2\n" + second;
  text += "// > run " + std::to_string(script.scans_before) + "\n// > change 2 --allow-loss\n";
  if (script.scans_after > 0) text += "// > run " + std::to_string(script.scans_after) + "\n";
  if (finding.key.starts_with("undo")) text += "// > undo\n";
  size_t equals = finding.expected.find('=');
  if (equals != std::string::npos) {
    text += "// > show " + finding.expected.substr(0, equals) + "\n// CHECK: " + finding.expected +
            "\n";
  }
  return text;
}

}  // namespace differential
