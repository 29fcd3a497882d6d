// Runs the script of a golden file on one engine and gives its transcript.
#pragma once

#include "tests/golden/runner/engine.h"
#include "tests/golden/runner/test_file.h"

namespace golden {

// What `show` and SCAN say of a name that the program does not have.
inline constexpr const char* kNoSuchVariable = "(no such variable)";

struct Transcript {
  std::vector<std::vector<std::string>> outputs;  // parallel to TestFile::steps
  std::vector<std::string> scans;                 // parallel to TestFile::scans
  std::vector<std::string> states;                // after every scan of mode run
};

// Mode run: --scans N scans (0: none), then the script. Mode change: the script.
base::Result<Transcript> run_script(const TestFile& test, const std::vector<Program>& versions,
                                    Engine& engine);

}  // namespace golden
