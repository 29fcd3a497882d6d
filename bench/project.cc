// Writes a project of realistic kinds of function blocks, about fifty lines each, and of the
// programs that call them, as many files of 5,000 lines as it takes.
//
//   bench_project FOLDER LINES
//
// Every block differs from others of its kind in names and constants, and has an instance. Prints
// how many lines and function blocks it wrote.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/project_kinds.h"

namespace {

constexpr uint32_t kBlocksOfFile = 98;  // a multiple of the number of kinds
constexpr uint32_t kKinds = sizeof kProjectKinds / sizeof kProjectKinds[0];

class Random {
 public:
  uint32_t below(uint32_t limit) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<uint32_t>((state_ >> 33) % limit);
  }

 private:
  uint64_t state_ = 20261111;
};

// `@`: the number of the block; `$`: a constant of 10 to 209.
std::string filled(const char* text, uint32_t number, Random& random) {
  std::string out;
  for (const char* c = text; *c != '\0'; ++c) {
    if (*c == '@') {
      out += std::to_string(number);
    } else if (*c == '$') {
      out += std::to_string(10 + random.below(200));
    } else {
      out += *c;
    }
  }
  return out;
}

// The program that calls all blocks of a file, with inputs and outputs of its own.
std::string program(uint32_t file, const std::vector<uint32_t>& blocks, Random& random) {
  const std::string area = std::to_string(file);
  std::string out = "VAR_GLOBAL\n";
  uint32_t bit = 0;
  for (const char* name : {"Enable", "Stop", "Reset"}) {
    out += "  Area" + area + "_" + name + " AT %IX" + area + "." + std::to_string(bit++) +
           " : BOOL;\n";
  }
  out += "  Area" + area + "_Ready AT %QX" + area + ".0 : BOOL;\n  Area" + area + "_Level AT %QD" +
         std::to_string(1000 + file) + " : REAL;\n  Area" + area + "_Count : DINT;\nEND_VAR\n\n";
  out += "PROGRAM Area" + area + "\nVAR\n";
  for (uint32_t block : blocks) {
    out += filled(kProjectKinds[block % kKinds].instance, block, random);
  }
  out += "END_VAR\n";
  for (uint32_t block : blocks) {
    std::string call = filled(kProjectKinds[block % kKinds].call, block, random);
    for (size_t at; (at = call.find('%')) != std::string::npos;) call.replace(at, 1, area);
    out += call;
  }
  return out + "END_PROGRAM\n";
}

uint32_t lines_of(const std::string& text) {
  uint32_t lines = 0;
  for (char c : text) lines += c == '\n' ? 1 : 0;
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  const uint32_t wanted = argc == 3 ? static_cast<uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 0;
  if (wanted == 0) {
    std::fputs("usage: bench_project FOLDER LINES\n", stderr);
    return 2;
  }
  Random random;
  const std::string folder = argv[1];
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  uint32_t lines = 0;
  uint32_t block = 0;
  for (uint32_t file = 0; lines < wanted; ++file) {
    std::string text;
    std::vector<uint32_t> blocks;
    for (uint32_t i = 0; i < kBlocksOfFile; ++i, ++block) {
      text += filled(kProjectKinds[block % kKinds].source, block, random);
      blocks.push_back(block);
    }
    text += program(file, blocks, random);
    lines += lines_of(text);
    std::ofstream(folder + "/area" + std::to_string(file) + ".st") << text;
  }
  std::printf("{\"lines\": %u, \"blocks\": %u}\n", lines, block);
  return 0;
}
