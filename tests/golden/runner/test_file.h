// A golden file: sources of one or more versions, and what is expected of them,
// in one text (docs/TESTING.md has the format).
//
//   // MODE: run [--scans N] [--dialect iec] [--define NAME[=VALUE]]
//   // USE: tests/corpus/date/*.st   more sources of every version, from the root of the repository
//   ...source...
//   // --- v2 [--dialect iec]   begins the next version (mode change)
//   // > run 3            script: run N | show NAMES | set NAME VALUE | change K [--allow-loss] |
//   //                    undo | accept | force NAME VALUE | unforce NAME | forces
//   // CHECK: text        one line of output of what stands above
//   // CHECK:SCAN 2: a=1  short form of `run to scan 2, show a`
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace golden {

struct Step {
  std::string command;                // "run 3"; "" for output before any command
  std::vector<std::string> expected;  // CHECK lines that follow it
  size_t line = 0;                    // of the command, 0-based, in TestFile::lines
};

struct ScanCheck {  // CHECK:SCAN
  uint64_t scan = 0;
  std::vector<std::string> names;
  std::string expected;  // "a=1 b=2"
  size_t line = 0;
};

struct Source {
  std::string name;
  std::string text;
};

struct TestFile {
  std::string path;
  std::string name;  // file name without folder
  std::string mode;
  std::vector<std::string> options;
  std::vector<std::string> lines;
  std::vector<std::string> versions;  // source texts; comment lines stay, so line numbers hold
  std::vector<std::vector<std::string>> version_options;  // go before those of MODE
  std::vector<Source> used;                               // of the USE lines, in their order
  std::vector<Step> steps;                                // steps[0] has no command
  std::vector<ScanCheck> scans;

  bool has_option(const std::string& name) const;
  std::string option(const std::string& name, const std::string& otherwise) const;
  std::string option_of(size_t version, const std::string& name,
                        const std::string& otherwise) const;
};

base::Result<TestFile> read_test(const std::string& path);

// The file with its expectations replaced: `outputs` parallel to steps, `scans` to
// TestFile::scans.
std::string updated(const TestFile& test, const std::vector<std::vector<std::string>>& outputs,
                    const std::vector<std::string>& scans);

}  // namespace golden
